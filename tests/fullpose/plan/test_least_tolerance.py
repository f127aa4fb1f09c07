"""Flights that cannot be flown: inside every limit all the same, marked, and no worse than they need be."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import EXACT, limited_code
from fullpose.limits import limit_table
from fullpose.plan import PlanOptions, plan
from fullpose.plan.fallback import Fallback
from fullpose.plan.follow import follow
from fullpose.plan.least_tolerance import least_tolerance
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.problem import Problem
from fullpose.verify import attitude_errors, payload_attitudes, verify
from fullpose.vocabulary import Decision

DEG = np.pi / 180.0
RIGS = builtin_rigs()
LIMITED = RIGS["vertical-limited"]


def largest_by_scipy(rig, angles, C):
    """[rad] by code that shares nothing with ours: the frames' rotations multiplied by SciPy, active."""
    F = Rotation.identity(len(angles))
    for i in rig.geometry.frames:
        F = F * Rotation.from_rotvec(angles[:, i, None] * np.eye(3)[rig.geometry.axes[i]])
    return float((F.inv() * Rotation.from_matrix(np.swapaxes(C, 1, 2))).magnitude().max())


def slower(rig, share):
    """The rig with every rate and acceleration limit times `share`."""
    frames = [FrameLimits(f.min, f.max, f.max_rate * share, f.max_acceleration * share) for f in rig.frames]
    return Rig(rig.name, rig.geometry, (frames[0], frames[1], frames[2], frames[3]))


@pytest.fixture(scope="module")
def too_fast():
    """A flight at 230 deg/s on `vertical-limited`, planned."""
    t, q = random_flight(0, 6.0, 250.0, 230 * DEG)
    C = dcm_from_quaternion(q)
    return t, C, plan(t, C, LIMITED)


def test_the_limits_win_and_the_verdict_says_where(too_fast):
    t, C, made = too_fast
    s = made.solution
    assert not made.verdict.feasible
    assert made.verdict.blocking == s.blocking
    assert t[0] <= s.blocking.time <= t[-1]
    assert "Infeasible" in made.verdict.statement
    assert verify(t, s.angles, LIMITED, C).violations == ()


def test_what_is_not_marked_is_exact(too_fast):
    _, _, made = too_fast
    s = made.solution
    assert 0 < s.limited_samples < len(s.time)
    assert s.error[s.limited == EXACT].max() < 1e-13
    assert s.error.max() > 1e-6


def test_the_error_is_smaller_than_of_a_path_taken_sample_by_sample(too_fast):
    t, C, made = too_fast
    taken = Fallback(Problem(t, C, LIMITED)).exact
    error, _ = attitude_errors(payload_attitudes(LIMITED, taken), C)
    assert made.solution.error.max() < 0.5 * error.max()
    assert np.mean(made.solution.error**2) < 0.25 * np.mean(error**2)


def test_the_tolerance_is_the_largest_error_and_scipy_agrees(too_fast):
    _, C, made = too_fast
    least = made.verdict.least_tolerance
    assert least == pytest.approx(largest_by_scipy(LIMITED, made.solution.angles, C), rel=1e-9)
    assert "smallest attitude tolerance" in made.verdict.statement


def test_a_tolerance_that_is_enough_makes_the_flight_feasible(too_fast):
    t, C, made = too_fast
    least = made.verdict.least_tolerance
    enough = plan(t, C, LIMITED, options=PlanOptions(tolerance=1.001 * least))
    assert enough.verdict.feasible
    assert enough.verdict.decided_by == Decision.TOLERANCE
    assert enough.solution.limited_samples == 0
    assert enough.solution.blocking is None
    assert verify(t, enough.solution.angles, LIMITED).violations == ()
    assert largest_by_scipy(LIMITED, enough.solution.angles, C) <= 1.001 * least
    little = plan(t, C, LIMITED, options=PlanOptions(tolerance=0.5 * least))
    assert not little.verdict.feasible


def test_a_feasible_flight_needs_none():
    t, q = random_flight(1, 3.0, 100.0, 60 * DEG)
    made = plan(t, dcm_from_quaternion(q), LIMITED)
    assert made.verdict.feasible
    assert made.verdict.least_tolerance == 0.0


def test_lower_limits_never_need_less():
    """To what the search is sure of: 5 %."""
    t, q = random_flight(3, 3.0, 100.0, 150 * DEG)
    C = dcm_from_quaternion(q)
    least = [
        least_tolerance(Problem(t, C, slower(LIMITED, share)), [Fallback(Problem(t, C, slower(LIMITED, share))).exact])
        for share in (0.8, 0.6, 0.4)
    ]
    assert 1.05 * least[1].tolerance >= least[0].tolerance
    assert 1.05 * least[2].tolerance >= least[1].tolerance
    assert least[2].tolerance > 1 * DEG


def test_the_start_is_kept():
    t, q = random_flight(0, 3.0, 100.0, 230 * DEG)
    C = dcm_from_quaternion(q)
    begin = plan(t[:1], C[:1], LIMITED).solution.angles[0]
    made = plan(t, C, LIMITED, begin)
    assert not made.verdict.feasible
    assert made.solution.angles[0] == pytest.approx(begin, abs=1e-6)
    assert verify(t, made.solution.angles, LIMITED).violations == ()


def test_a_roll_that_is_too_fast_for_the_inner_frame():
    """Where best effort lost the attitude by half a turn."""
    t = np.arange(0.0, 3.0, 0.01)
    C = dcm_from_euler(20 * DEG * np.sin(t), 10 * DEG * np.cos(t), 400 * DEG * t)
    made = plan(t, C, LIMITED)
    assert not made.verdict.feasible
    assert verify(t, made.solution.angles, LIMITED).violations == ()
    assert made.solution.error.max() < 178 * DEG


def test_one_frame_alone_is_the_least_squares_answer():
    """Yaw alone, and only the base can turn: the best is the rate-limited ramp through the middle of the step."""
    still = FrameLimits(-1e-6, 1e-6)
    rig = Rig("base", Geometry.VERTICAL_4, (FrameLimits(max_rate=20 * DEG), still, still, still))
    t = np.arange(0.0, 4.0, 0.02)
    yaw = 20 * DEG * np.clip(t - 2.0 + 0.25, 0.0, 0.5) / 0.5  # 20 deg in half a second: twice the rate there is
    made = plan(t, dcm_from_euler(yaw, 0.0, 0.0), rig)
    assert not made.verdict.feasible
    assert made.verdict.blocking.frame == "base"
    ramp = 20 * DEG * np.clip(t - 2.0 + 0.5, 0.0, 1.0)
    assert np.abs(made.solution.angles[:, 0] - ramp).max() < 0.6 * DEG
    assert made.solution.error.max() == pytest.approx(5 * DEG, rel=0.1)
    assert verify(t, made.solution.angles, rig).violations == ()


def test_a_range_that_no_pose_fits_is_a_matter_of_position():
    narrow = FrameLimits(-20 * DEG, 20 * DEG, 100 * DEG, 500 * DEG)
    rig = Rig("narrow", Geometry.VERTICAL_4, (narrow, narrow, narrow, narrow))
    t = np.arange(0.0, 3.0, 0.01)
    C = dcm_from_euler(0.0, 35 * DEG * np.sin(t), 0.0)
    made = plan(t, C, rig)
    assert not made.verdict.feasible
    assert made.verdict.blocking.limit == "position"
    assert made.verdict.blocking.time == pytest.approx(np.arcsin(20 / 35), abs=0.1)
    assert verify(t, made.solution.angles, rig).violations == ()
    # 15 deg of pitch are missing at the top, and no more than that is lost anywhere.
    assert made.solution.error.max() == pytest.approx(15 * DEG, abs=0.8 * DEG)


def test_a_flight_that_begins_outside_the_ranges():
    narrow = FrameLimits(-20 * DEG, 20 * DEG, 100 * DEG, 500 * DEG)
    rig = Rig("narrow", Geometry.VERTICAL_4, (narrow, narrow, narrow, narrow))
    t = np.arange(0.0, 2.0, 0.01)
    C = dcm_from_euler(0.0, 40 * DEG * (1.0 - t / 2.0), 0.0)
    for start in (None, np.zeros(4)):
        made = plan(t, C, rig, start)
        assert not made.verdict.feasible
        assert made.verdict.blocking.time == 0.0
        assert made.solution.limited[0] != EXACT
        assert made.solution.limited[-1] == EXACT
        assert verify(t, made.solution.angles, rig).violations == ()


def test_one_sample_out_of_reach():
    narrow = FrameLimits(-20 * DEG, 20 * DEG)
    rig = Rig("narrow", Geometry.VERTICAL_4, (narrow, narrow, narrow, narrow))
    made = plan([0.0], dcm_from_euler(0.0, 60 * DEG, 0.0), rig)
    assert not made.verdict.feasible
    assert made.verdict.blocking.limit == "position"
    assert made.solution.limited[0] != EXACT
    assert verify([0.0], made.solution.angles, rig).violations == ()


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_3, Geometry.HORIZONTAL_3])
def test_one_sample_out_of_reach_of_a_three_axis_rig(geometry):
    narrow = FrameLimits(-20 * DEG, 20 * DEG)
    rig = Rig("narrow", geometry, (narrow, narrow, narrow, narrow))
    turned = Rig("free", geometry)
    wanted = np.array([[0.0, 50 * DEG, 10 * DEG, 5 * DEG]])
    made = plan([0.0], payload_attitudes(turned, wanted), rig)
    assert made.solution.angles[0] == pytest.approx([0.0, 20 * DEG, 10 * DEG, 5 * DEG], abs=1e-12)
    assert made.solution.limited[0] == limited_code(1, 0)


def test_following_keeps_the_limits_of_a_jumping_target():
    t = np.arange(0.0, 3.0, 0.005)
    target = np.zeros((len(t), 4))
    target[t > 1.0] = [3.0, -2.0, 1.0, 4.0]  # the inner frame past its stop
    x = np.empty_like(target)
    follow(limit_table(LIMITED), t, target, x)
    assert verify(t, x, LIMITED).violations == ()
    assert np.abs(x[-1] - np.clip(target[-1], LIMITED.position_min, LIMITED.position_max)).max() < 0.05


def test_a_long_flight_is_freed_only_where_it_must():
    """A minute of standing but for a yaw in the middle that the only frame which can turn is too slow for."""
    still = FrameLimits(-1e-6, 1e-6)
    rig = Rig("base", Geometry.VERTICAL_4, (FrameLimits(max_rate=20 * DEG, max_acceleration=1.0), still, still, still))
    t = np.arange(0.0, 60.0, 0.02)
    yaw = 20 * DEG * np.clip(t - 29.75, 0.0, 0.5) / 0.5
    made = plan(t, dcm_from_euler(yaw, 0.0, 0.0), rig)
    assert not made.verdict.feasible
    assert verify(t, made.solution.angles, rig).violations == ()
    assert made.solution.error.max() < 7 * DEG
    assert made.solution.error[(t < 25.0) | (t > 35.0)].max() < 1e-12


def test_a_path_inside_the_limits_is_found_again_exact():
    t, q = random_flight(1, 3.0, 250.0, 60 * DEG)
    C = dcm_from_quaternion(q)
    found = least_tolerance(Problem(t, C, LIMITED), [plan(t, C, LIMITED).solution.angles.copy()])
    assert found.tolerance < 1e-12
    assert not found.limited.any()
    assert verify(t, found.angles, LIMITED, C).violations == ()
