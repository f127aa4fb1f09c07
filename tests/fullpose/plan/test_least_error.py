"""Flights that cannot be flown: inside every limit all the same, marked, and no worse than they need be."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import EXACT, limited_code
from fullpose.limits import limit_table
from fullpose.plan import plan
from fullpose.plan.fallback import Fallback
from fullpose.plan.least_error import feasible, follow, from_feasible, least_error
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.problem import Problem
from fullpose.verify import attitude_errors, payload_attitudes, verify

DEG = np.pi / 180.0
RIGS = builtin_rigs()
LIMITED = RIGS["vertical-limited"]


def closest_feasible(t, C):
    """Where the least error begins without a path near the limits."""
    problem = Problem(t, C, LIMITED)
    return feasible(problem, np.empty((0, 4)), Fallback(problem))


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


def test_the_error_is_smaller_than_of_paths_taken_sample_by_sample(too_fast):
    t, C, made = too_fast
    closest = closest_feasible(t, C)
    assert verify(t, closest, LIMITED, C).violations == ()
    error, _ = attitude_errors(payload_attitudes(LIMITED, closest), C)
    assert np.mean(made.solution.error**2) < 0.25 * np.mean(error**2)


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


def test_the_squared_error_is_never_more_than_where_it_began(too_fast):
    """That is what it minimises: a stretch that does not get better stays as it is."""
    t, C, _ = too_fast
    begin = closest_feasible(t, C)
    found = from_feasible(Problem(t, C, LIMITED), begin.copy())
    before, after = (attitude_errors(payload_attitudes(LIMITED, x), C)[0] for x in (begin, found.angles))
    assert verify(t, found.angles, LIMITED).violations == ()
    assert np.sum(after**2) <= np.sum(before**2)


def test_an_exact_path_inside_the_limits_is_left_alone():
    t, q = random_flight(1, 3.0, 250.0, 60 * DEG)
    C = dcm_from_quaternion(q)
    path = plan(t, C, LIMITED).solution.angles.copy()
    problem = Problem(t, C, LIMITED)
    found = least_error(problem, path, Fallback(problem))
    assert np.array_equal(found.angles, path)
    assert not found.limited.any()
