"""`plan` as a whole: start and start rate, progress, cancelling, options, margins, the path through the singularity."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.errors import CancelledError, InputError, MethodError
from fullpose.methods.exact import ExactOptions
from fullpose.plan import PlanOptions, plan
from fullpose.plan.verdict import check, margins
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.solve import solve
from fullpose.trajectory.curve import null_vectors
from fullpose.verify import verify
from fullpose.vocabulary import Decision

DEG = np.pi / 180.0
RIGS = builtin_rigs()
LIMITED = RIGS["vertical-limited"]


def flight(seed=1, duration=3.0, rate=60.0, hz=250.0):
    t, q = random_flight(seed, duration, hz, rate * DEG)
    return t, dcm_from_quaternion(q)


def test_solve_offers_it():
    t, C = flight()
    solution = solve(t, C, LIMITED, "plan", clock=iter(np.arange(100.0)).__next__)
    assert solution.method == "plan"
    assert solution.blocking is None
    assert solution.solve_time > 0.0
    with pytest.raises(MethodError, match="PlanOptions"):
        solve(t, C, LIMITED, "plan", options=ExactOptions())


@settings(max_examples=12)
@given(st.integers(0, 10_000), st.sampled_from(["vertical-4", "horizontal-4", "vertical-limited"]), st.floats(20, 110))
def test_what_is_called_feasible_is(seed, name, rate):
    t, C = flight(seed, 2.0, rate, 200.0)
    made = plan(t, C, RIGS[name])
    found = verify(t, made.solution.angles, RIGS[name], C)
    assert found.violations == ()
    assert made.verdict.feasible == (found.max_error < 1e-12)
    assert made.verdict.feasible == (made.solution.limited_samples == 0)
    if made.verdict.feasible:
        assert found.max_matrix_error < 1e-14


def test_a_start_in_motion_is_taken_up():
    t, C = flight(2)
    whole = plan(t, C, LIMITED).solution.angles
    cut = 300
    rate = (whole[cut + 1] - whole[cut]) / (t[1] - t[0])
    part = plan(t[cut:], C[cut:], LIMITED, start=whole[cut], start_rate=rate)
    assert part.verdict.feasible
    x = part.solution.angles
    assert np.abs(x[0] - whole[cut]).max() < 1e-9
    assert np.abs((x[1] - x[0]) / (t[1] - t[0]) - rate).max() < 0.02 * rate.max()


STILL = np.array([1.0, 0.2, 0.1, 0.1])  # [rad]


def slow_flight():
    t = np.arange(0.0, 4.0, 0.004)
    return t, dcm_from_euler(0.5 * np.sin(t), 0.3 + 0.2 * np.sin(t), 0.0 * t)


def along(angles, t, rate):
    """(asked, flown) rate along the self-motion over the first interval."""
    n = np.empty((1, 4))
    null_vectors(False, angles[:1], n)
    return n[0] @ rate, n[0] @ (angles[1] - angles[0]) / (t[1] - t[0])


@pytest.mark.parametrize("start", [STILL, None])
@pytest.mark.parametrize("base_rate", [-2.0, 3.0])
def test_what_the_attitude_leaves_free_of_a_start_rate_is_flown(start, base_rate):
    t, C = slow_flight()
    rate = np.array([base_rate, 0.0, 0.0, 0.0])
    made = plan(t, C, RIGS["vertical-4"], start=start, start_rate=rate)
    assert made.verdict.feasible
    asked, flown = along(made.solution.angles, t, rate)
    assert flown == pytest.approx(asked, abs=2e-3)


def test_a_start_rate_that_cannot_be_kept_is_not_feasible():
    t, C = slow_flight()
    at = plan(t, C, LIMITED).solution.angles[0]
    frames = list(LIMITED.frames)
    frames[0] = replace(frames[0], min=at[0] - 2.0, max=at[0] + 1e-3, home=at[0])
    rig = Rig("at its stop", Geometry.VERTICAL_4, tuple(frames))
    made = plan(t, C, rig, start=at, start_rate=[3.0, 0.0, 0.0, 0.0], options=PlanOptions(best_effort=False))
    assert plan(t, C, rig, start=at).verdict.feasible
    assert not made.verdict.feasible
    assert made.verdict.blocking is not None
    assert made.verdict.decided_by == Decision.START_RATE


@pytest.mark.parametrize(
    ("rate", "named"),
    [([np.nan] * 4, "four finite"), ([1.0, 2.0, 3.0], "four finite"), ([0.0, 100.0, 0.0, 0.0], "outer")],
)
def test_a_start_rate_that_is_none_is_refused(rate, named):
    t, C = slow_flight()
    for start in (STILL, None):
        with pytest.raises(InputError, match=f"start_rate.*{named}"):
            plan(t, C, RIGS["vertical-4"], start=start, start_rate=rate)


def test_a_start_outside_the_range_is_no_start():
    t, C = flight()
    with pytest.raises(InputError, match="inner"):
        plan(t, C, LIMITED, start=[0.0, 0.0, 0.0, 2.0])


def test_progress_rises_and_cancels():
    t, C = flight(duration=8.0)
    told = []
    plan(t, C, LIMITED, progress=lambda done, total: told.append((done, total)))
    assert len(told) > 2
    assert all(0 <= done < total == len(t) for done, total in told)
    assert [done for done, _ in told] == sorted(done for done, _ in told)  # one node path, refined: no way back
    assert told[-1][0] == len(t) - 1

    def stop(done, total):
        raise CancelledError("enough")

    with pytest.raises(CancelledError):
        plan(t, C, LIMITED, progress=stop)


@pytest.mark.parametrize("name", ["vertical-4", "vertical-limited"])
def test_a_level_roll_past_the_inner_limit_goes_straight_through_the_singularity(name):
    t = np.arange(0.0, 4.0, 0.004)
    C = dcm_from_euler(0.0, 0.0, 90 * DEG * t)
    made = plan(t, C, RIGS[name])
    assert made.verdict.feasible
    assert made.solution.matrix_error.max() < 5e-15
    assert verify(t, made.solution.angles, RIGS[name], C).violations == ()
    if name == "vertical-limited":
        assert made.margins.singularity[0] < 1e-3


def test_a_locked_frame_is_held_and_the_others_follow():
    locked = FrameLimits(0.5, 0.5, home=0.5)
    rig = Rig("locked", Geometry.VERTICAL_4, (locked, FrameLimits(), FrameLimits(), FrameLimits()))
    t = np.arange(0.0, 3.0, 0.01)
    C = dcm_from_euler(0.4 * np.sin(t), 0.3 * np.cos(t), 0.5 * t)
    made = plan(t, C, rig)
    assert made.verdict.feasible
    assert np.abs(made.solution.angles[:, 0] - 0.5).max() < 1e-9
    assert made.solution.matrix_error.max() < 1e-14


def test_weights_move_the_work_to_the_lighter_frame():
    t = np.arange(0.0, 3.0, 0.01)
    C = dcm_from_euler(np.sin(2 * t), 0.0, 0.0)  # base and middle share the yaw
    moved = []
    for weight in (0.05, 20.0):
        frames = (replace(RIGS["vertical-4"].frames[0], weight=weight), *RIGS["vertical-4"].frames[1:])
        angles = plan(t, C, Rig("weighted", Geometry.VERTICAL_4, frames)).solution.angles
        moved.append(np.abs(np.diff(angles[:, 0])).sum())
    assert moved[0] > 3.0 * moved[1]


def test_margins_and_check_in_pieces_agree_with_the_whole(monkeypatch):
    t, C = flight()
    x = plan(t, C, LIMITED).solution.angles
    whole, whole_check = margins(t, x, LIMITED), check(t, C, 1.5 * x, LIMITED)
    monkeypatch.setattr(import_module("fullpose.plan.verdict"), "CHUNK", 100)
    parts, parts_check = margins(t, x, LIMITED), check(t, C, 1.5 * x, LIMITED)
    for name in ("position", "rate", "acceleration"):
        assert np.array_equal(getattr(whole, name), getattr(parts, name), equal_nan=True)
    assert whole.singularity == parts.singularity
    assert np.array_equal(whole_check.error, parts_check.error)
    assert {(v.frame, v.limit) for v in whole_check.violations} == {(v.frame, v.limit) for v in parts_check.violations}
    peaks = verify(t, x, LIMITED).peaks
    assert whole.rate[:, 0] == pytest.approx(LIMITED.max_rate - peaks[:, 1])
    assert whole.acceleration[:, 0] == pytest.approx(LIMITED.max_acceleration - peaks[:, 2])


def test_an_attitude_that_jumps_between_samples_is_refused():
    t = np.arange(0.0, 1.0, 0.01)
    C = dcm_from_euler(np.where(t < 0.5, 0.0, 1.0), 0.0, 0.0)
    made = plan(t, C, LIMITED)
    assert not made.verdict.feasible
    assert made.verdict.closed.time == pytest.approx(0.5, abs=0.06)
    assert made.verdict.blocking.time <= 0.56  # a frame is on a limit before it, to be where it must be
    assert verify(t, made.solution.angles, LIMITED).violations == ()


def test_without_best_effort_the_verdict_is_the_same():
    t, C = flight(0, 4.0, 230.0)
    with_effort, without = plan(t, C, LIMITED), plan(t, C, LIMITED, options=PlanOptions(best_effort=False))
    assert with_effort.verdict.feasible == without.verdict.feasible
    assert with_effort.verdict.closed == without.verdict.closed == without.verdict.blocking
