"""The closed-form step against a solver that shares no code with it, PIQP."""

import numpy as np
import piqp
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fullpose._typing import Array
from fullpose.step import Programme, clamp, null_interval, quadratic_step
from tests.support.problems import Problem, random_problem


def step_of(problem: Problem) -> tuple[bool, Array]:
    """(whether it is feasible, the step) by `quadratic_step`, without tolerance."""
    J, n, manipulability, weight, g, e, lo, hi = problem
    x = np.empty(4)
    programme = Programme(J, n, manipulability, weight, np.zeros(4), g, e, lo, hi, np.zeros(4))
    return bool(quadratic_step(programme, x)), x


def reference_step(problem: Problem) -> tuple[str, Array]:
    """(status, step) of the quadratic programme by an interior-point method. Bounds of the step."""
    J, _, _, weight, g, e, lo, hi = problem
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-13
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = 1e-13
    solver.settings.max_iter = 500
    # In units of the step, so that the tolerances are relative to it.
    unit = max(float(np.abs(e).max()), 1e-12)
    solver.setup(np.diag(weight), -weight * g / unit, J, e / unit, None, None, None, lo / unit, hi / unit)
    status = solver.solve()
    return status.name, np.asarray(solver.result.x) * unit


@settings(max_examples=300)
@given(seed=st.integers(0, 2**32 - 1), width=st.sampled_from([0.5, 1.0, 2.0, 4.0, 100.0]))
def test_the_step_is_the_programmes_solution(seed: int, width: float) -> None:
    problem = random_problem(seed, width)
    assume(problem.manipulability > 0.05)
    feasible, x = step_of(problem)
    status, expected = reference_step(problem)
    J, e = problem.J, problem.e
    if feasible:
        assert status == "PIQP_SOLVED"
        np.testing.assert_allclose(x, expected, atol=1e-8)
        np.testing.assert_allclose(J @ x, e, atol=1e-15)
        assert np.all((x >= problem.lo - 1e-15) & (x <= problem.hi + 1e-15))
    else:
        # No point of the line is inside the box: the interior-point method says so too, or stops short of the digits.
        assert status != "PIQP_SOLVED" or np.abs(J @ expected - e).max() > 1e-13


def test_both_outcomes_are_met_by_the_problems_above() -> None:
    outcomes = [step_of(random_problem(seed, 1.0))[0] for seed in range(200)]
    assert 20 < sum(outcomes) < 180


def test_null_interval_and_clamp() -> None:
    n = np.array([0.5, -0.5, 0.0, np.sqrt(0.5)])
    y, tolerance = np.zeros(4), np.full(4, 1e-9)
    lo, hi = np.full(4, -1.0), np.full(4, 1.0)
    assert null_interval(y, n, lo, hi, tolerance) == pytest.approx((-np.sqrt(2.0), np.sqrt(2.0)))
    y[2] = 1.1  # the frame that the self-motion does not move
    z_min, z_max = null_interval(y, n, lo, hi, tolerance)
    assert z_min > z_max
    assert clamp(3.0, -1.0, 1.0) == 1.0
    assert clamp(0.0, 2.0, 1.0) == 1.5
    assert clamp(0.0, np.inf, -np.inf) == 0.0
