"""A stretch of a flight with all four frames free: the least squared attitude error inside the limits.

Gauss-Newton on the integral of the error squared, the limits, which are linear in the frames' angles, as rows of the
quadratic programme, joined to what lies beside it with value, slope and bend.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.bounds import EXACT, MET, Bound
from fullpose.methods.start_pose import start_pose
from fullpose.trajectory.bspline import WIDTH, Basis
from fullpose.trajectory.constraints import largest_violation, rig_limits, rows_within_reach
from fullpose.trajectory.cost import Cost, QuadraticModel, cost_of, error_bands
from fullpose.trajectory.linearisation import ROW, Iterate, Reach, Row, displaced
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import QuadraticProgramme, Status, solve_programme
from fullpose.trajectory.sqp import NEAR, SHRINK, Discretisation, discretised, mark_exceeded

ERROR_WEIGHT = 1e4  # [1/rad^2] beside rates and accelerations squared as shares of their limits
SLACK_COST = 1e5  # of a limit exceeded by its whole: the limits win over the attitude
TRUST = 0.5  # [rad] a frame moves in one iteration at most
ITERATIONS = 25
HOPELESS = 6  # iterations after which a stretch over a limit by its whole is given up
SETTLED, STILL = 1e-5, 1e-6  # [rad] a step below which a path inside the limits is done; a trust region as small is
FRAMES_FREE = 4


@dataclass(frozen=True)
class Freed:
    """A stretch after it: angles (n, 4) [rad], which samples are given up (n,), how far outside the limits it is."""

    angles: Array
    missed: NDArray[np.bool_]
    violation: float


def free_frames(problem: Problem, angles: Array, pinned: tuple[bool, bool]) -> Freed:
    """Free all frames of angles (n, 4) [rad]; `pinned` ends stay. The start, where the problem has one, is kept."""
    time, rig = problem.time, problem.rig
    if len(time) < 2:
        return _alone(problem, angles)
    true_limits = rig_limits(rig)
    mesh, cost = discretised(problem), cost_of(rig, problem.options)
    flags = np.zeros((len(time), 3), np.uint8)
    ones = np.ones_like(angles)
    at, trust = Iterate(time, angles.copy(), ones), TRUST
    _, model = _model(problem, mesh, cost, at)
    best = np.inf, at.d
    for iteration in range(ITERATIONS):
        rows = rows_within_reach(at, mesh.basis, mesh.limits, Reach(mesh.stride, flags, trust, NEAR))
        programme = QuadraticProgramme(
            model=model, origin=rows.origin, rows=rows.rows, room=rows.room, group=rows.origin,
            frame=Bound(*rows.bound.T).frame, trust=trust, pinned=pinned, equalities=_start_rows(problem, mesh, at),
            every=FRAMES_FREE, slack_cost=SLACK_COST,
        )  # fmt: skip
        answer = solve_programme(programme, problem.solver)
        if answer.status is Status.FAILED:
            break
        moved = _displaced(at.d, mesh.basis, answer.coefficients)
        mark_exceeded(time, moved, mesh.limits, flags)
        share = largest_violation(time, moved, true_limits).share
        error, model_there = _model(problem, mesh, cost, Iterate(time, moved, ones))
        merit = error + SLACK_COST * max(0.0, share)
        shift = float(np.abs(answer.coefficients).max())
        if merit < best[0]:
            settled = best[0] - merit < 1e-4 * best[0] and share <= MET
            best = merit, moved
            at, model = Iterate(time, moved, ones), model_there
            if settled or (shift < SETTLED and share <= MET):
                break
        else:
            trust *= SHRINK
            if trust < STILL:
                break
        if iteration >= HOPELESS and largest_violation(time, at.d, true_limits).share > 1.0:
            break
    return Freed(best[1], np.ones(len(time), np.bool_), largest_violation(time, best[1], true_limits).share)


def _alone(problem: Problem, x: Array) -> Freed:
    """A flight of one sample with no exact pose inside the ranges: the pose in them that comes closest.

    A three-axis rig's is its Euler angles, each as far as its range goes.
    """
    rig = problem.rig
    if not rig.geometry.redundant:
        return Freed(np.clip(x, rig.position_min, rig.position_max), np.ones(1, np.bool_), 0.0)
    pose, code = start_pose(rig, problem.attitude[0], x[0])
    return Freed(pose[None], np.array([code != EXACT]), 0.0)


def _displaced(x: Array, basis: Basis, coefficients: Array) -> Array:
    """x (n, 4) with each frame displaced by its own coefficients, frame fastest."""
    moved, column = np.empty_like(x), np.empty_like(x)
    for i in range(FRAMES_FREE):
        direction = np.zeros_like(x)
        direction[:, i] = 1.0
        displaced(x, direction, basis, np.ascontiguousarray(coefficients[i::FRAMES_FREE]), column)
        moved[:, i] = column[:, i]
    return moved


def _model(problem: Problem, mesh: Discretisation, cost: Cost, at: Iterate) -> tuple[float, QuadraticModel]:
    """(the attitude error, its model) of the path `at`."""
    size = FRAMES_FREE * mesh.basis.size
    model = QuadraticModel(np.zeros((size, FRAMES_FREE * ROW)), np.zeros(size))
    rig = problem.rig
    error = error_bands(rig.axes, problem.attitude, at, mesh.basis, mesh.stride, ERROR_WEIGHT, cost, model)
    return error, model


def _start_rows(problem: Problem, mesh: Discretisation, at: Iterate) -> tuple[Row, ...]:
    """The first pose is the start, where the problem has one."""
    if problem.start is None:
        return ()
    row = np.zeros(ROW)
    row[:WIDTH] = mesh.basis.values[0]
    first = int(mesh.basis.first[0])
    return tuple(Row(first, row, float(problem.start[i] - at.d[0, i]), i) for i in problem.rig.geometry.frames)
