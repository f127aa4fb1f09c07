"""One quadratic programme of the refinement: built here, solved by PIQP (docs/decisions/0005-planner.md).

Unknowns: the coefficients c of the displacement, and one slack a bin of the path, dear enough to be zero wherever the
limits can be met at all, so that an infeasible programme still says where it fails.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import piqp
from scipy import sparse

from fullpose._typing import Array, Integers
from fullpose.trajectory.bspline import PINNED
from fullpose.trajectory.linearisation import ROW

SLACK_COST = 100.0  # per whole limit and bin; the rest of the cost is of the order of one a second
TOLERANCE = 1e-7
Matrix = Any  # a SciPy sparse matrix, compressed columns


@dataclass(frozen=True)
class Equality:
    """row c = value, over the ROW coefficients from `origin` on, of one frame where all are free."""

    origin: int
    row: Array
    value: float
    frame: int = 0


@dataclass(frozen=True)
class QuadraticProgramme:
    """min 1/2 c'Hc + g'c + slack, s.t. rows c - slack <= bound, |c| <= trust, pinned ends zero, equalities.

    `every` = 1: the unknowns are the displacement's coefficients; 4: those of all four frames, frame fastest.
    """

    bands: Array  # (size, band) H[j, j + b]
    gradient: Array  # (size,)
    origin: Integers  # (r,)
    rows: Array  # (r, ROW)
    bound: Array  # (r,)
    frame: Integers  # (r,)
    group: Integers  # (r,) rows of one group share a slack
    trust: float
    pinned: tuple[bool, bool]
    equalities: tuple[Equality, ...] = ()
    every: int = 1
    slack_cost: float = SLACK_COST


@dataclass(frozen=True)
class Answer:
    """Coefficients (size,), slack (bins,), multipliers of the rows (r,), whether the solver came to its tolerance."""

    coefficients: Array
    slack: Array
    multipliers: Array
    solved: bool
    iterations: int


@dataclass(frozen=True)
class Matrices:
    """min 1/2 x'Px + q'x, Gx <= h, Ax = b, lower <= x <= upper; x = (c without its pinned ends, slack)."""

    P: Matrix
    q: Array
    G: Matrix
    h: Array
    A: Matrix | None
    b: Array | None
    lower: Array
    upper: Array


def matrices(problem: QuadraticProgramme) -> Matrices:
    """The programme as the solvers take it."""
    m, width = problem.bands.shape
    every = problem.every
    r = len(problem.origin)
    bins, bin_of_row = np.unique(problem.group, return_inverse=True) if r else (np.empty(0, int), np.empty(0, int))
    s = len(bins)
    diagonals = [problem.bands[: m - b, b] for b in range(min(width, m))]
    upper_part: Matrix = sparse.diags(diagonals, list(range(len(diagonals))), shape=(m, m))
    hessian = upper_part + sparse.triu(upper_part, 1).T
    P: Matrix = sparse.block_diag([hessian, sparse.identity(s) * 1e-3], format="csc")
    q = np.concatenate([problem.gradient, np.full(s, problem.slack_cost)])
    column = (problem.origin[:, None] + np.arange(ROW)) * every + (problem.frame[:, None] if every > 1 else 0)
    kept = problem.rows != 0.0
    row_number = np.repeat(np.arange(r), kept.sum(axis=1))
    G: Matrix = sparse.csc_matrix(
        (
            np.concatenate([problem.rows[kept], np.full(r, -1.0)]),
            (np.concatenate([row_number, np.arange(r)]), np.concatenate([column[kept], m + bin_of_row])),
        ),
        shape=(r, m + s),
    )
    A: Matrix | None = None
    b: Array | None = None
    if problem.equalities:
        dense = np.zeros((len(problem.equalities), m + s))
        for k, equality in enumerate(problem.equalities):
            for a in np.flatnonzero(equality.row):
                dense[k, (equality.origin + a) * every + (equality.frame if every > 1 else 0)] = equality.row[a]
        A = sparse.csc_matrix(dense)
        b = np.array([equality.value for equality in problem.equalities])
    lower = np.concatenate([np.full(m, -problem.trust), np.zeros(s)])
    upper = np.concatenate([np.full(m, problem.trust), np.full(s, np.inf)])
    keep = np.ones(m + s, bool)
    fixed = PINNED * every
    keep[:fixed] = not problem.pinned[0]
    if problem.pinned[1]:
        keep[max(0, m - fixed) : m] = False
    if not keep.all():
        P, G = P[keep][:, keep], G[:, keep]
        A = A[:, keep] if A is not None else None
        q, lower, upper = q[keep], lower[keep], upper[keep]
    return Matrices(P.tocsc(), q, G.tocsc(), problem.bound, A, b, lower, upper)


def solve_programme(problem: QuadraticProgramme) -> Answer:
    """The minimiser, by PIQP's interior-point method."""
    m = len(problem.gradient)
    given = matrices(problem)
    solver = piqp.SparseSolver()
    solver.settings.eps_abs = TOLERANCE
    solver.settings.eps_rel = TOLERANCE
    solver.settings.max_iter = 100
    solver.setup(given.P, given.q, given.A, given.b, given.G, None, given.h, given.lower, given.upper)
    status = solver.solve()
    x = np.asarray(solver.result.x)
    fixed = PINNED * problem.every
    skipped = (fixed if problem.pinned[0] else 0, fixed if problem.pinned[1] else 0)
    free = m - sum(skipped)
    coefficients = np.zeros(m)
    coefficients[skipped[0] : m - skipped[1]] = x[:free]
    usable = bool(np.isfinite(x).all())
    return Answer(
        coefficients=coefficients if usable else np.zeros(m),
        slack=x[free:],
        multipliers=np.asarray(solver.result.z_u),
        solved=usable and status == piqp.PIQP_SOLVED,
        iterations=int(solver.result.info.iter),
    )
