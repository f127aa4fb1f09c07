"""What happens first, and what then: derived again from the angles by SciPy and differences."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.flyable import flyable_path, rig_of
from fullpose.plan import Plan, PlanOptions, plan
from fullpose.plan.held_frame import held_frame
from fullpose.rig import FRAMES, FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import payload_attitudes
from fullpose.vocabulary import Certainty, Consequence

DEG = np.pi / 180.0
LIMITED = builtin_rigs()["vertical-limited"]
NARROW = FrameLimits(-20 * DEG, 20 * DEG, 100 * DEG, 500 * DEG)
STOPPED = FrameLimits(-60 * DEG, 60 * DEG, 120 * DEG, 400 * DEG)
STILL = FrameLimits(-1e-6, 1e-6)
AXES = {Geometry.VERTICAL_4: "yzyx", Geometry.HORIZONTAL_4: "zyzx"}
UNIT = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def smooth_step(t: np.ndarray) -> np.ndarray:
    s = np.clip(t, 0.0, 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s * s)


def too_fast():
    t, q = random_flight(0, 4.0, 100.0, 230 * DEG)
    return t, dcm_from_quaternion(q), LIMITED


def pitch_beyond():
    t = np.arange(0.0, 3.0, 0.01)
    return t, dcm_from_euler(0.0, 35 * DEG * np.sin(t), 0.0), Rig("narrow", Geometry.VERTICAL_4, (NARROW,) * 4)


def roll_beyond():
    t = np.arange(0.0, 6.0, 0.01)
    roll = 150 * DEG * smooth_step((t - 1.0) / 3.0)
    base = FrameLimits(max_rate=120 * DEG, max_acceleration=400 * DEG)
    return t, dcm_from_euler(0.1 * t, 0.3, roll), Rig("stopped", Geometry.VERTICAL_4, (base, STOPPED, STOPPED, STOPPED))


def stops_cut():
    """A path of frames, each turning as far as 50 deg, on a rig whose stops are at 26."""
    rig = rig_of("tight", Geometry.VERTICAL_4)
    t, path = flyable_path(62, rig, 0.6, 2.5, 100.0)
    low = tuple(replace(frame, min=-26 * DEG, max=26 * DEG) for frame in rig.frames)
    return t, payload_attitudes(rig, path), replace(rig, frames=low)


def rates_cut():
    """A path of frames at 1.7 times the rates of the rig."""
    rig = rig_of("multi", Geometry.HORIZONTAL_4)
    beyond = tuple(
        replace(frame, max_rate=1.7 * frame.max_rate, max_acceleration=3.0 * frame.max_acceleration)
        for frame in rig.frames
    )
    t, path = flyable_path(41, replace(rig, frames=beyond), 0.98, 2.5, 100.0)
    return t, payload_attitudes(rig, path), rig


FLIGHTS = {
    "too fast": too_fast,
    "pitch beyond the stops": pitch_beyond,
    "roll beyond the stop": roll_beyond,
    "stops cut": stops_cut,
    "rates cut": rates_cut,
}


@dataclass(frozen=True)
class Case:
    """One flight, planned."""

    time: np.ndarray
    attitude: np.ndarray
    rig: Rig
    made: Plan


@pytest.fixture(scope="module", params=FLIGHTS)
def case(request) -> Case:
    t, C, rig = FLIGHTS[request.param]()
    return Case(t, C, rig, plan(t, C, rig))


def turned(rig: Rig, angles: np.ndarray) -> Rotation:
    """Payload to reference, by SciPy."""
    made = Rotation.identity()
    for axis, angle in zip(AXES[rig.geometry], angles, strict=True):
        made = made * Rotation.from_rotvec(angle * np.array(UNIT[axis]))
    return made


def exact_with(case: Case, frame: int, begin: int, end: int) -> np.ndarray:
    """The exact path for samples begin..end with one frame's angles as written: three unknowns a sample, by SciPy."""
    others = [i for i in range(4) if i != frame]
    given = case.made.solution.angles
    path = given[begin:end].copy()
    at, before = given[begin, others].copy(), None
    for row, k in enumerate(range(begin, end)):
        target = Rotation.from_matrix(case.attitude[k].T)

        def missed(x, row=row, target=target):
            d = path[row].copy()
            d[others] = x
            return (turned(case.rig, d).inv() * target).as_rotvec()

        guess = at if before is None else 2.0 * at - before
        found = least_squares(missed, guess, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        assert np.abs(found.fun).max() < 1e-8
        before, at = (None if before is None and row == 0 else at), found.x
        path[row, others] = found.x
    return path


def value_at(time: np.ndarray, angles: np.ndarray, frame: int, limit: str, when: float) -> float:
    """Position, rate or acceleration at a sample, by differences."""
    k = int(np.argmin(np.abs(time - when)))
    x = angles[:, frame]
    if limit == "position":
        return x[k]
    rate = lambda j: (x[j] - x[j - 1]) / (time[j] - time[j - 1])  # noqa: E731
    return rate(k) if limit == "rate" else (rate(k + 1) - rate(k)) / (0.5 * (time[k + 1] - time[k - 1]))


def bounds_of(rig: Rig, frame: int, limit: str) -> tuple[float, float]:
    limits = rig.frames[frame]
    most = {"rate": limits.max_rate, "acceleration": limits.max_acceleration}.get(limit)
    return (limits.min, limits.max) if most is None else (-most, most)


def test_first_a_frame_is_on_the_limit_that_is_named_and_blocks(case):
    verdict, angles = case.made.verdict, case.made.solution.angles
    first = verdict.reason.first
    assert (verdict.blocking.time, verdict.blocking.frame, verdict.blocking.limit) == (
        first.time, first.frame, first.limit,
    )  # fmt: skip
    assert case.made.solution.blocking == verdict.blocking
    frame = FRAMES.index(first.frame)
    value = value_at(case.time, angles, frame, first.limit, first.time)
    assert value == pytest.approx(first.value, rel=1e-9, abs=1e-12)
    assert first.bound in bounds_of(case.rig, frame, first.limit)
    room = abs(value - first.bound)
    assert room <= (0.05 * DEG if first.limit == "position" else 0.02 * abs(first.bound))


def test_then_the_attitude_needs_what_is_named(case):
    reason = case.made.verdict.reason
    first, then = reason.first, reason.then
    assert then is not None
    assert first.time <= then.time
    frame = FRAMES.index(first.frame)
    angles = case.made.solution.angles
    k = int(np.argmin(np.abs(case.time - then.time)))
    if reason.consequence == Consequence.SAME_FRAME:
        pitch = np.arcsin(abs(case.attitude[k][0, 1]))
        assert (then.frame, then.limit) == (first.frame, "position")
        assert then.frame == "outer"
        assert abs(then.value) == pytest.approx(pitch, abs=1e-9)  # |sin d2| >= |sin pitch|, whatever the others do
        assert then.bound == pytest.approx(angles[k, frame])
        assert abs(then.value) > abs(then.bound)
        return
    exact = np.flatnonzero(case.made.solution.error[: k + 1] <= 1e-12)
    begin = max(0, int(exact[-1]) - 1) if exact.size else 0
    path = exact_with(case, frame, begin, min(len(case.time), k + 2))
    other = FRAMES.index(then.frame)
    assert other != frame
    needed = value_at(case.time[begin:], path, other, then.limit, then.time)
    assert needed == pytest.approx(then.value, rel=1e-3, abs=1e-6)
    low, high = bounds_of(case.rig, other, then.limit)
    assert then.bound in (low, high)
    assert not low <= needed <= high


def test_a_single_frame_that_is_too_slow_is_told_of_itself():
    rig = Rig("base", Geometry.VERTICAL_4, (FrameLimits(max_rate=20 * DEG), STILL, STILL, STILL))
    t = np.arange(0.0, 4.0, 0.02)
    yaw = 20 * DEG * np.clip(t - 2.0 + 0.25, 0.0, 0.5) / 0.5  # twice the rate there is
    reason = plan(t, dcm_from_euler(yaw, 0.0, 0.0), rig).verdict.reason
    assert (reason.first.frame, reason.first.limit) == ("base", "rate")
    assert reason.consequence == Consequence.SAME_FRAME
    assert reason.then.value == pytest.approx(40 * DEG, rel=1e-6)


def test_a_three_axis_rig_has_one_exact_path():
    t = np.arange(0.0, 4.0, 0.01)
    held = FrameLimits(-60 * DEG, 60 * DEG, 200 * DEG, 900 * DEG)
    rig = Rig("three", Geometry.VERTICAL_3, (FrameLimits(),) * 2 + (held, FrameLimits()))
    angles = np.stack([0 * t, 0.2 * t, 75 * DEG * smooth_step((t - 1.0) / 2.0), 0.1 * t], axis=1)
    reason = plan(t, payload_attitudes(rig, angles), rig).verdict.reason
    assert (reason.first.frame, reason.first.limit) == ("middle", "position")
    assert (reason.then.frame, reason.consequence) == ("middle", Consequence.SAME_FRAME)
    assert reason.then.value == pytest.approx(75 * DEG, abs=1e-3)


def test_how_sure_is_apart_and_a_flight_that_fits_has_no_reason(case):
    verdict = case.made.verdict
    assert verdict.certainty in (Certainty.GRID_COMPLETE, Certainty.EVIDENCE)
    assert ("not a proof" in verdict.how_sure) == (verdict.certainty == Certainty.EVIDENCE)
    assert verdict.how_sure[1:] in verdict.statement
    t, q = random_flight(1, 2.0, 100.0, 60 * DEG)
    fits = plan(t, dcm_from_quaternion(q), LIMITED).verdict
    assert fits.reason is None
    assert fits.certainty == Certainty.CHECKED
    none = plan(case.time, case.attitude, case.rig, options=PlanOptions(best_effort=False)).verdict
    assert none.blocking == verdict.closed


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("frame", range(4))
@pytest.mark.parametrize("seed", range(4))
def test_a_path_is_found_again_from_any_of_its_frames(geometry, frame, seed):
    """Away from the folds a frame's angles leave a branch to choose, and the first sample chooses it."""
    rig = Rig("free", geometry)
    t = np.linspace(0.0, 1.0, 300)
    middle = np.array([0.4, 0.9, 0.5, -0.7]) + 0.1 * np.random.default_rng(seed).normal(size=4)
    x = middle + 0.2 * np.sin(np.outer(t, [3.0, 4.0, 5.0, 2.0]) + seed)
    held = held_frame(rig, payload_attitudes(rig, x), x, frame)
    assert held.exists.all()
    assert np.abs(held.angles - x).max() < 1e-9
