"""The best that can be done for a flight that cannot be flown: the least attitude error inside the limits.

The exact path stays wherever it is inside every limit. Around each place where it is not, all four frames are set
free: the squared attitude error (Gauss-Newton, the integral over time) is minimised under the limits, which are
linear in the frames' angles, joined to the exact path on both sides with value, slope and bend. Where the stretch is
too short for that it is made longer.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Codes, Flags
from fullpose.bounds import EXACT
from fullpose.limits import ACCELERATION, MAX, MIN, approach_rate, empty_box, limit_box, limit_table
from fullpose.methods.start_pose import start_pose
from fullpose.plan.active_limits import active_limits
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.rig import Rig
from fullpose.trajectory.bspline import WIDTH, Basis, spline_basis
from fullpose.trajectory.constraints import Limits, rig_limits, rows_within_reach
from fullpose.trajectory.linearisation import ROW, displaced, error_bands, over_limits
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.qp import Equality, QuadraticProgramme, solve_programme
from fullpose.trajectory.sqp import MET, STRIDE, cost_weights, worst
from fullpose.verify import attitude_errors, payload_attitudes

PADDING = 0.25  # [s] of the exact path given up on each side of a place outside the limits, at first
ERROR_WEIGHT = 1e4  # [1/rad^2] beside rates and accelerations squared as shares of their limits
SLACK_COST = 1e5  # of a limit exceeded by its whole: the limits win over the attitude
LARGEST_PADDING = 4.0  # [s]; beyond it the whole flight starts again from a path inside the limits
LONGEST = 60.0  # [s] of a stretch whose frames are all set free at once
APART = 8  # samples of the exact path at least between two stretches
TRUST = 0.5  # [rad] a frame moves in one iteration at most
ITERATIONS = 25
HOPELESS = 6  # iterations after which a stretch over a limit by its whole is given up


@dataclass(frozen=True)
class BestEffort:
    """angles (n, 4) [rad], limited (n,) codes, and how far outside the limits it still is (a share; <= 0 inside)."""

    angles: Array
    limited: Codes
    over: float


def least_error(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, start: Array | None = None,
    fallback: Fallback | None = None,
) -> BestEffort:  # fmt: skip
    """Bring the exact path angles (n, 4) [rad] inside the limits, giving up the attitude where that cannot be helped.

    start (4,) [rad]: the first pose, kept as it is.
    """
    n = len(time)
    limits = rig_limits(rig)
    over, whose = np.empty((n, 3)), np.empty((n, 3), np.int8)
    exact = angles.copy()
    if start is not None:
        exact[0] = start
    over_limits(time, exact, limits.low, limits.high, limits.rate, limits.acceleration, over, whose)
    if start is not None and np.abs(angles[0] - start).max() > MET:
        over[0, 0] = np.inf
    bad = np.flatnonzero(over.max(axis=1) > MET)
    stretches = _merged([_Stretch(int(k), int(k) + 1, PADDING) for k in bad], time)

    def again() -> BestEffort:  # what cannot be mended place by place
        return afresh(time, attitude, angles, rig, options, start, fallback)

    freed: dict[tuple[int, int], tuple[Array, NDArray[np.bool_], float]] = {}
    while True:
        grown: list[_Stretch] = []
        for stretch in stretches:
            begin, end = stretch.range(time)
            if time[end - 1] - time[begin] > LONGEST:
                return again()
            if (begin, end) not in freed:
                freed[begin, end] = _free(
                    time[begin:end], attitude[begin:end], exact[begin:end], rig, options, (begin > 0, end < n),
                    start if begin == 0 else None,
                )  # fmt: skip
            if freed[begin, end][2] > MET:
                if (begin == 0 and end == n) or stretch.padding >= LARGEST_PADDING:
                    return again()
                stretch = _Stretch(stretch.begin, stretch.end, 2.0 * stretch.padding)
            grown.append(stretch)
        merged = _merged(grown, time)
        if merged == stretches:
            break
        stretches = merged
    x, missed = exact, np.zeros(n, np.bool_)
    for stretch in stretches:
        part = slice(*stretch.range(time))
        x[part], missed[part], _ = freed[part.start, part.stop]
    excess = worst(time, x, limits)[0]
    return BestEffort(x, active_limits(time, attitude, x, rig, missed), excess) if excess <= MET else again()


def afresh(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, start: Array | None,
    fallback: Fallback | None = None,
) -> BestEffort:  # fmt: skip
    """The least error that is found without a path near the limits to begin from; `angles` as `feasible` wants them."""
    return from_feasible(time, attitude, feasible(time, attitude, angles, rig, start, fallback), rig, options, start)


def feasible(
    time: Array, attitude: Array, angles: Array, rig: Rig, start: Array | None, fallback: Fallback | None = None
) -> Array:
    """A path (n, 4) [rad] inside every limit, whatever its attitude error.

    A four-axis rig's is the closest of `fallback`; a three-axis rig's follows `angles` frame by frame.
    """
    if not rig.geometry.redundant:
        x = np.empty_like(angles)
        follow(limit_table(rig), time, angles, x)
        return x
    return (fallback or Fallback(time, attitude, rig, start)).closest()


def from_feasible(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, start: Array | None
) -> BestEffort:
    """The least error next to a path (n, 4) [rad] inside the limits, stretch by stretch where it is not exact.

    A stretch that is longer than `LONGEST`, or does not get better, stays as it is.
    """
    n = len(time)
    limits = rig_limits(rig)
    x = angles.copy()
    error, _ = attitude_errors(payload_attitudes(rig, x), attitude)
    lost = np.flatnonzero(error > EXACT_ERROR)
    for stretch in _merged([_Stretch(int(k), int(k) + 1, PADDING) for k in lost], time) if n > 1 else []:
        begin, end = stretch.range(time)
        part = slice(begin, end)
        if time[end - 1] - time[begin] > LONGEST:
            continue
        pinned = (begin > 0, end < n)
        freed, _, over = _free(time[part], attitude[part], x[part], rig, options, pinned, start if begin == 0 else None)
        after, _ = attitude_errors(payload_attitudes(rig, freed), attitude[part])
        if over > MET or float(np.mean(after**2)) >= float(np.mean(error[part] ** 2)):
            continue
        before = x[part].copy()
        x[part] = freed
        beside = slice(max(0, begin - 2), min(n, end + 2))
        if worst(time[beside], x[beside], limits)[0] > MET:
            x[part] = before
        else:
            error[part] = after
    return BestEffort(x, active_limits(time, attitude, x, rig, error > EXACT_ERROR), worst(time, x, limits)[0])


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
        if merged and stretch.range(time)[0] <= merged[-1].range(time)[1] + APART:
            last = merged.pop()
            stretch = _Stretch(last.begin, stretch.end, max(last.padding, stretch.padding))
            while merged and stretch.range(time)[0] <= merged[-1].range(time)[1] + APART:
                last = merged.pop()
                stretch = _Stretch(last.begin, stretch.end, max(last.padding, stretch.padding))
        merged.append(stretch)
    return merged


def _free(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, pinned: tuple[bool, bool],
    start: Array | None,
) -> tuple[Array, NDArray[np.bool_], float]:  # fmt: skip
    """(angles (n, 4), missed (n,), overrun) of one stretch with all frames free; its seams count."""
    n = len(time)
    x = angles.copy()
    if n < 2:
        return _alone(attitude, x, rig)
    limits, true_limits = rig_limits(rig, options.reserve), rig_limits(rig)
    basis = spline_basis(time, options.knot)
    stride = max(1, int(options.knot / STRIDE / ((time[-1] - time[0]) / (n - 1))))
    flags = np.zeros((n, 3), np.uint8)
    over, whose = np.empty((n, 3)), np.empty((n, 3), np.int8)
    ones = np.eye(4)
    trust = TRUST
    best: tuple[float, Array] | None = None
    for iteration in range(ITERATIONS):
        problem = _programme(time, attitude, x, rig, limits, options, basis, stride, flags, trust, pinned, start)
        answer = solve_programme(problem)
        moved = np.empty_like(x)
        for i in range(4):
            column = np.empty((n, 4))
            displaced(
                x,
                np.tile(ones[i], (n, 1)),
                basis.first,
                basis.values,
                np.ascontiguousarray(answer.coefficients[i::4]),
                column,
            )
            moved[:, i] = column[:, i]
        over_limits(time, moved, limits.low, limits.high, limits.rate, limits.acceleration, over, whose)
        flags |= (over > 1e-6).astype(np.uint8)
        outside = worst(time, moved, true_limits)[0]
        bands = np.zeros_like(problem.bands)
        error = error_bands(
            rig.axes, time, attitude, moved, basis.first, basis.values, stride, ERROR_WEIGHT,
            *cost_weights(rig, options), bands, np.zeros(len(problem.gradient)),
        )  # fmt: skip
        merit = error + SLACK_COST * max(0.0, outside)
        shift = float(np.abs(answer.coefficients).max())
        if best is None or merit < best[0]:
            settled = best is not None and best[0] - merit < 1e-4 * best[0] and outside <= MET
            best = merit, moved
            x = moved
            if settled or (shift < 1e-5 and outside <= MET):
                break
        else:
            trust *= 0.3
            if trust < 1e-6:
                break
        if iteration >= HOPELESS and worst(time, x, true_limits)[0] > 1.0:
            break
    assert best is not None
    return best[1], np.ones(n, np.bool_), worst(time, best[1], true_limits)[0]


def _alone(attitude: Array, x: Array, rig: Rig) -> tuple[Array, NDArray[np.bool_], float]:
    """A flight of one sample with no exact pose inside the ranges: the pose in them that comes closest.

    A three-axis rig's is its Euler angles, each as far as its range goes.
    """
    if not rig.geometry.redundant:
        return np.clip(x, rig.position_min, rig.position_max), np.ones(1, np.bool_), 0.0
    pose, code = start_pose(rig, attitude[0], x[0])
    return pose[None], np.array([code != EXACT]), 0.0


def _programme(
    time: Array, attitude: Array, x: Array, rig: Rig, limits: Limits, options: PlanOptions, basis: Basis, stride: int,
    flags: Flags, trust: float, pinned: tuple[bool, bool], start: Array | None,
) -> QuadraticProgramme:  # fmt: skip
    size = 4 * basis.size
    bands, gradient = np.zeros((size, 4 * ROW)), np.zeros(size)
    error_bands(
        rig.axes, time, attitude, x, basis.first, basis.values, stride, ERROR_WEIGHT,
        *cost_weights(rig, options), bands, gradient,
    )  # fmt: skip
    origin, rows, bound, tag = rows_within_reach(time, x, np.ones_like(x), limits, basis, stride, flags, trust)
    equalities = []
    if start is not None:
        for i in rig.geometry.frames:
            row = np.zeros(ROW)
            row[:WIDTH] = basis.values[0]
            equalities.append(Equality(int(basis.first[0]), row, float(start[i] - x[0, i]), i))
    return QuadraticProgramme(
        bands,
        gradient,
        origin,
        rows,
        bound,
        tag % 12 // 3,
        origin,
        trust,
        pinned,
        tuple(equalities),
        4,
        SLACK_COST,
    )
