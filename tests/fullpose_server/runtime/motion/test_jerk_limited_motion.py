"""Moves, stops and E-stops of a rig with jerk limits: every limit kept by the commands' own differences."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fullpose._typing import Array
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose_server.runtime.contract.config import GuardConfig, MotionConfig
from fullpose_server.runtime.loop.orders import OrderError, check_hold, load_of
from fullpose_server.runtime.motion.generator import Motion
from fullpose_server.runtime.motion.jerk_braking import LONGER_S
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.session.states import Event
from tests.fullpose_server.runtime.rigs import plan_of, written

HZ = 1000.0
DT = 1.0 / HZ
DEG = math.pi / 180.0


def bench(jerk_deg_s3: float = 5000.0, name: str = "vertical-limited") -> Rig:
    rig = builtin_rigs()[name]
    base, outer, middle, inner = (replace(frame, max_jerk=jerk_deg_s3 * DEG) for frame in rig.frames)
    return replace(rig, name="bench", frames=(base, outer, middle, inner))


def flown(rig: Rig, motion: Motion, guard: Guard, path: list[Array], most: int = 60_000) -> Event:
    """Ticks until something has happened; path gets every command."""
    for _ in range(most):
        event = motion.tick()
        found = guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from)
        assert found is None, found
        motion.commit()
        path.append(motion.x1.copy())
        if event is not None:
            return event
    raise AssertionError("nothing happened")


def parts(rig: Rig, pose: Array, config: MotionConfig | None = None) -> tuple[Motion, Guard]:
    motion = Motion(rig, config or MotionConfig(), HZ)
    motion.rest_at(pose)
    return motion, Guard(rig, GuardConfig(), DT)


def shares(rig: Rig, path: list[Array]) -> tuple[float, float, float]:
    """The largest shares of the rate, acceleration and jerk limits, rest before and after included."""
    x = np.array(path)
    x = np.concatenate([np.repeat(x[:1], 3, axis=0), x, np.repeat(x[-1:], 3, axis=0)])
    v, a, j = (np.diff(x, n, axis=0) / DT**n for n in (1, 2, 3))
    limits = rig.max_rate, rig.max_acceleration, rig.max_jerk
    found = [float((np.abs(each) / limit).max()) for each, limit in zip((v, a, j), limits, strict=True)]
    return found[0], found[1], found[2]


POSE = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).map(np.array)


@given(POSE, POSE, st.floats(300.0, 20_000.0))
def test_moves_keep_every_limit(begin: Array, target: Array, jerk: float) -> None:
    rig = bench(jerk)
    motion, guard = parts(rig, begin, MotionConfig(1000.0, 1e4, 1e6))
    motion.go(motion.plan_move(target), Event.THERE)
    path = [begin]
    assert flown(rig, motion, guard, path) is Event.THERE
    np.testing.assert_array_equal(motion.x1, target)
    assert max(shares(rig, path)) <= 1.0 + 1e-6


@given(POSE, POSE, st.floats(500.0, 20_000.0), st.floats(0.0, 1.0), st.booleans())
def test_braking_out_of_any_move_keeps_every_limit(
    begin: Array, target: Array, jerk: float, when: float, fastest: bool
) -> None:
    """A move never leaves a range, so whatever brakes out of it in time has room: nothing need give way."""
    rig = bench(jerk, "vertical-4")
    motion, guard = parts(rig, begin, MotionConfig(1000.0, 1e4, 1e6))
    move = motion.plan_move(target)
    motion.go(move, Event.THERE)
    path = [begin]
    for _ in range(int(when * move.duration_s * HZ)):
        if motion.tick() is not None:
            break
        assert guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from) is None
        motion.commit()
        path.append(motion.x1.copy())
    speed, turning = np.abs(motion.v1), np.abs(motion.a1)
    motion.brake(fastest=fastest)
    ticks = len(path)
    assert flown(rig, motion, guard, path) is Event.AT_REST
    rate, acceleration, third = shares(rig, path)
    assert max(rate, acceleration) <= 1.0 + 1e-6
    bound = speed / rig.max_acceleration + LONGER_S + 2.0 * DT
    if fastest:
        assert (len(path) - ticks) * DT <= bound.max()
    # An E-stop is bounded in time, and gives way for it at little jerk: who first ends the acceleration and then brakes
    # from rate to rest takes so much longer at most than without a jerk limit.
    longer = (turning + 0.5 * turning**2 / rig.max_acceleration + rig.max_acceleration) / rig.max_jerk
    if not fastest or longer.max() <= 0.95 * LONGER_S:
        assert third <= 1.0 + 1e-6


@given(st.floats(0.2, 0.95), st.floats(0.05, 2.0), st.booleans())
def test_a_position_limit_comes_before_the_jerk(speed: float, more: float, fastest: bool) -> None:
    """From full motion with little more than the acceleration's braking distance: inside the range, at rest."""
    rig = bench(3000.0)
    v = speed * float(rig.max_rate[3])
    room = v * v / (2.0 * float(rig.max_acceleration[3])) * (1.0 + 0.05 * more) + 2.0 * v * DT
    assume(room < 1.9 * float(rig.position_max[3]))
    pose = np.array([0.0, 0.0, 0.0, float(rig.position_max[3]) - room])
    motion, guard = parts(rig, pose)
    motion.v1[3] = v
    motion.brake(fastest=fastest)
    path = [pose]
    assert flown(rig, motion, guard, path) is Event.AT_REST
    assert np.max(path, axis=0)[3] <= rig.position_max[3] + 1e-9
    motion.commit()  # at rest the jerk counts again
    flown_on: list[Array] = []
    for _ in range(5):
        motion.tick()
        assert guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from) is None
        motion.commit()
        flown_on.append(motion.x1.copy())
    assert motion.jerk_from is not None


def test_the_guard_names_a_jerk_beyond_its_limit() -> None:
    rig = bench()
    motion, guard = parts(rig, np.zeros(4))
    motion.x[0] = 2.0 * float(rig.max_jerk[0]) * DT**3
    found = guard.command(motion.x, motion.x1, motion.v1, motion.v, motion.a, motion.jerk_from)
    assert found is not None
    assert (found.code, found.frame, found.unit) == ("guard_jerk", "base", "deg/s^3")
    assert found.value == pytest.approx(10_000.0)


def test_an_estop_during_a_stop_brakes_harder_never_softer() -> None:
    rig = bench(4000.0)
    ticks = []
    for orders in ([False], [False, True], [True, False]):
        motion, guard = parts(rig, np.zeros(4))
        motion.v1[:] = 50.0 * DEG
        path: list[Array] = []
        for fastest in orders:
            motion.brake(fastest=fastest)
        flown(rig, motion, guard, path)
        ticks.append(len(path))
    assert ticks[1] < ticks[0]
    assert ticks[2] == ticks[1]


def test_frames_without_the_limit_brake_as_ever_beside_those_with_it() -> None:
    plain = builtin_rigs()["vertical-4"]
    base, outer, middle, inner = plain.frames
    rig = replace(plain, frames=(replace(base, max_jerk=2000.0 * DEG), outer, middle, inner))
    paths = []
    for each in (plain, rig):
        motion, guard = parts(each, np.zeros(4))
        motion.v1[:] = np.array([40.0, -50.0, 60.0, 100.0]) * DEG
        motion.brake(fastest=False)
        path: list[Array] = []
        flown(each, motion, guard, path)
        paths.append(np.array(path))
    n = min(map(len, paths))
    np.testing.assert_array_equal(paths[0][:n, 1:], paths[1][:n, 1:])
    assert len(paths[1]) > len(paths[0])


def test_a_plan_that_jerks_is_not_loaded_and_a_hold_is_refused(tmp_path: Path) -> None:
    for rig, refused in ((bench(100.0), True), (bench(50_000.0), False)):
        motion, _ = parts(rig, rig.home)
        folder = written(tmp_path / str(refused), plan_of(rig))
        if refused:
            with pytest.raises(OrderError, match="exceeds its jerk limit"):
                load_of({"plan_folder": str(folder)}, rig, motion, None)  # type: ignore[arg-type]
        else:
            load_of({"plan_folder": str(folder)}, rig, motion, None)  # type: ignore[arg-type]
        with pytest.raises(OrderError, match="hold on the path does not keep"):
            check_hold(rig)
    check_hold(builtin_rigs()["vertical-4"])
    fast = bench(50_000.0)
    motion = Motion(fast, MotionConfig(), 2000.0)
    with pytest.raises(OrderError, match="made at 1000 Hz, and flown at 2000 Hz"):
        load_of({"plan_folder": str(written(tmp_path / "other", plan_of(fast)))}, fast, motion, None)  # type: ignore[arg-type]


def test_without_an_acceleration_limit_the_jerk_limit_is_kept() -> None:
    free = FrameLimits(max_jerk=5.0)
    rig = Rig("free", Geometry.VERTICAL_4, (free, free, free, free))
    motion, guard = parts(rig, np.zeros(4))
    motion.v1[:] = 1.0
    motion.brake(fastest=False)
    path = [np.zeros(4) - DT, np.zeros(4)]
    flown(rig, motion, guard, path)
    x = np.array(path)
    assert np.abs(np.diff(x, 3, axis=0)).max() / DT**3 <= 5.0 * (1.0 + 1e-6)
