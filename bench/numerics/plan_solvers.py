"""The quadratic programmes of the refinement, by every maintained solver: python -m bench.numerics.plan_solvers

The programmes are collected from the first iterations of planning random flights; each is solved from nothing, set-up
included, to the same tolerance, and its answer's violation and cost are compared with the most exact one's.
OSQP, Clarabel and ProxQP are for this bench only: pip install osqp clarabel proxsuite.
"""

import time as clock
from collections.abc import Callable
from typing import Any

import clarabel
import numpy as np
import osqp
import piqp
import proxsuite
from scipy import sparse

from bench.machine import machine
from fullpose.attitude import dcm_from_quaternion
from fullpose.plan.plan import plan_problem
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.interior_point import TOLERANCE, solve_by_piqp
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrices, Minimiser

FLIGHTS = ((3, 60.0), (7, 120.0), (0, 120.0), (6, 120.0))


def collect() -> list[Matrices]:
    """The programmes of planning the flights, 10 s at 1 kHz each."""
    found: list[Matrices] = []

    def keep(given: Matrices) -> Minimiser:
        found.append(given)
        return solve_by_piqp(given)

    for seed, rate in FLIGHTS:
        t, q = random_flight(seed, 10.0, 1000.0, np.radians(rate))
        plan_problem(Problem(t, dcm_from_quaternion(q), builtin_rigs()["vertical-limited"], solver=keep))
    return found


def with_piqp(p: Matrices) -> Any:
    """PIQP 0.7, sparse."""
    solver = piqp.SparseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = TOLERANCE
    solver.setup(p.P, p.q, None, None, p.G, None, p.h, p.lower, p.upper)
    solver.solve()
    return solver.result.x


def stacked(p: Matrices) -> tuple[Any, Any, Any]:
    """(rows, lower, upper) with the bounds as rows."""
    rows = sparse.vstack([p.G, sparse.identity(len(p.q))], format="csc")
    return rows, np.r_[np.full(len(p.h), -np.inf), p.lower], np.r_[p.h, p.upper]


def with_osqp(p: Matrices) -> Any:
    """OSQP 1.1, polishing on."""
    A, low, high = stacked(p)
    solver = osqp.OSQP()
    solver.setup(
        sparse.triu(p.P, format="csc"), p.q, A, low, high, eps_abs=TOLERANCE, eps_rel=TOLERANCE, max_iter=40000,
        polishing=True, verbose=False,
    )  # fmt: skip
    return solver.solve(raise_error=False).x


def with_clarabel(p: Matrices) -> Any:
    """Clarabel 0.11."""
    finite = np.isfinite(p.upper)
    eye = sparse.identity(len(p.q), format="csc")
    A = sparse.vstack([p.G, eye[finite], -eye], format="csc")
    b = np.r_[p.h, p.upper[finite], -p.lower]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = TOLERANCE
    return np.array(
        clarabel.DefaultSolver(
            sparse.triu(p.P, format="csc"), p.q, A, b, [clarabel.NonnegativeConeT(len(b))], settings
        ).solve().x
    )  # fmt: skip


def with_proxqp(p: Matrices) -> Any:
    """ProxQP (proxsuite 0.8), sparse."""
    A, low, high = stacked(p)
    n = len(p.q)
    solver = proxsuite.proxqp.sparse.QP(n, 0, A.shape[0])
    solver.settings.eps_abs = TOLERANCE
    solver.settings.max_iter = 2000
    empty = sparse.csc_matrix((0, n))
    solver.init(p.P, p.q, empty, np.empty(0), A, np.maximum(low, -1e20), np.minimum(high, 1e20))
    solver.solve()
    return solver.results.x


SOLVERS: dict[str, Callable[[Matrices], Any]] = {
    "PIQP": with_piqp, "OSQP": with_osqp, "Clarabel": with_clarabel, "ProxQP": with_proxqp,
}  # fmt: skip


def main() -> None:
    """Print the table."""
    problems = collect()
    sizes = [(len(p.q), len(p.h)) for p in problems]
    print(machine())
    print(f"{len(problems)} programmes, {min(s[0] for s in sizes)}..{max(s[0] for s in sizes)} unknowns, "
          f"{min(s[1] for s in sizes)}..{max(s[1] for s in sizes)} rows")  # fmt: skip
    exact = [with_clarabel(p) for p in problems]
    print(f"{'solver':10} {'median ms':>10} {'worst ms':>10} {'worst violation':>16} {'worst extra cost':>17}")
    for name, run in SOLVERS.items():
        times, violations, extra = [], [], []
        for p, best in zip(problems, exact, strict=True):
            begin = clock.perf_counter()
            x = run(p)
            times.append(clock.perf_counter() - begin)
            x = np.full(len(p.q), np.nan) if x is None else np.asarray(x, float)

            def cost(x: Any, p: Matrices = p) -> float:
                return float(0.5 * x @ (p.P @ x) + p.q @ x)

            violations.append(max(0.0, (p.G @ x - p.h).max(), (p.lower - x).max(), (x - p.upper).max()))
            extra.append((cost(x) - cost(best)) / (1.0 + abs(cost(best))))
        typical, worst = 1e3 * np.median(times), 1e3 * max(times)
        print(f"{name:10} {typical:10.1f} {worst:10.1f} {max(violations):16.1e} {max(extra):17.1e}")


if __name__ == "__main__":
    main()
