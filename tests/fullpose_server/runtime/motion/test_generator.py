"""Moves, stops and E-stops: inside the limits from wherever they begin."""

import math

import numpy as np
import pytest

from fullpose.rig import FrameLimits, Rig, builtin_rigs
from fullpose_server.runtime.contract.config import GuardConfig, MotionConfig
from fullpose_server.runtime.motion.generator import Mode, Motion
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.runtime.motion.point_to_point import MoveError
from fullpose_server.session.states import Event
from tests.fullpose_server.runtime.rigs import plan_of

RATE = 1000.0
RIG = builtin_rigs()["vertical-limited"]


def step(motion: Motion, guard: Guard) -> Event | None:
    event = motion.tick()
    found = guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a)
    assert found is None, found
    motion.commit()
    return event


def rig_motion(rig: Rig = RIG) -> tuple[Motion, Guard]:
    motion = Motion(rig, MotionConfig(), RATE)
    motion.rest_at(rig.home)
    return motion, Guard(rig, GuardConfig(), 1.0 / RATE)


@pytest.mark.parametrize("name", list(builtin_rigs()))
@pytest.mark.parametrize("fastest", [False, True])
def test_a_stop_at_any_moment_of_a_flight_is_inside_the_limits(name: str, fastest: bool) -> None:
    rig = builtin_rigs()[name]
    plan = plan_of(rig, 3.0, swing=1.3)
    generator = np.random.default_rng(7)
    for _ in range(100):
        motion, guard = rig_motion(rig)
        motion.load(plan)
        motion.rest_at(plan.angles[0])
        motion.run()
        for _ in range(int(generator.integers(1, 4900))):
            assert step(motion, guard) is None
        if generator.random() < 0.3:
            motion.hold(True)
            for _ in range(int(generator.integers(1, 400))):
                step(motion, guard)
        speed = np.abs(motion.v1).copy()
        begun = motion.x1.copy()
        motion.brake(fastest=fastest)
        ticks = 0
        while step(motion, guard) is not Event.AT_REST:
            ticks += 1
            assert ticks < 3000
        most = rig.max_acceleration * (1.0 if fastest else 0.8)
        allowed = speed * speed / (2.0 * most) + 1e-9
        assert (np.abs(motion.x1 - begun) <= allowed).all()
        assert (motion.v1 == 0.0).all()


def test_a_stop_near_a_position_limit_brakes_as_hard_as_it_must() -> None:
    motion, guard = rig_motion()
    most = float(RIG.max_acceleration[3])
    speed = 1.0
    motion.rest_at(np.array([0.0, 0.0, 0.0, float(RIG.position_max[3]) - speed**2 / (2.0 * 0.95 * most)]))
    motion.v1[3] = speed
    motion.brake(fastest=False)
    while step(motion, guard) is not Event.AT_REST:
        pass
    assert motion.x1[3] <= RIG.position_max[3]


def test_an_estop_during_a_stop_brakes_harder_never_softer() -> None:
    rests = []
    for orders in ([False], [False, True], [True, False]):
        motion, guard = rig_motion()
        motion.v1[:] = np.radians([50.0] * 4)
        for fastest in orders:
            motion.brake(fastest=fastest)
        ticks = 1
        while step(motion, guard) is not Event.AT_REST:
            ticks += 1
        rests.append(ticks)
    assert rests[1] < rests[0]
    assert rests[2] == rests[1]


def test_moves_are_synchronised_and_arrive_exactly() -> None:
    motion, guard = rig_motion()
    target = np.radians([90.0, -30.0, 5.0, 60.0])
    motion.go(motion.plan_move(target), Event.THERE)
    seen = []
    while (event := step(motion, guard)) is None:
        seen.append(motion.x1 / target)
    assert event is Event.THERE
    np.testing.assert_array_equal(motion.x1, target)
    assert motion.mode is Mode.REST
    # Each frame is still under way when the others are: none arrives in the first nine tenths.
    assert (np.array(seen)[: int(0.9 * len(seen))] < 0.9999).all()


def test_a_move_out_of_range_is_refused_with_the_frame() -> None:
    motion, _ = rig_motion()
    with pytest.raises(MoveError, match="inner: 61 deg is outside -60 to 60 deg"):
        motion.plan_move(np.radians([0, 0, 0, 61.0]))
    with pytest.raises(MoveError):
        motion.plan_move(np.array([0.0, math.nan, 0.0, 0.0]))


def test_a_frame_found_outside_its_range_may_stay_or_come_back() -> None:
    motion, guard = rig_motion()
    motion.rest_at(np.radians([0, 0, 0, 61.0]))
    with pytest.raises(MoveError, match="inner"):
        motion.plan_move(np.radians([0, 0, 0, 62.0]))
    motion.plan_move(np.radians([5.0, 0, 0, 61.0]))
    motion.go(motion.plan_move(np.zeros(4)), Event.THERE)
    while step(motion, guard) is None:
        pass
    np.testing.assert_array_equal(motion.x1, np.zeros(4))


def test_a_move_that_takes_too_long_is_refused_with_the_frame() -> None:
    motion, _ = rig_motion()
    with pytest.raises(MoveError, match=r"base: 500000 deg at 60 deg/s take 8333 s"):
        motion.plan_move(np.radians([500000.0, 0, 0, 0]))
    slow = Rig("slow", RIG.geometry, (FrameLimits(max_rate=math.radians(0.01)), *RIG.frames[1:]))
    with pytest.raises(MoveError, match="base"):
        rig_motion(slow)[0].plan_move(np.radians([90.0, 0, 0, 0]))


def test_home_is_the_nearest_turn_of_a_frame_without_stops() -> None:
    from fullpose_server.runtime.loop.orders import move_of
    from fullpose_server.session.states import Command

    motion, guard = rig_motion()
    motion.rest_at(np.radians([470010.0, -3605.0, 0.0, 30.0]))
    motion.go(move_of(Command.HOME, {}, RIG, motion), Event.THERE)
    while step(motion, guard) is None:
        pass
    np.testing.assert_allclose(np.degrees(motion.x1), [470160.0, -3600.0, 0.0, 0.0], atol=1e-9)


def test_a_three_axis_rig_s_absent_base_cannot_be_moved() -> None:
    motion, _ = rig_motion(builtin_rigs()["vertical-3"])
    with pytest.raises(MoveError, match="base"):
        motion.plan_move(np.radians([1.0, 0, 0, 0]))
