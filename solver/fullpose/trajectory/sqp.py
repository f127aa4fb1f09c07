"""Refinement: a node path made smooth and brought inside every limit (mathematics, section 8, step 3).

Sequential quadratic programming. From an exact path d, displace it along the self-motion, x = d + n z(t), by the
quadratic programme of the linearised limits; put the result back on the solutions; again, until nothing moves.
"""

from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array, Flags
from fullpose.bounds import MET, RATE
from fullpose.rig import Rig
from fullpose.trajectory.bspline import Basis, spline_basis
from fullpose.trajectory.constraints import (
    LimitViolation,
    exceeded,
    largest_violation,
    lead_cuts,
    rig_limits,
    rows_within_reach,
)
from fullpose.trajectory.cost import Cost, QuadraticModel, cost_bands, cost_of, path_cost
from fullpose.trajectory.curve import LOCKED, closest_all, null_vectors
from fullpose.trajectory.linearisation import ROW, Iterate, Limits, Reach, Row, difference, displaced, fill_row
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import QuadraticProgramme, Status, solve_programme
from fullpose.trajectory.shortest_path import reference_rates

RATE_MET = 1e-4  # of the lowest rate limit: a start rate missed by less counts as taken up
VIOLATION_COST = 1e3  # merit of a limit exceeded by its whole; costs are about one a second at most
NEAR = 0.6  # share of a limit from which its rows are in the programme at once
FLAGGED = 1e-6  # of a limit: a sample over it by more has its rows from then on
STRIDE = 3.0  # rows a knot
SHRINK = 0.3  # of the trust region after a step that is none
SETTLED, STILL = 1e-3, 1e-7  # [rad] a step below which a path inside the limits is done; below which any is


@dataclass(frozen=True)
class Boundary:
    """What holds at the ends of a window of a path."""

    pinned: tuple[bool, bool] = (False, False)  # value, slope and bend stay
    leads: tuple[bool, bool] = (False, False)  # a lead from or to rest needs room
    start: bool = False  # the first pose stays
    start_rate: Array | None = None  # (4,) [rad/s] aimed at over the first interval


@dataclass(frozen=True)
class Refined:
    """A path after refinement, angles (n, 4) [rad], and how far outside the limits it still is."""

    angles: Array
    violation: LimitViolation
    iterations: int


@dataclass(frozen=True)
class Discretisation:
    """How a path of many samples is made a programme of some hundred unknowns and rows."""

    basis: Basis
    stride: int  # samples from one that has rows to the next
    limits: Limits  # the rig's, less the reserve


def discretised(problem: Problem) -> Discretisation:
    """Of a path of two samples at least."""
    time, options = problem.time, problem.options
    spacing = (time[-1] - time[0]) / (len(time) - 1)
    stride = max(1, int(options.knot / STRIDE / spacing))
    return Discretisation(spline_basis(time, options.knot), stride, rig_limits(problem.rig, options.reserve))


def mark_exceeded(time: Array, path: Array, limits: Limits, flags: Flags) -> None:
    """flags (n, 3 or 4) |= the samples of a path (n, 4) [rad] that are over a limit, by its kind."""
    violations, _ = exceeded(time, path, limits)
    flags |= (violations > FLAGGED).astype(np.uint8)


def locked(rig: Rig) -> bool:
    """Whether a frame does not move, which leaves no freedom."""
    return bool((rig.position_max - rig.position_min < LOCKED)[list(rig.geometry.frames)].any())


def refine(
    problem: Problem, angles: Array, boundary: Boundary, judged: int | None = None, missed_cost: float = 0.0
) -> Refined:
    """Refine one window: angles (n, 4) [rad] are exact poses to begin with.

    A rig with a locked frame leaves nothing to refine. Only the first `judged` samples count for the verdict of the
    window. `missed_cost`: what `missed_rate` of 1 costs in the choice among the iterations; 0: the start rate is aimed
    at, and other things may matter more.
    """
    time, rig, options = problem.time, problem.rig, problem.options
    true_limits = rig_limits(rig)
    d = angles.copy()
    best = Refined(d, largest_violation(time, d, true_limits, judged), 0)
    if len(time) < 2 or locked(rig):
        return Refined(d, largest_violation(time, d, true_limits), 0)
    mesh, cost = discretised(problem), cost_of(rig, options)

    def missed(path: Array) -> float:
        aimed = boundary.start_rate
        return missed_rate(time, path, rig, aimed) if aimed is not None and missed_cost > 0.0 else 0.0

    def merit_of(path: Array, violation: LimitViolation, fallen: int) -> float:
        merit = path_cost(time, path, cost, mesh.stride)
        merit += VIOLATION_COST * max(0.0, violation.share)
        merit += VIOLATION_COST * fallen
        return merit + missed_cost * missed(path)

    flags = np.zeros((len(time), mesh.limits.kinds), np.uint8)
    trust, count = options.trust, 0
    best_merit = merit_of(d, best.violation, 0)
    for count in range(1, options.iterations + 1):
        at = Iterate(time, d, np.empty_like(d))
        null_vectors(rig.geometry.horizontal, d, at.n)
        answer = solve_programme(_programme(boundary, mesh, cost, at, flags, trust), problem.solver)
        if answer.status is Status.FAILED:
            break
        moved = np.empty_like(d)
        displaced(d, at.n, mesh.basis, answer.coefficients, moved)
        mark_exceeded(time, moved, mesh.limits, flags)
        shift = float(np.abs(answer.coefficients).max())
        if boundary.start:
            moved[0] = angles[0]
        fallen = closest_all(rig.axes, rig.geometry.horizontal, problem.attitude, moved)
        violation = largest_violation(time, moved, true_limits, judged)
        mark_exceeded(time, moved, mesh.limits, flags)
        merit = merit_of(moved, violation, fallen)
        if merit < best_merit:
            better = best_merit - merit > 1e-3 * best_merit
            best, best_merit, d = Refined(moved, violation, count), merit, moved
            if violation.share <= MET and missed(moved) <= RATE_MET and (shift < SETTLED or not better):
                break
        else:
            trust *= SHRINK
        if shift < STILL or trust < STILL:
            break
    return Refined(best.angles, best.violation, count)


def missed_rate(time: Array, d: Array, rig: Rig, start_rate: Array) -> float:
    """The first interval's rate along the self-motion less start_rate's, as a share of the lowest rate limit.

    time (n,) [s], d (n, 4) [rad] exact, start_rate (4,) [rad/s].
    """
    n = np.empty((1, 4))
    null_vectors(rig.geometry.horizontal, d[:1], n)
    gap = float(n[0] @ (start_rate - (d[1] - d[0]) / (time[1] - time[0])))
    return abs(gap) / float(reference_rates(rig)[list(rig.geometry.frames)].min())


def _programme(
    boundary: Boundary, mesh: Discretisation, cost: Cost, at: Iterate, flags: Flags, trust: float
) -> QuadraticProgramme:
    """The quadratic programme of a step from `at`."""
    basis = mesh.basis
    model = QuadraticModel(np.zeros((basis.size, ROW)), np.zeros(basis.size))
    cost_bands(at, basis, mesh.stride, cost, model)
    rows = rows_within_reach(at, basis, mesh.limits, Reach(mesh.stride, flags, trust, NEAR))
    cuts = lead_cuts(at, basis, mesh.limits, boundary.leads)
    count = len(rows.origin) + len(cuts)
    return QuadraticProgramme(
        model=model,
        origin=np.r_[rows.origin, np.array([cut.origin for cut in cuts], np.int64)],
        rows=np.vstack([rows.rows, *(np.r_[cut.row, np.zeros(rows.rows.shape[1] - ROW)] for cut in cuts)]),
        room=np.r_[rows.room, [cut.value for cut in cuts]],
        group=np.r_[rows.origin, np.full(len(cuts), basis.size)],  # a slack a piece of the spline, one for the leads
        frame=np.zeros(count, np.int64),
        trust=trust,
        pinned=boundary.pinned,
        equalities=_start_rows(boundary, basis, at),
    )


def _start_rows(boundary: Boundary, basis: Basis, at: Iterate) -> tuple[Row, ...]:
    """row c = value: the first pose stays; the first interval's rate along the self-motion is the one aimed at."""
    rows = []
    if boundary.start:
        row = np.zeros(ROW)
        row[: basis.values.shape[1]] = basis.values[0]
        rows.append(Row(int(basis.first[0]), row, 0.0))
    if boundary.start_rate is not None:
        row, part = np.zeros(ROW), np.zeros(ROW)
        origin, value = 0, 0.0
        for i in range(4):
            origin = fill_row(RATE, 1, i, at, basis, part)
            row += at.n[0, i] * part
            value += at.n[0, i] * (boundary.start_rate[i] - difference(RATE, 1, i, at.time, at.d))
        rows.append(Row(origin, row, value))
    return tuple(rows)
