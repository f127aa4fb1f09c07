"""The solver of the quadratic programmes: PIQP, an interior-point method (docs/decisions/0005-planner.md).

PIQP writes to the terminal about a row whose bound is infinite, which is no constraint, and is left out here; numbers
that are not finite are not given to it.
"""

import numpy as np
import piqp

from fullpose.trajectory.qp import Matrices, Minimiser, Status

TOLERANCE = 1e-7
ITERATIONS = 100
UNBOUNDED = 1e30  # PIQP's infinity
STATUS = {
    piqp.PIQP_SOLVED: Status.SOLVED,
    piqp.PIQP_MAX_ITER_REACHED: Status.INEXACT,
    piqp.PIQP_NUMERICS: Status.INEXACT,
    piqp.PIQP_PRIMAL_INFEASIBLE: Status.INFEASIBLE,
    piqp.PIQP_DUAL_INFEASIBLE: Status.INFEASIBLE,
}  # others: FAILED


def solve_by_piqp(given: Matrices) -> Minimiser:
    """The minimiser, as a `qp.Solver` gives it."""
    if not all(np.isfinite(numbers).all() for numbers in given.numbers()):
        return Minimiser(np.zeros(len(given.q)), Status.FAILED)
    G, h = given.G, given.h
    bounded = h < UNBOUNDED
    if not bounded.all():
        G, h = G[bounded], h[bounded]
    solver = piqp.SparseSolver()
    solver.settings.eps_abs = TOLERANCE
    solver.settings.eps_rel = TOLERANCE
    solver.settings.max_iter = ITERATIONS
    solver.settings.verbose = False
    solver.setup(given.P, given.q, given.A, given.b, G, None, h, given.lower, given.upper)
    status = STATUS.get(solver.solve(), Status.FAILED)
    x = np.asarray(solver.result.x)
    duals = np.zeros(len(h) if bounded.all() else len(bounded))
    duals[bounded] = solver.result.z_u
    return Minimiser(x, status if np.isfinite(x).all() else Status.FAILED, duals)
