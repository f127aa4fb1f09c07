"""`preview`: never outside the limits, exact where it says so, whatever it is told and however late."""

import itertools
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.errors import InputError, MethodError
from fullpose.kinematics import jacobian
from fullpose.limits import MAX, MIN, RATE, limit_table
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.preview.prediction import Track, attitudes_ahead, body_motion
from fullpose.preview.replan import Replan
from fullpose.preview.stepper import PreviewStepper, start_nodes
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import DEG, SCENARIOS, random_flight
from fullpose.solve import solve
from fullpose.trajectory.stage_cost import room
from fullpose.verify import attitude_errors, payload_attitudes, verify

RIGS = builtin_rigs()
LIMITED = RIGS["vertical-limited"]
HORIZONTAL = replace(RIGS["horizontal-4"], frames=LIMITED.frames)
EXACT_WITHIN = 1e-12


def flight(seed: int, seconds: float, rate_deg: float, hz: float = 100.0):
    time, q = random_flight(seed, seconds, hz, rate_deg * DEG)
    return time, dcm_from_quaternion(q)


def fast(**changes) -> PreviewOptions:
    return PreviewOptions(**{"beam": 32, **changes})


def check(rig, time, attitude, angles, limited) -> None:
    found = verify(time, angles, rig)
    assert not found.violations, found.violations[:3]
    error, _ = attitude_errors(payload_attitudes(rig, angles), attitude)
    assert (error[limited == EXACT] < EXACT_WITHIN).all()


@pytest.mark.parametrize("rig", [LIMITED, HORIZONTAL], ids=["vertical", "horizontal"])
@pytest.mark.parametrize("preview_s", [0.0, 0.5])
def test_limits_are_kept_and_unlimited_samples_are_exact(rig, preview_s) -> None:
    limited = 0
    for seed in range(2):
        time, attitude = flight(seed, 3.0, 180.0)  # faster than the rig can follow throughout
        solution = solve(time, attitude, rig, "preview", options=fast(preview_s=preview_s))
        check(rig, time, attitude, solution.angles, solution.limited)
        limited += solution.limited_samples
    assert limited > 0


def test_it_flies_more_than_exact_and_more_with_preview() -> None:
    flown = {"exact": 0, 0.0: 0, 1.0: 0}
    for seed in (12, 16, 24, 28):  # where a step that looks at an instant alone loses the attitude
        time, attitude = flight(seed, 4.0, 70.0)
        flown["exact"] += solve(time, attitude, LIMITED, "exact").limited_samples == 0
        for preview_s in (0.0, 1.0):
            solution = solve(time, attitude, LIMITED, "preview", options=PreviewOptions(preview_s=preview_s))
            flown[preview_s] += solution.limited_samples == 0
    assert flown["exact"] == 0
    assert flown[0.0] == 3
    assert flown[1.0] == 4


def test_exactness_lost_is_regained() -> None:
    # Two seconds of a body rate beyond the rig's, then rest.
    time = np.arange(0.0, 6.0, 0.01)
    angle = np.where(time < 2.0, 0.5 * 6.0 * time**2, 12.0 + 12.0 * (time - 2.0))
    angle = np.where(time > 2.5, 18.0, angle)
    axis = np.array([0.3, 0.8, 0.52]) / np.linalg.norm([0.3, 0.8, 0.52])
    half = 0.5 * angle[:, None]
    attitude = dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * axis]))
    solution = solve(time, attitude, LIMITED, "preview", options=fast())
    check(LIMITED, time, attitude, solution.angles, solution.limited)
    assert solution.limited_samples > 0
    assert solution.limited[-1] == EXACT
    assert solution.error[-1] < EXACT_WITHIN
    assert solution.blocking is not None


def test_the_same_flight_twice_gives_the_same_angles() -> None:
    time, attitude = flight(3, 2.0, 90.0)
    first, second = (solve(time, attitude, LIMITED, "preview", options=fast(preview_s=0.3)) for _ in range(2))
    assert np.array_equal(first.angles, second.angles)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_short_flights(count) -> None:
    time, attitude = flight(1, 1.0, 60.0)
    solution = solve(time[:count], attitude[:count], LIMITED, "preview", options=fast(preview_s=1.0))
    check(LIMITED, time[:count], attitude[:count], solution.angles, solution.limited)
    assert solution.limited_samples == 0


@pytest.mark.parametrize("name", ["level", "loop", "singular_start", "non_uniform", "over_limit"])
def test_scenarios_stay_inside_the_limits(name) -> None:
    scenario = SCENARIOS[name]
    part = slice(0, min(len(scenario.time), 4000), 10)
    time, attitude = scenario.time[part], dcm_from_quaternion(scenario.quaternion)[part]
    rig = RIGS[scenario.rig]
    start = None if scenario.start is None else np.array(scenario.start)
    solution = solve(time, attitude, rig, "preview", options=fast(), start=start)
    check(rig, time, attitude, solution.angles, solution.limited)


def test_a_rig_without_limits_and_a_level_flight_at_rest() -> None:
    rig = Rig("open", Geometry.VERTICAL_4)
    time, attitude = flight(4, 2.0, 90.0)
    assert solve(time, attitude, rig, "preview", options=fast()).limited_samples == 0
    still = np.tile(np.eye(3), (len(time), 1, 1))
    solution = solve(time, still, LIMITED, "preview", options=fast())
    check(LIMITED, time, still, solution.angles, solution.limited)
    assert solution.limited_samples == 0


def test_a_range_of_more_than_a_turn_is_not_left() -> None:
    base = FrameLimits(-540 * DEG, 540 * DEG, 200 * DEG, 500 * DEG)
    rig = replace(LIMITED, frames=(base, *LIMITED.frames[1:]))
    time, attitude = flight(2, 6.0, 60.0)
    solution = solve(time, attitude, rig, "preview", options=fast())
    check(rig, time, attitude, solution.angles, solution.limited)


# --- live use


def begun(samples: int = 30, **options) -> tuple[PreviewStepper, np.ndarray, np.ndarray]:
    time, attitude = flight(2, 4.0, 60.0)
    stepper = PreviewStepper(LIMITED, fast(**options), np.zeros(4), attitude[0])
    for k in range(samples):
        stepper.block(time[k : k + 1], attitude[k : k + 1])
    return stepper, time, attitude


def test_a_job_survives_a_pickle_and_says_the_same() -> None:
    stepper, _, _ = begun()
    job = stepper.replan()
    copy = pickle.loads(pickle.dumps(job))
    assert isinstance(copy, Replan)
    here, there = job.run(), pickle.loads(pickle.dumps(copy.run()))
    assert np.array_equal(here.pose, there.pose)
    assert stepper.adopt(there)
    assert not stepper.adopt(here)  # the same number again


def test_a_job_is_frozen_against_what_comes_after() -> None:
    stepper, time, attitude = begun()
    job = stepper.replan()
    before = job.run()
    stepper.offer(time[40:80], attitude[40:80])
    stepper.block(time[30:40], attitude[30:40])
    assert np.array_equal(job.run().pose, before.pose)


def test_old_and_spent_ways_are_not_adopted() -> None:
    stepper, time, attitude = begun(horizon_s=0.2)
    early, late = stepper.replan(), stepper.replan()
    assert stepper.adopt(late.run())
    assert not stepper.adopt(early.run())
    third = stepper.replan()
    stepper.block(time[30:60], attitude[30:60])  # 0.3 s on: past the horizon
    assert not stepper.adopt(third.run())


def test_without_any_way_the_limits_hold_and_the_step_goes_on() -> None:
    time, attitude = flight(2, 4.0, 120.0)
    stepper = PreviewStepper(LIMITED, fast(), np.zeros(4), attitude[0])
    block = stepper.block(time, attitude)
    check(LIMITED, time, attitude, block.angles, block.limited)


def test_a_way_from_elsewhere_costs_no_limit() -> None:
    stepper, time, attitude = begun()
    way = stepper.replan().run()
    random = np.random.default_rng(0)
    wild = replace(way, pose=way.pose + random.normal(size=way.pose.shape), rate=way.rate * 50.0)
    angles = [stepper._flight.pose.copy()]
    assert stepper.adopt(wild)
    block = stepper.block(time[30:150], attitude[30:150])
    check(LIMITED, time[29:150], attitude[29:150], np.vstack([angles, block.angles]), np.r_[0, block.limited])


@pytest.mark.parametrize("delay_s", [0.03, 0.2])
def test_late_ways_keep_the_limits(delay_s) -> None:
    time, attitude = flight(5, 5.0, 90.0)
    solution = solve(time, attitude, LIMITED, "preview", options=fast(delay_s=delay_s, preview_s=0.5))
    check(LIMITED, time, attitude, solution.angles, solution.limited)


def test_blocks_of_any_size_fly_the_same() -> None:
    time, attitude = flight(6, 1.5, 90.0)
    whole = PreviewFlight(LIMITED, fast(preview_s=0.4), np.zeros(4), time, attitude).block(time, attitude)
    single = PreviewFlight(LIMITED, fast(preview_s=0.4), np.zeros(4), time, attitude)
    angles = np.vstack([single.block(time[k : k + 1], attitude[k : k + 1]).angles for k in range(len(time))])
    assert np.array_equal(whole.angles, angles)


def test_nothing_to_plan_from_before_the_first_sample() -> None:
    stepper = PreviewStepper(LIMITED, fast(), None, np.eye(3))
    assert not stepper.due
    with pytest.raises(MethodError, match="no sample"):
        stepper.replan()


def test_a_free_start_looks_ahead() -> None:
    """From home these flights lose the attitude in their first seconds; the start may be chosen, so they need not."""
    for seed in (14, 15):
        time, attitude = flight(seed, 2.5, 110.0)
        options = fast(preview_s=1.0)
        assert solve(time, attitude, LIMITED, "preview", options=options, start=LIMITED.home).limited_samples > 0
        assert solve(time, attitude, LIMITED, "preview", options=options).limited_samples == 0


def test_options_and_rigs_that_do_not_go() -> None:
    for wrong in ({"preview_s": -1.0}, {"horizon_s": 0.0}, {"reserve": 1.0}, {"recovery": 0.0}, {"beam": 0}):
        with pytest.raises(MethodError, match=next(iter(wrong))):
            PreviewOptions(**wrong)
    for vast, most in (
        ({"beam": 10**9}, "4096]"),
        ({"slides": 10**6}, "64]"),
        ({"smoothing": 10**9}, "100]"),
        ({"horizon_s": 1e9}, "1000 stages at most"),
        ({"stage_s": 1e-9}, "1000 stages at most"),
    ):
        with pytest.raises(MethodError, match=f"{next(iter(vast))} = .*expected .*{re.escape(most)}"):
            PreviewOptions(**vast)
    time, attitude = flight(0, 0.1, 10.0)
    with pytest.raises(MethodError, match="fourth axis"):
        solve(time, attitude, RIGS["vertical-3"], "preview")
    with pytest.raises(MethodError, match="PreviewOptions"):
        solve(time, attitude, LIMITED, "preview", options=3)


# --- prediction


def constant_rotation(rate, acceleration, time):
    """C(t) about one axis, so that the rate and acceleration are exact."""
    axis = np.asarray(rate) / np.linalg.norm(rate)
    angle = np.linalg.norm(rate) * time + 0.5 * (acceleration @ axis) * time**2
    half = 0.5 * angle[:, None]
    return dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * axis]))


def test_body_motion_from_samples() -> None:
    rate, acceleration = np.array([0.3, -0.8, 0.5]), 0.7 * np.array([0.3, -0.8, 0.5])
    time = np.linspace(-0.15, 0.0, 31)
    attitude = constant_rotation(rate, acceleration, time)
    w, a = np.empty(3), np.empty(3)
    body_motion(time, attitude, 0.1, w, a)
    assert np.allclose(w, rate, atol=1e-6)
    assert np.allclose(a, acceleration, atol=1e-4)
    body_motion(time[-1:], attitude[-1:], 0.1, w, a)
    assert not w.any()
    assert not a.any()
    body_motion(time[-2:], attitude[-2:], 0.1, w, a)
    assert np.allclose(w, rate, atol=3e-3)


def test_jitter_is_averaged() -> None:
    random = np.random.default_rng(1)
    time = np.arange(-0.15, 1e-9, 0.005)
    true = np.array([0.0, 1.0, 0.0])
    attitude = constant_rotation(true, np.zeros(3), time + 1e-4 * random.normal(size=len(time)))  # 1e-4 rad
    w, a = np.empty(3), np.empty(3)
    body_motion(time, attitude, 0.1, w, a)
    assert np.linalg.norm(w - true) < 0.02


def test_known_attitudes_are_interpolated_and_the_rest_predicted() -> None:
    rate = np.array([0.2, 0.9, -0.4])
    time = np.linspace(0.0, 1.0, 51)
    attitude = constant_rotation(rate, np.zeros(3), time)
    ahead = np.array([0.503, 0.777, 1.0, 1.1, 1.4, 2.0])
    out = np.empty((6, 3, 3))
    assert attitudes_ahead(time, attitude, ahead, 0.1, 0.3, 0.0, out) == 3
    error, _ = attitude_errors(out, constant_rotation(rate, np.zeros(3), ahead))
    assert error.max() < 1e-9


def test_an_acceleration_dies_away() -> None:
    rate, acceleration, settling = np.array([0.0, 1.0, 0.0]), np.array([0.0, 2.0, 0.0]), 0.3
    time = np.linspace(-0.2, 0.0, 41)
    ahead = np.array([0.2, 0.5, 1.0])
    out = np.empty((3, 3, 3))
    attitudes_ahead(time, constant_rotation(rate, acceleration, time), ahead, 0.1, settling, 0.0, out)
    turned = ahead + 2.0 * settling * (ahead - settling * (1.0 - np.exp(-ahead / settling)))
    half = 0.5 * turned[:, None]
    expected = dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * np.array([0.0, 1.0, 0.0])]))
    error, _ = attitude_errors(out, expected)
    assert error.max() < 1e-4


def test_a_track_keeps_what_is_newest_and_takes_back_what_was_foretold() -> None:
    track = Track(0.2)
    eye = np.eye(3)
    for k in range(100):
        track.flown(0.001 * k, eye)
    assert track.end == pytest.approx(0.099)
    assert len(track.copy()[0]) < 30  # thinned
    ahead = 0.1 + 0.01 * np.arange(100)
    track.tell(ahead, np.tile(eye, (100, 1, 1)))
    turned = np.diag([1.0, -1.0, -1.0])
    track.tell(np.array([0.5, 0.6]), np.tile(turned, (2, 1, 1)))
    time, attitude = track.copy()
    assert track.end == 0.6
    assert np.all(np.diff(time) > 0.0)
    assert np.array_equal(attitude[-1], turned)
    assert np.array_equal(attitude[time < 0.45][-1], eye)
    track.forget(0.55)
    assert track.copy()[0][0] <= 0.37
    assert track.copy()[0][0] > 0.3
    with pytest.raises(InputError):
        track.tell(np.array([1.0, 1.0]), np.tile(eye, (2, 1, 1)))


# --- room


@pytest.mark.parametrize("rig", [LIMITED, HORIZONTAL], ids=["vertical", "horizontal"])
def test_room_is_the_radius_of_the_ball_in_the_attainable_rates(rig) -> None:
    """Against the convex hull of the box's corners, with the Jacobian of the kinematics."""
    random = np.random.default_rng(2)
    table = limit_table(rig)
    for _ in range(20):
        d = random.uniform(-np.pi, np.pi, 4)
        d[3] = random.uniform(-1.0, 1.0)
        J = np.empty((3, 4))
        jacobian(rig.axes, d, J)
        low = np.maximum(-table[RATE], (table[MIN] - d) / 0.5)
        high = np.minimum(table[RATE], (table[MAX] - d) / 0.5)
        corners = np.array(list(itertools.product(*zip(low, high, strict=True))))
        ball = -ConvexHull(corners @ J.T).equations[:, 3].max()
        assert room(rig.geometry.horizontal, table, d, 0.5) == pytest.approx(ball, rel=1e-6)


def test_no_room_at_the_singularity() -> None:
    assert room(False, limit_table(LIMITED), np.array([0.4, 0.0, np.pi / 2, 0.1]), 0.5) == pytest.approx(0.0, abs=1e-9)


def test_start_nodes_are_exact_and_inside() -> None:
    _, attitude = flight(7, 0.1, 10.0)
    for rig in (LIMITED, HORIZONTAL):
        poses = start_nodes(rig, limit_table(rig), attitude[0])
        assert len(poses) > 20
        error, _ = attitude_errors(payload_attitudes(rig, poses), np.broadcast_to(attitude[0], (len(poses), 3, 3)))
        assert error.max() < 1e-9
        assert (np.abs(poses[:, 3]) <= 60 * DEG).all()


def announced() -> tuple[np.ndarray, np.ndarray, Replan]:
    """A flight, and the job of a stepper that has flown two of its samples and been told all."""
    time, attitude = flight(2, 3.0, 60.0)
    stepper = PreviewStepper(LIMITED, fast(), None, attitude[0])
    stepper.offer(time, attitude)
    stepper.block(time[:2], attitude[:2])
    job = stepper.replan()
    return time, attitude, job


def test_the_stages_lie_on_the_solutions_and_inside_the_limits() -> None:
    """As samples of their own they pass the independent check; the way runs next to them."""
    time, attitude, job = announced()
    stage, pose, known, over = job.stages()
    assert known == over == len(stage) > 50
    at = np.rint(stage * 100).astype(int)
    kept = at < len(time)
    error, _ = attitude_errors(payload_attitudes(LIMITED, pose[kept]), attitude[at[kept]])
    assert error.max() < 1e-6
    assert not verify(stage, pose, LIMITED).violations
    way = replace(job, options=fast(smoothing=0)).run()
    assert way.lost_at == np.inf
    assert np.allclose(way.time[::2], stage)
    assert np.abs(way.pose[::2] - pose).max() < 1.0 * DEG
    assert not verify(way.time, way.pose, LIMITED).violations


def test_smoothing_takes_the_jerks_from_the_same_way() -> None:
    time, attitude, job = announced()
    rough, smooth = (replace(job, options=fast(smoothing=count)).run() for count in (0, 3))

    def jerk(way) -> float:
        acceleration = np.diff(way.rate, axis=0) / np.diff(way.time)[:, None]
        return float(np.sqrt(np.mean(np.diff(acceleration, axis=0) ** 2)))

    assert jerk(smooth) < 0.5 * jerk(rough)
    assert np.allclose(smooth.pose[0], rough.pose[0])
    assert np.allclose(smooth.rate[0], rough.rate[0])
    assert np.abs(smooth.pose[-1] - rough.pose[-1]).max() < 0.1 * DEG  # where the search wanted to be
    assert not verify(smooth.time, smooth.pose, LIMITED).violations
    at = np.rint(smooth.time * 100).astype(int)
    error, _ = attitude_errors(payload_attitudes(LIMITED, smooth.pose), attitude[np.minimum(at, len(time) - 1)])
    assert error[(at < len(time)) & (np.abs(at - smooth.time * 100) < 1e-6)].max() < 0.1 * DEG


def test_a_loss_is_foretold() -> None:
    # At rest, then a yaw of 700 deg/s, more than the frames have together, announced a second ahead.
    time = np.arange(0.0, 2.0, 0.01)
    angle = 700 * DEG * np.maximum(0.0, time - 1.0)
    attitude = dcm_from_quaternion(np.stack([np.cos(0.5 * angle), 0 * angle, np.sin(0.5 * angle), 0 * angle], axis=1))
    stepper = PreviewStepper(LIMITED, fast(), np.zeros(4), attitude[0])
    stepper.offer(time, attitude)
    stepper.block(time[:10], attitude[:10])
    assert stepper.replan().run().lost_at == pytest.approx(1.1, abs=0.15)
