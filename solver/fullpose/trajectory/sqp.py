"""Refinement: a node path made smooth and brought inside every limit (mathematics, section 8, step 3).

From an exact path d, displace it along the self-motion, x = d + n z(t), by the quadratic programme of the linearised
limits; put the result back on the solutions; again, until nothing moves. Long flights go window by window, each
joined to the one before with value, slope and bend.
"""

from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array, Flags
from fullpose.rig import Rig
from fullpose.trajectory.bspline import Basis, spline_basis
from fullpose.trajectory.constraints import Limits, rig_limits, rows_within_reach
from fullpose.trajectory.curve import LOCKED, closest_all, null_vectors
from fullpose.trajectory.linearisation import (
    ROW,
    cost_bands,
    difference,
    displaced,
    fill_row,
    over_limits,
)
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.qp import Equality, QuadraticProgramme, solve_programme
from fullpose.trajectory.shortest_path import reference_rates

CHUNK = 1 << 17  # samples looked at together
RATE_MET = 1e-4  # of the lowest rate limit: a start rate missed by less counts as taken up
MET = 1e-7  # of a limit: over it by less counts as inside
OVERRUN = 1e3  # merit of a limit exceeded by its whole; costs are about one a second at most
ROOM = 0.8  # of v^2 / a: the way that a lead needs between rest and rate v
SHORTEST = 3.0  # samples: a lead has four at least, of half the rate on average, and the rate it starts from may rise
LEAD_UNIT = 0.005  # [rad] short of that room counts as much as the whole of a rate limit
STRIDE = 3.0  # rows a knot


def locked(rig: Rig) -> bool:
    """Whether a frame does not move, which leaves no freedom."""
    return bool((rig.position_max - rig.position_min < LOCKED)[list(rig.geometry.frames)].any())


@dataclass(frozen=True)
class Refined:
    """A path after refinement: angles (n, 4) [rad], how far outside the limits it still is, and where."""

    angles: Array
    over: float  # largest overrun as a share of the limit; <= 0 inside
    sample: int  # where that is
    frame: int
    limit: int
    iterations: int


def worst(time: Array, angles: Array, limits: Limits, last: int | None = None) -> tuple[float, int, int, int]:
    """(overrun, sample, frame, limit) of the sample farthest outside, among the first `last`."""
    n = len(time) if last is None else min(last, len(time))
    best = (-np.inf, 0, 0, 0)
    for begin in range(0, n, CHUNK):
        end = min(n, begin + CHUNK)
        part = slice(max(0, begin - 1), end + 1)
        over = np.empty((len(time[part]), 3))
        frame = np.empty((len(time[part]), 3), np.int8)
        over_limits(time[part], angles[part], limits.low, limits.high, limits.rate, limits.acceleration, over, frame)
        own = over[begin - part.start : end - part.start]
        k, kind = np.unravel_index(np.argmax(own), own.shape)
        if own[k, kind] > best[0]:
            best = float(own[k, kind]), begin + int(k), int(frame[begin - part.start + k, kind]), int(kind)
    return best


def refine(
    time: Array, attitude: Array, angles: Array, rig: Rig, options: PlanOptions, *,
    pinned: tuple[bool, bool] = (False, False), start: bool = False, start_rate: Array | None = None,
    ends: tuple[bool, bool] = (False, False), judged: int | None = None, iterations: int | None = None,
    missed_cost: float = 0.0,
) -> Refined:  # fmt: skip
    """One window: time (n,), attitude (n, 3, 3), angles (n, 4) exact poses to begin with.

    `pinned` ends keep value, slope and bend; `start` keeps the first pose, `start_rate` (4,) [rad/s] the rate of the
    first interval. A rig with a locked frame leaves nothing to refine. `ends` are where a lead from or to rest needs
    room. Only the first `judged` samples count for the verdict of the window. `missed_cost`: what `missed_rate` of 1
    costs in the choice among the iterations; 0: the start rate is aimed at, and other things may matter more.
    """
    n = len(time)
    limits = rig_limits(rig, options.reserve)
    true_limits = rig_limits(rig)
    d = angles.copy()
    if n < 2 or locked(rig):
        return Refined(d, *worst(time, d, true_limits), 0)
    horizontal = rig.geometry.horizontal
    basis = spline_basis(time, options.knot)
    spacing = (time[-1] - time[0]) / (n - 1)
    stride = max(1, int(options.knot / STRIDE / spacing))
    flags = np.zeros((n, 3), np.uint8)
    over = np.empty((n, 3))
    whose = np.empty((n, 3), np.int8)
    trust = options.trust
    best = Refined(d, *worst(time, d, true_limits, judged), 0)

    def missed(path: Array) -> float:
        return missed_rate(time, path, rig, start_rate) if start_rate is not None and missed_cost > 0.0 else 0.0

    best_cost = path_cost(time, d, rig, options, stride) + OVERRUN * max(0.0, best.over) + missed_cost * missed(d)
    count = 0
    for count in range(1, (iterations or options.iterations) + 1):
        problem = _programme(
            time, d, rig, limits, options, basis, stride, flags, trust, pinned, start, start_rate, ends
        )
        answer = solve_programme(problem[0])
        moved = np.empty_like(d)
        displaced(d, problem[1], basis.first, basis.values, answer.coefficients, moved)
        over_limits(time, moved, limits.low, limits.high, limits.rate, limits.acceleration, over, whose)
        flags |= (over > 1e-6).astype(np.uint8)
        shift = float(np.abs(answer.coefficients).max())
        if start:
            moved[0] = angles[0]
        fallen = closest_all(rig.axes, horizontal, attitude, moved)
        result = Refined(moved, *worst(time, moved, true_limits, judged), count)
        over_limits(time, moved, limits.low, limits.high, limits.rate, limits.acceleration, over, whose)
        flags |= (over > 1e-6).astype(np.uint8)
        cost = path_cost(time, moved, rig, options, stride)
        merit = cost + OVERRUN * max(0.0, result.over) + OVERRUN * fallen
        short = missed(moved)
        merit += missed_cost * short
        if merit < best_cost:
            better = best_cost - merit > 1e-3 * best_cost
            best, best_cost = result, merit
            d = moved
            if result.over <= MET and short <= RATE_MET and (shift < 1e-3 or not better):
                break
        else:
            trust *= 0.3
        if shift < 1e-7 or trust < 1e-7:
            break
    return Refined(best.angles, best.over, best.sample, best.frame, best.limit, count)


def missed_rate(time: Array, d: Array, rig: Rig, start_rate: Array) -> float:
    """The first interval's rate along the self-motion less start_rate's, as a share of the lowest rate limit.

    time (n,) [s], d (n, 4) [rad] exact, start_rate (4,) [rad/s].
    """
    n = np.empty((1, 4))
    null_vectors(rig.geometry.horizontal, d[:1], n)
    gap = float(n[0] @ (start_rate - (d[1] - d[0]) / (time[1] - time[0])))
    return abs(gap) / float(reference_rates(rig)[list(rig.geometry.frames)].min())


def _programme(
    time: Array, d: Array, rig: Rig, limits: Limits, options: PlanOptions, basis: Basis, stride: int, flags: Flags,
    trust: float, pinned: tuple[bool, bool], start: bool, start_rate: Array | None, ends: tuple[bool, bool],
) -> tuple[QuadraticProgramme, Array]:  # fmt: skip
    n = np.empty_like(d)
    null_vectors(rig.geometry.horizontal, d, n)
    rate_weight, acceleration_weight = cost_weights(rig, options)
    bands = np.zeros((basis.size, ROW))
    gradient = np.zeros(basis.size)
    cost_bands(
        time, d, n, basis.first, basis.values, stride, rate_weight, acceleration_weight, rig.home,
        _home_cost(rig, options),
        options.singularity_margin, options.singularity_cost, bands, gradient,
    )  # fmt: skip
    origin, rows, bound, _ = rows_within_reach(time, d, n, limits, basis, stride, flags, trust)
    equalities = []
    if start:
        row = np.zeros(ROW)
        row[: basis.values.shape[1]] = basis.values[0]
        equalities.append(Equality(int(basis.first[0]), row, 0.0))
    if start_rate is not None:
        row = np.zeros(ROW)
        at = 0
        value = 0.0
        for i in range(4):
            part = np.zeros(ROW)
            at = fill_row(1, 1, i, time, n, basis.first, basis.values, part)
            row += n[0, i] * part
            value += n[0, i] * (start_rate[i] - difference(1, 1, i, time, d))
        equalities.append(Equality(at, row, value))
    cuts = lead_cuts(time, d, n, basis, limits, ends)
    group = origin
    if cuts:
        origin = np.r_[origin, [cut.origin for cut in cuts]]
        rows = np.vstack([rows, [cut.row for cut in cuts]])
        bound = np.r_[bound, [cut.value for cut in cuts]]
        group = np.r_[group, np.full(len(cuts), basis.size)]
    problem = QuadraticProgramme(
        bands,
        gradient,
        origin,
        rows,
        bound,
        np.zeros(len(origin), np.int64),
        group,
        trust,
        pinned,
        tuple(equalities),
    )
    return problem, n


def lead_cuts(time: Array, d: Array, n: Array, basis: Basis, limits: Limits, ends: tuple[bool, bool]) -> list[Equality]:
    """Rows c <= value that leave room for the leads: ROOM v^2 / a between rest and rate v, by its tangents, and a few
    samples' way."""
    cuts: list[Equality] = []
    count = len(time)
    for at_end in (False, True):
        if not ends[at_end] or count < 3:
            continue
        k, first = (count - 1, count - 2) if at_end else (0, 0)
        origin = int(basis.first[first])
        shift = int(basis.first[k]) - origin
        h = time[first + 1] - time[first]
        for i in np.flatnonzero(np.isfinite(limits.high)).tolist():
            rate_row = np.zeros(ROW)
            fill_row(1, first + 1, i, time, n, basis.first, basis.values, rate_row)
            here = np.zeros(ROW)
            here[shift : shift + basis.values.shape[1]] = n[k, i] * basis.values[k]
            rate = difference(1, first + 1, i, time, d)
            a = limits.acceleration[i]
            for side in (1.0, -1.0):  # the end of the range that the frame runs to after the end, or came from before
                room = limits.high[i] - d[k, i] if side > 0 else d[k, i] - limits.low[i]
                toward = side if at_end else -side
                tops = limits.rate[i] if np.isfinite(limits.rate[i]) else max(abs(rate), 1.0)
                # Without an acceleration limit the samples' way is all: one row.
                for v in np.r_[np.linspace(0.2, 1.0, 5) * tops, abs(rate)] if np.isfinite(a) else (0.0,):
                    slope = 2.0 * ROOM * v / a + SHORTEST * h
                    row = side * here + toward * slope * rate_row
                    value = room - slope * toward * rate + ROOM / a * v * v
                    cuts.append(Equality(origin, row / LEAD_UNIT, value / LEAD_UNIT))
    return cuts


def _home_cost(rig: Rig, options: PlanOptions) -> float:
    return 0.0 if not np.isfinite(rig.position_max).any() else options.home_cost


def cost_weights(rig: Rig, options: PlanOptions) -> tuple[Array, Array]:
    """(rate (4,), acceleration (4,)) weights of the squared differences: each as a share of its limit."""
    rates = reference_rates(rig)
    acceleration = np.where(np.isfinite(rig.max_acceleration), rig.max_acceleration, 5.0 * rates)
    present = rig.axes >= 0
    return (
        np.where(present, rig.weight / rates**2, 0.0),
        np.where(present, options.acceleration_cost * rig.weight / acceleration**2, 0.0),
    )


def path_cost(time: Array, d: Array, rig: Rig, options: PlanOptions, stride: int) -> float:
    """The cost that the programme models, of a whole path (n, 4) [rad]."""
    h = np.diff(time)
    rate = np.diff(d, axis=0) / h[:, None]
    rate_weight, acceleration_weight = cost_weights(rig, options)
    total = float(np.sum(rate**2 * rate_weight * h[:, None]))
    if len(time) > 2:
        mid = 0.5 * (h[1:] + h[:-1])
        total += float(np.sum((np.diff(rate, axis=0) / mid[:, None]) ** 2 * acceleration_weight * mid[:, None]))
    some = d[::stride]
    span = np.gradient(time[::stride]) if len(some) > 1 else np.ones(1)
    measure = np.sin(some[:, 1]) ** 2 + np.cos(some[:, 2]) ** 2
    short = np.maximum(0.0, 1.0 - measure / options.singularity_margin)
    total += float(np.sum(options.singularity_cost * short**2 * span))
    home = _home_cost(rig, options)
    if home:
        total += float(np.sum(home * (some - rig.home) ** 2 * span[:, None]))
    return total
