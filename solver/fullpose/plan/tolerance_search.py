"""The least tolerance of one stretch: many starts on a coarse mesh, the best of them on a fine one."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.plan.tolerance_starts import starts
from fullpose.trajectory.frame_spline import FrameSpline
from fullpose.trajectory.minimax import TOLERANCE, minimax, within
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.tolerance_mesh import Ends, Mesh, inside_limits, mesh_of
from fullpose.verify import attitude_errors, payload_attitudes

COARSE = 0.1  # [s] between the knots of the coarse mesh
LOOKS = 3  # samples that a mesh looks at, a knot
ROUNDS = ((4, 0.35), (6, 0.3), (15, 0.0))  # iterations of each, and the share of the starts that goes on
SURVIVORS = 3  # go on at least
FINALISTS = 2  # on the fine mesh
ITERATIONS = 25  # there
HAIR = 1e-3  # of the tolerance: what the least squared error may use beyond it
MISSED = 1e-3  # of the tolerance: a sample that is over it by more is looked at from then on
LOOKS_AGAIN = 3  # times at most
Heard = Callable[[], None]  # called now and then; may raise `CancelledError`


@dataclass(frozen=True)
class Solved:
    """A stretch solved: the mesh, the splines at all samples, the unknowns, the largest error [rad] at all samples."""

    problem: Problem
    mesh: Mesh
    spline: FrameSpline
    unknowns: Array
    tolerance: float

    @property
    def angles(self) -> Array:
        """(n, 4) [rad]"""
        return self.spline.at_samples(self.mesh.coefficients(self.unknowns))


def search_stretch(problem: Problem, ends: Ends, given: Iterable[Array], heard: Heard) -> Solved | None:
    """The least tolerance found from the paths `given` (n, 4) [rad] and others; None where none comes inside."""
    first = ends[0]
    mesh, spline, at = _mesh(problem, max(COARSE, problem.options.knot), ends)
    pool: list[tuple[float, Array]] = []
    for path in chain(given, starts(problem, None if first is None else first.values)):
        heard()
        inside = inside_limits(problem, mesh, path[at])
        if inside is not None:
            pool.append((float(mesh.errors(inside).max()), inside))
    for iterations, share in ROUNDS:
        carried = []
        for _, unknowns in pool:
            heard()
            found = minimax(mesh, unknowns, TOLERANCE, problem.solver, iterations)
            carried.append((found.tolerance, found.unknowns))
        carried.sort(key=lambda each: each[0])
        pool = carried[: max(SURVIVORS, int(share * len(carried)))]
    candidates = [spline.at_samples(mesh.coefficients(unknowns)) for _, unknowns in pool[:FINALISTS]]
    solved = [each for path in candidates if (each := _finely(problem, ends, path, heard)) is not None]
    return min(solved, key=lambda each: each.tolerance, default=None)


def _mesh(
    problem: Problem, knot: float, ends: Ends, more: Integers | None = None
) -> tuple[Mesh, FrameSpline, Integers]:
    """The mesh of some samples of a stretch, `more` among them; the splines at all; the samples."""
    time = problem.time
    n = len(time)
    spacing = float(time[-1] - time[0]) / (n - 1)
    every = max(1, int(knot / LOOKS / spacing))
    at = np.unique(np.r_[np.arange(0, n, every), n - 1, np.empty(0, np.int64) if more is None else more])
    mesh, spline = mesh_of(problem, knot, at, ends)
    return mesh, spline, at


def _finely(problem: Problem, ends: Ends, path: Array, heard: Heard) -> Solved | None:
    """The least tolerance next to path (n, 4) [rad], the samples that a mesh leaves out looked at where they matter."""
    knot = problem.options.knot
    mesh, spline, at = _mesh(problem, knot, ends)
    unknowns = inside_limits(problem, mesh, path[at])
    if unknowns is None:
        return None
    for _ in range(LOOKS_AGAIN):
        heard()
        found = minimax(mesh, unknowns, TOLERANCE, problem.solver, ITERATIONS)
        unknowns = found.unknowns
        error = _errors(problem, spline.at_samples(mesh.coefficients(unknowns)))
        beyond = np.flatnonzero(error > found.tolerance * (1.0 + MISSED))
        if not beyond.size:
            break
        mesh, spline, at = _mesh(problem, knot, ends, np.union1d(at, beyond))
    return Solved(problem, mesh, spline, unknowns, float(error.max()))


def _errors(problem: Problem, angles: Array) -> Array:
    return attitude_errors(payload_attitudes(problem.rig, angles), problem.attitude)[0]


def least_squares(solved: Solved, tolerance: float) -> Solved:
    """The least mean squared error of a stretch within a tolerance [rad] that is not below its own, or a hair more."""
    aim = within(tolerance * (1.0 + HAIR))
    found = minimax(solved.mesh, solved.unknowns, aim, solved.problem.solver, ITERATIONS)
    after = replace(solved, unknowns=found.unknowns)
    return replace(after, tolerance=float(_errors(solved.problem, after.angles).max()))
