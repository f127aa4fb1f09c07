"""The best that can be done for a flight that cannot be flown: the least attitude error inside the limits.

The exact path stays wherever it is inside every limit. Around each place where it is not, all four frames are set
free: the squared attitude error (Gauss-Newton, the integral over time) is minimised under the limits, joined to the
exact path on both sides with value, slope and bend. Where the stretch is too short for that it is made longer.
"""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Codes
from fullpose.bounds import MET
from fullpose.limits import ACCELERATION, MAX, MIN, approach_rate, empty_box, limit_box, limit_table
from fullpose.plan.active_limits import active_limits
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.plan.gauss_newton import Freed, free_frames
from fullpose.trajectory.constraints import exceeded, largest_violation, rig_limits
from fullpose.trajectory.problem import Problem
from fullpose.verify import attitude_errors, payload_attitudes

PADDING = 0.25  # [s] of the exact path given up on each side of a place outside the limits, at first
LARGEST_PADDING = 4.0  # [s]; beyond it the whole flight starts again from a path inside the limits
LONGEST = 60.0  # [s] of a stretch whose frames are all set free at once
APART = 8  # samples of the exact path at least between two stretches


@dataclass(frozen=True)
class BestEffort:
    """angles (n, 4) [rad], limited (n,) codes, and how far outside the limits it still is (a share; <= 0 inside)."""

    angles: Array
    limited: Codes
    violation: float


@dataclass(frozen=True)
class _Stretch:
    """Samples begin..end (half-open) outside the limits, and how much [s] is given up around them."""

    begin: int
    end: int
    padding: float

    def range(self, time: Array) -> tuple[int, int]:
        """The samples given up, half-open."""
        return (
            int(np.searchsorted(time, time[self.begin] - self.padding)),
            int(np.searchsorted(time, time[self.end - 1] + self.padding, side="right")),
        )


def _merged(stretches: list[_Stretch], time: Array) -> list[_Stretch]:
    """The same, those that meet made one."""
    merged: list[_Stretch] = []
    for stretch in stretches:
        while merged and stretch.range(time)[0] <= merged[-1].range(time)[1] + APART:
            last = merged.pop()
            stretch = _Stretch(last.begin, stretch.end, max(last.padding, stretch.padding))
        merged.append(stretch)
    return merged


def least_error(problem: Problem, angles: Array, fallback: Fallback) -> BestEffort:
    """Bring the exact path angles (n, 4) [rad] inside the limits, giving up the attitude where that cannot be helped.

    The start is kept, where the problem has one.
    """
    time, rig = problem.time, problem.rig
    exact = angles.copy()
    if problem.start is not None:
        exact[0] = problem.start
    freed = _mended(problem, exact, _outside(problem, angles, exact))
    if freed is None:
        return afresh(problem, angles, fallback)
    x, missed = exact, np.zeros(len(time), np.bool_)
    for (begin, end), part in freed.items():
        x[begin:end], missed[begin:end] = part.angles, part.missed
    violation = largest_violation(time, x, rig_limits(rig)).share
    if violation > MET:
        return afresh(problem, angles, fallback)
    return BestEffort(x, active_limits(time, problem.attitude, x, rig, missed), violation)


def _outside(problem: Problem, angles: Array, exact: Array) -> list[_Stretch]:
    """The places where `exact` is outside the limits; its start too where `angles` do not begin there."""
    time = problem.time
    violation, _ = exceeded(time, exact, rig_limits(problem.rig))
    if problem.start is not None and np.abs(angles[0] - problem.start).max() > MET:
        violation[0, 0] = np.inf
    return _merged([_Stretch(int(k), int(k) + 1, PADDING) for k in np.flatnonzero(violation.max(axis=1) > MET)], time)


def _mended(problem: Problem, exact: Array, stretches: list[_Stretch]) -> dict[tuple[int, int], Freed] | None:
    """Every stretch freed, made longer until it is inside the limits; None where that is no way."""
    time = problem.time
    n = len(time)
    freed: dict[tuple[int, int], Freed] = {}
    while True:
        grown: list[_Stretch] = []
        for stretch in stretches:
            begin, end = stretch.range(time)
            if time[end - 1] - time[begin] > LONGEST:
                return None
            if (begin, end) not in freed:
                freed[begin, end] = free_frames(problem.part(begin, end), exact[begin:end], (begin > 0, end < n))
            if freed[begin, end].violation > MET:
                if (begin == 0 and end == n) or stretch.padding >= LARGEST_PADDING:
                    return None
                stretch = _Stretch(stretch.begin, stretch.end, 2.0 * stretch.padding)
            grown.append(stretch)
        following = _merged(grown, time)
        if following == stretches:
            return {stretch.range(time): freed[stretch.range(time)] for stretch in stretches}
        stretches = following


def afresh(problem: Problem, angles: Array, fallback: Fallback) -> BestEffort:
    """The least error that is found without a path near the limits to begin from; `angles` as `feasible` wants them."""
    return from_feasible(problem, feasible(problem, angles, fallback))


def feasible(problem: Problem, angles: Array, fallback: Fallback) -> Array:
    """A path (n, 4) [rad] inside every limit, whatever its attitude error.

    A four-axis rig's is the closest of `fallback`; a three-axis rig's follows `angles` frame by frame.
    """
    if problem.rig.geometry.redundant:
        return fallback.closest()
    x = np.empty_like(angles)
    follow(limit_table(problem.rig), problem.time, angles, x)
    return x


def from_feasible(problem: Problem, angles: Array) -> BestEffort:
    """The least error next to a path (n, 4) [rad] inside the limits, stretch by stretch where it is not exact.

    A stretch that is longer than `LONGEST`, or does not get better, stays as it is.
    """
    time, attitude, rig = problem.time, problem.attitude, problem.rig
    n = len(time)
    limits = rig_limits(rig)
    x = angles.copy()
    error, _ = attitude_errors(payload_attitudes(rig, x), attitude)
    lost = np.flatnonzero(error > EXACT_ERROR) if n > 1 else ()
    for stretch in _merged([_Stretch(int(k), int(k) + 1, PADDING) for k in lost], time):
        begin, end = stretch.range(time)
        part = slice(begin, end)
        if time[end - 1] - time[begin] > LONGEST:
            continue
        freed = free_frames(problem.part(begin, end), x[part], (begin > 0, end < n))
        after, _ = attitude_errors(payload_attitudes(rig, freed.angles), attitude[part])
        if freed.violation > MET or float(np.mean(after**2)) >= float(np.mean(error[part] ** 2)):
            continue
        before = x[part].copy()
        x[part] = freed.angles
        beside = slice(max(0, begin - 2), min(n, end + 2))
        if largest_violation(time[beside], x[beside], limits).share > MET:
            x[part] = before
        else:
            error[part] = after
    limited = active_limits(time, attitude, x, rig, error > EXACT_ERROR)
    return BestEffort(x, limited, largest_violation(time, x, limits).share)


@kernel
def follow(table: Array, time: Array, target: Array, x: Array) -> None:
    """x (n, 4) <- a path inside the limits (`limit_table`) after target (n, 4) [rad], as fast as it can brake."""
    n = time.shape[0]
    v = np.zeros(4)
    box = empty_box()
    for i in range(4):
        x[0, i] = min(max(target[0, i], table[MIN, i]), table[MAX, i])
    past = 0.0
    for k in range(1, n):
        h = time[k] - time[k - 1]
        limit_box(table, x[k - 1], v, past, h, box)
        for i in range(4):
            gap = target[k - 1, i] - x[k - 1, i]
            speed = approach_rate(abs(gap), 0.5 * table[ACCELERATION, i], h)
            wanted = target[k, i] - target[k - 1, i] + (speed if gap > 0.0 else -speed) * h
            x[k, i] = min(max(x[k - 1, i] + wanted, box.lo[i]), box.hi[i])
            v[i] = (x[k, i] - x[k - 1, i]) / h
        past = h
