"""The least tolerance of one stretch: the likeliest of many starts on a coarse mesh, the best of them on a fine one.

A start is judged first by what it loses when it is followed inside the limits, which costs next to nothing; what is
optimised is given up as soon as it stays behind the least tolerance found by then.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.limits import limit_table
from fullpose.plan.follow import follow
from fullpose.plan.tolerance_starts import more_starts, starts
from fullpose.trajectory.frame_spline import FrameSpline
from fullpose.trajectory.minimax import TOLERANCE, Minimax, begun, minimax, within
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.tolerance_mesh import Ends, Mesh, inside_limits, mesh_of
from fullpose.verify import attitude_errors, payload_attitudes

COARSE = 0.1  # [s] between the knots of the coarse mesh
LOOKS = 3  # samples that a mesh looks at, a knot
SCREENED = 6  # starts that are optimised at all, by each of two scores
PEAKED = 6.0  # power of the errors that decides which
SAME = 0.02  # [rad] starts as near in every coefficient are one
RUNGS = ((3, 2.5), (4, 1.4), (4, 1.12), (8, 0.0))  # iterations, and times the least so far that go on
FAR = math.radians(25.0)  # a least tolerance above which more is tried
FINALISTS = 2  # on the fine mesh
CLOSE = 1.1  # times the least tolerance of the coarse mesh that a second finalist has at most
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
    mesh, spline, at = _mesh(problem, max(COARSE, problem.options.knot), ends)
    first = None if ends[0] is None else ends[0].values

    def inside(paths: Iterable[Array]) -> Iterator[tuple[Array, Minimax]]:
        for path in paths:
            heard()
            unknowns = inside_limits(problem, mesh, path[at])
            if unknowns is not None:
                yield path, begun(mesh, unknowns)

    known = [each for _, each in inside(given)]
    ended = _climbed(problem, mesh, known + _screened(problem, mesh, first, inside(starts(problem, first))), [], heard)
    if not ended or ended[0].tolerance > FAR:
        ended = _climbed(problem, mesh, [each for _, each in inside(more_starts(problem, first))], ended, heard)
    if not ended:
        return None
    close = [each for each in ended if each.tolerance <= CLOSE * ended[0].tolerance][:FINALISTS]
    candidates = [spline.at_samples(mesh.coefficients(each.unknowns)) for each in close]
    solved = [each for path in candidates if (each := _finely(problem, ends, path, heard)) is not None]
    return min(solved, key=lambda each: each.tolerance, default=None)


def _screened(
    problem: Problem, mesh: Mesh, first: Array | None, every: Iterable[tuple[Array, Minimax]]
) -> list[Minimax]:  # fmt: skip
    """Of starts those that lose least at the beginning, or when their path is followed inside the limits.

    every: paths (n, 4) [rad] and where each begins; first (1.., 4): what is fixed at the first sample.
    """
    table = limit_table(problem.rig)
    followed = np.empty((len(problem), 4))
    lost, lost_following, begins = [], [], []
    for path, begin in every:
        target = path
        if first is not None:
            target = path.copy()
            target[0] = first[0]
        follow(table, problem.time, target, followed)
        lost_following.append(float(np.mean(_errors(problem, followed) ** PEAKED)))
        lost.append(float(np.mean(mesh.errors(begin.unknowns) ** PEAKED)))
        begins.append(begin)
    chosen: list[Minimax] = []
    for scores in (lost_following, lost):
        order = np.argsort(scores, kind="stable")[:SCREENED]
        chosen += [
            each
            for each in (begins[k] for k in order)
            if all(np.abs(each.unknowns - other.unknowns).max() > SAME for other in chosen)
        ]
    return chosen


def _climbed(
    problem: Problem, mesh: Mesh, pool: list[Minimax], before: list[Minimax], heard: Heard
) -> list[Minimax]:  # fmt: skip
    """The pool optimised one after another, the best first; what stays behind the best so far is not gone on with."""
    ended = [*before]
    least = min((each.tolerance for each in before), default=math.inf)
    for each in sorted(pool, key=lambda each: each.tolerance):
        now = each
        for iterations, behind in RUNGS:
            heard()
            now = minimax(mesh, now, TOLERANCE, problem.solver, iterations)
            if now.settled or now.tolerance > behind * least:
                break
        least = min(least, now.tolerance)
        ended.append(now)
    return sorted(ended, key=lambda each: each.tolerance)


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
        found = minimax(mesh, begun(mesh, unknowns), TOLERANCE, problem.solver, ITERATIONS)
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
    found = minimax(solved.mesh, begun(solved.mesh, solved.unknowns), aim, solved.problem.solver, ITERATIONS)
    after = replace(solved, unknowns=found.unknowns)
    return replace(after, tolerance=float(_errors(solved.problem, after.angles).max()))
