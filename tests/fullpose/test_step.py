"""The closed-form step against solvers that share no code with it: PIQP for the programme, SciPy for least squares."""

import numpy as np
import piqp
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from fullpose._typing import Array
from fullpose.kinematics import jacobian, null_vector
from fullpose.rig import builtin_rigs
from fullpose.step import (
    DAMPED_BELOW,
    box_least_squares,
    clamp,
    least_norm,
    null_interval,
    quadratic_step,
    solve_symmetric,
    squared_damping,
)

RIGS = builtin_rigs()
SEED = st.integers(0, 2**32 - 1)


def reference_step(J: Array, weight: Array, g: Array, e: Array, lo: Array, hi: Array) -> tuple[str, Array]:
    """(status, step) of the quadratic programme by an interior-point method. Bounds of the step."""
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-13
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = 1e-13
    solver.settings.max_iter = 500
    # In units of the step, so that the tolerances are relative to it.
    unit = max(float(np.abs(e).max()), 1e-12)
    solver.setup(np.diag(weight), -weight * g / unit, J, e / unit, None, None, None, lo / unit, hi / unit)
    status = solver.solve()
    return status.name, np.asarray(solver.result.x) * unit


def problem(seed: int, width: float) -> tuple[Array, Array, float, Array, Array, Array, Array, Array]:
    """J, n, manipulability, weight, g, e, lo, hi of a random pose; the box is `width` times the increment."""
    random = np.random.default_rng(seed)
    rig = RIGS[("vertical-4", "horizontal-4")[seed % 2]]
    d = random.uniform(-np.pi, np.pi, 4)
    J, n = np.empty((3, 4)), np.empty(4)
    jacobian(rig.axes, d, J)
    manipulability = null_vector(J, n)
    e = random.normal(size=3) * 1e-3
    middle = random.normal(size=4) * 3e-4
    half = width * 1e-3 * random.uniform(0.2, 1.0, 4)
    weight = np.exp(random.normal(size=4))
    return J, n, manipulability, weight, random.normal(size=4) * 2e-4, e, middle - half, middle + half


@settings(max_examples=300)
@given(seed=SEED, width=st.sampled_from([0.5, 1.0, 2.0, 4.0, 100.0]))
def test_the_step_is_the_programmes_solution(seed: int, width: float) -> None:
    J, n, manipulability, weight, g, e, lo, hi = problem(seed, width)
    assume(manipulability > 0.05)
    x = np.empty(4)
    feasible = quadratic_step(J, n, manipulability, weight, np.zeros(4), g, e, lo, hi, np.zeros(4), x)
    status, expected = reference_step(J, weight, g, e, lo, hi)
    if feasible:
        assert status == "PIQP_SOLVED"
        np.testing.assert_allclose(x, expected, atol=1e-8)
        np.testing.assert_allclose(J @ x, e, atol=1e-15)
        assert np.all((x >= lo - 1e-15) & (x <= hi + 1e-15))
    else:
        # No point of the line is inside the box: the interior-point method says so too, or stops short of the digits.
        assert status != "PIQP_SOLVED" or np.abs(J @ expected - e).max() > 1e-13


def test_both_outcomes_are_met_by_the_problems_above() -> None:
    outcomes = []
    for seed in range(200):
        J, n, manipulability, weight, g, e, lo, hi = problem(seed, 1.0)
        outcomes.append(
            quadratic_step(J, n, manipulability, weight, np.zeros(4), g, e, lo, hi, np.zeros(4), np.empty(4))
        )
    assert 20 < sum(outcomes) < 180


@settings(max_examples=300)
@given(seed=SEED, width=st.sampled_from([0.1, 0.5, 1.0, 4.0]))
def test_box_least_squares(seed: int, width: float) -> None:
    J, _, _, _, g, e, lo, hi = problem(seed, width)
    damping = np.full(4, 1e-7)
    s = np.empty(4)
    binding = box_least_squares(J, e, damping, g, lo, hi, s, np.empty((4, 5)))
    rows = np.vstack([J, np.diag(np.sqrt(damping))])
    target = np.concatenate([e, np.sqrt(damping) * g])
    expected = lsq_linear(rows, target, bounds=(lo, hi), method="bvls", tol=1e-15)
    np.testing.assert_allclose(s, expected.x, atol=1e-8)
    assert np.all((s >= lo) & (s <= hi))
    if binding:
        frame, upper = divmod(binding - 1, 2)
        assert s[frame] == (hi if upper else lo)[frame]
    else:
        assert np.abs(J @ s - e).max() < 1e-6


def test_box_least_squares_without_bounds_and_with_no_room() -> None:
    J, _, _, _, g, e, _, _ = problem(7, 1.0)
    free = np.full(4, np.inf)
    s = np.empty(4)
    assert box_least_squares(J, e, np.full(4, 1e-9), g, -free, free, s, np.empty((4, 5))) == 0
    np.testing.assert_allclose(J @ s, e, atol=1e-10)
    nowhere = np.full(4, 2e-4)
    assert box_least_squares(J, e, np.full(4, 1e-9), g, nowhere, nowhere, s, np.empty((4, 5))) > 0
    np.testing.assert_array_equal(s, nowhere)


def test_least_norm_is_the_weighted_pseudo_inverse() -> None:
    for seed in range(50):
        J, _, manipulability, weight, g, e, _, _ = problem(seed, 1.0)
        if manipulability < 0.01:
            continue
        p = np.empty(4)
        least_norm(J, weight, g, e, 0.0, p)
        inverse = np.diag(1.0 / weight) @ J.T @ np.linalg.inv(J @ np.diag(1.0 / weight) @ J.T)
        np.testing.assert_allclose(p, g + inverse @ (e - J @ g), rtol=1e-8, atol=1e-15)


def test_damping_only_next_to_the_singularity() -> None:
    assert squared_damping(DAMPED_BELOW) == 0.0
    assert squared_damping(2.0) == 0.0
    assert 0.0 < squared_damping(0.5 * DAMPED_BELOW) < squared_damping(0.0)
    J = np.empty((3, 4))
    jacobian(RIGS["vertical-4"].axes, np.array([0.3, 0.0, np.pi / 2, 0.1]), J)
    p = np.empty(4)
    least_norm(
        J, np.ones(4), np.zeros(4), np.array([1e-3, 2e-3, -1e-3]), squared_damping(null_vector(J, np.empty(4))), p
    )
    assert np.isfinite(p).all()
    assert np.abs(p).max() < 1.0


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_cholesky(size: int) -> None:
    random = np.random.default_rng(size)
    A = random.normal(size=(size, size))
    A = A @ A.T + 0.1 * np.eye(size)
    b = random.normal(size=size)
    x = b.copy()
    assert solve_symmetric(A.copy(), x, size)
    np.testing.assert_allclose(x, np.linalg.solve(A, b), rtol=1e-10)
    assert not solve_symmetric(-A, b.copy(), size)


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
