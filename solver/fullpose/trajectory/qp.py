"""One quadratic programme of a refinement, the matrices that a solver takes, and what it answers.

Unknowns: the coefficients c of the displacement, and one slack a group of rows, dear enough to be zero wherever the
limits can be met at all, so that an infeasible programme still says where it fails.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, NamedTuple, Protocol

import numpy as np
from scipy import sparse

from fullpose._typing import Array, Integers
from fullpose.trajectory.bspline import PINNED
from fullpose.trajectory.cost import QuadraticModel
from fullpose.trajectory.linearisation import Row

SLACK_COST = 100.0  # per whole limit and group; the rest of the cost is of the order of one a second
SLACK_CURVATURE = 1e-3  # makes the slacks unique
NO_DUALS = np.zeros(0)
Matrix = Any  # a SciPy sparse matrix, compressed columns


class Status(Enum):
    """How a solver ended. What it stopped at is a step all the same, unless it failed: the merit decides on it."""

    SOLVED = auto()  # to its tolerance
    INEXACT = auto()  # stopped before
    INFEASIBLE = auto()  # it found that no point satisfies the rows, or that the cost has no least value
    FAILED = auto()  # no numbers, or none that are finite


@dataclass(frozen=True)
class QuadraticProgramme:
    """min 1/2 c'Hc + g'c + slack, s.t. rows c - slack <= room, |c| <= trust, pinned ends zero, equalities.

    `every` = 1: the unknowns are the displacement's coefficients; 4: those of all four frames, frame fastest.
    """

    model: QuadraticModel  # H (size, band) H[j, j + b], g (size,)
    origin: Integers  # (r,)
    rows: Array  # (r, ROW or JERK_ROW)
    room: Array  # (r,)
    group: Integers  # (r,) rows of one group share a slack
    trust: float
    pinned: tuple[bool, bool]
    frame: Integers  # (r,) of the rows, where all frames are free; else 0
    equalities: tuple[Row, ...] = ()
    every: int = 1
    slack_cost: float = SLACK_COST

    @property
    def free(self) -> tuple[int, int]:
        """(begin, end) of the coefficients that are not pinned, half-open."""
        fixed = PINNED * self.every
        return fixed if self.pinned[0] else 0, len(self.model.g) - (fixed if self.pinned[1] else 0)


@dataclass(frozen=True)
class Matrices:
    """min 1/2 x'Px + q'x, Gx <= h, Ax = b, lower <= x <= upper; x = (c without its pinned ends, slack)."""

    P: Matrix
    q: Array
    G: Matrix
    h: Array  # inf: no constraint
    A: Matrix | None
    b: Array | None
    lower: Array
    upper: Array

    def numbers(self) -> Iterator[Array]:
        """All that must be finite."""
        yield from (self.P.data, self.q, self.G.data, self.h[self.h < np.inf])
        if self.A is not None and self.b is not None:
            yield from (self.A.data, self.b)


class Minimiser(NamedTuple):
    """x, how good it is, and the multipliers of the rows Gx <= h where the solver has them."""

    x: Array
    status: Status
    duals: Array = NO_DUALS


class Solver(Protocol):
    """Solves a programme; quiet whatever happens, and not the one to decide what a failure means."""

    def __call__(self, given: Matrices) -> Minimiser:
        """The minimiser (len(q),) of the programme."""
        ...


@dataclass(frozen=True)
class Answer:
    """Coefficients (size,), zero where the solver failed; the slack of each group of rows; how the solver ended."""

    coefficients: Array
    slack: Array
    status: Status


def matrices(problem: QuadraticProgramme) -> Matrices:
    """The programme as the solvers take it."""
    H = problem.model.H
    m, width = H.shape
    r = len(problem.origin)
    groups, group_of_row = np.unique(problem.group, return_inverse=True) if r else (np.empty(0, int), np.empty(0, int))
    s = len(groups)
    diagonals = [H[: m - b, b] for b in range(min(width, m))]
    upper_part: Matrix = sparse.diags(diagonals, list(range(len(diagonals))), shape=(m, m))
    hessian = upper_part + sparse.triu(upper_part, 1).T
    P: Matrix = sparse.block_diag([hessian, sparse.identity(s) * SLACK_CURVATURE], format="csc")
    q = np.concatenate([problem.model.g, np.full(s, problem.slack_cost)])
    column = (problem.origin[:, None] + np.arange(problem.rows.shape[1])) * problem.every + problem.frame[:, None]
    kept = problem.rows != 0.0
    row_number = np.repeat(np.arange(r), kept.sum(axis=1))
    G: Matrix = sparse.csc_matrix(
        (
            np.concatenate([problem.rows[kept], np.full(r, -1.0)]),
            (np.concatenate([row_number, np.arange(r)]), np.concatenate([column[kept], m + group_of_row])),
        ),
        shape=(r, m + s),
    )
    A, b = _equalities(problem, m + s)
    lower = np.concatenate([np.full(m, -problem.trust), np.zeros(s)])
    upper = np.concatenate([np.full(m, problem.trust), np.full(s, np.inf)])
    begin, end = problem.free
    keep = np.ones(m + s, bool)
    keep[:begin] = False
    keep[max(0, end) : m] = False
    if not keep.all():
        P, G = P[keep][:, keep], G[:, keep]
        A = A[:, keep] if A is not None else None
        q, lower, upper = q[keep], lower[keep], upper[keep]
    return Matrices(P.tocsc(), q, G.tocsc(), problem.room, A, b, lower, upper)


def _equalities(problem: QuadraticProgramme, size: int) -> tuple[Matrix | None, Array | None]:
    """(A, b) of the equalities over `size` unknowns."""
    if not problem.equalities:
        return None, None
    dense = np.zeros((len(problem.equalities), size))
    for k, each in enumerate(problem.equalities):
        for a in np.flatnonzero(each.row):
            dense[k, (each.origin + a) * problem.every + each.frame] = each.row[a]
    return sparse.csc_matrix(dense), np.array([each.value for each in problem.equalities])


def solve_programme(problem: QuadraticProgramme, solver: Solver) -> Answer:
    """The minimiser of a programme, in its own unknowns."""
    x, status, _ = solver(matrices(problem))
    begin, end = problem.free
    coefficients = np.zeros(len(problem.model.g))
    if status is not Status.FAILED:
        coefficients[begin:end] = x[: end - begin]
    return Answer(coefficients, x[end - begin :], status)
