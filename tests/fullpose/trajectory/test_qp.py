"""The quadratic programme against SciPy; a solver's status is read, and it writes to no terminal."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import piqp
import pytest
from scipy import sparse
from scipy.optimize import minimize

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan.plan import plan_problem
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.bspline import spline_basis
from fullpose.trajectory.cost import QuadraticModel
from fullpose.trajectory.interior_point import solve_by_piqp
from fullpose.trajectory.linearisation import ROW
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrices, Minimiser, QuadraticProgramme, Status, matrices, solve_programme
from fullpose.verify import verify


def programme() -> QuadraticProgramme:
    """A small one whose rows bind."""
    random = np.random.default_rng(5)
    m = spline_basis(np.arange(40) * 0.01, 0.05).size
    bands = np.zeros((m, ROW))
    bands[:, 0], bands[:, 1] = 4.0, 1.0
    origin = random.integers(0, m - ROW, 12)
    rows = random.normal(size=(12, ROW))
    return QuadraticProgramme(
        QuadraticModel(bands, random.normal(size=m)), origin, rows, np.full(12, 0.3), origin, 0.5, (True, False),
        np.zeros(12, np.int64),
    )  # fmt: skip


def test_programme_agrees_with_scipy() -> None:
    problem = programme()
    answer = solve_programme(problem, solve_by_piqp)
    assert answer.status is Status.SOLVED
    assert (answer.coefficients[:3] == 0.0).all()
    given = matrices(problem)
    P, q, G, h = given.P, given.q, given.G, given.h
    expected = minimize(
        lambda x: 0.5 * x @ (P @ x) + q @ x, np.zeros(len(q)), jac=lambda x: P @ x + q, method="SLSQP",
        bounds=[(a, b if np.isfinite(b) else None) for a, b in zip(given.lower, given.upper, strict=True)],
        constraints={"type": "ineq", "fun": lambda x: h - G @ x, "jac": lambda _: -G.toarray()},
        options={"ftol": 1e-12},
    )  # fmt: skip
    x = np.r_[answer.coefficients[3:], answer.slack]
    assert 0.5 * x @ (P @ x) + q @ x == pytest.approx(expected.fun, abs=1e-5)
    assert np.abs(x - expected.x).max() < 1e-3


def small(**changes: object) -> Matrices:
    """min 1/2 |x|^2 + x_0 + x_1 in a box; what is changed makes the solver fail in one way or another."""
    eye = sparse.csc_matrix(np.eye(2))
    low, high = np.full(2, -1.0), np.full(2, 1.0)
    return replace(Matrices(eye, np.ones(2), eye, np.full(2, 0.5), None, None, low, high), **changes)  # type: ignore[arg-type]


CONTRADICTION = {"A": sparse.csc_matrix(np.ones((2, 2))), "b": np.array([1.0, -1.0])}


@pytest.mark.parametrize(
    ("given", "status"),
    [
        (small(), Status.SOLVED),
        (small(h=np.array([0.5, np.inf])), Status.SOLVED),  # about this row PIQP itself writes to the terminal
        (small(**CONTRADICTION), Status.INFEASIBLE),
        (small(q=np.array([np.nan, 1.0])), Status.FAILED),
        (small(b=np.array([np.inf]), A=sparse.csc_matrix(np.ones((1, 2)))), Status.FAILED),
    ],
)
def test_the_status_is_read_and_nothing_reaches_a_terminal(
    given: Matrices, status: Status, capfd: pytest.CaptureFixture[str]
) -> None:
    assert solve_by_piqp(given).status is status
    assert capfd.readouterr() == ("", "")


def test_piqp_itself_does_write_to_the_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    """Else the test above could not fail."""
    given = small(h=np.array([0.5, np.inf]))
    solver = piqp.SparseSolver()
    solver.setup(given.P, given.q, None, None, given.G, None, given.h, given.lower, given.upper)
    assert "".join(capfd.readouterr())


def test_an_answer_that_is_none_is_no_step() -> None:
    def fails(given: Matrices) -> Minimiser:
        return Minimiser(np.full(len(given.q), np.nan), Status.FAILED)

    answer = solve_programme(programme(), fails)
    assert answer.status is Status.FAILED
    assert not answer.coefficients.any()


def counted(status: Status) -> tuple[list[Matrices], Callable[[Matrices], Minimiser]]:
    """(what it was given, a solver that moves nothing and ends so)."""
    given: list[Matrices] = []

    def solve(matrices: Matrices) -> Minimiser:
        given.append(matrices)
        return Minimiser(np.zeros(len(matrices.q)), status)

    return given, solve


@pytest.mark.parametrize("rate", [60.0, 230.0])
def test_a_plan_takes_the_solver_it_is_given_and_keeps_the_limits_where_that_fails(rate: float) -> None:
    t, q = random_flight(0, 3.0, 250.0, np.radians(rate))
    given, solver = counted(Status.FAILED)
    problem = Problem(t, dcm_from_quaternion(q), builtin_rigs()["vertical-limited"], solver=solver)
    made = plan_problem(problem)
    assert given
    assert verify(t, made.solution.angles, problem.rig).violations == ()
