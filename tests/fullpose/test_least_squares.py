"""The least-squares kernels against SciPy, NumPy and the definition of the pseudo-inverse."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from fullpose.kinematics import jacobian, null_vector
from fullpose.least_squares import (
    DAMPED_BELOW,
    LeastSquares,
    box_least_squares,
    least_norm,
    solve_symmetric,
    squared_damping,
)
from tests.support.problems import RIGS, random_problem


@settings(max_examples=300)
@given(seed=st.integers(0, 2**32 - 1), width=st.sampled_from([0.1, 0.5, 1.0, 4.0]))
def test_box_least_squares(seed: int, width: float) -> None:
    J, _, _, _, g, e, lo, hi = random_problem(seed, width)
    damping = np.full(4, 1e-7)
    s = np.empty(4)
    binding = box_least_squares(LeastSquares(J, e, damping, g, lo, hi), s, np.empty((4, 5)))
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
    J, _, _, _, g, e, _, _ = random_problem(7, 1.0)
    free, damping = np.full(4, np.inf), np.full(4, 1e-9)
    s = np.empty(4)
    assert box_least_squares(LeastSquares(J, e, damping, g, -free, free), s, np.empty((4, 5))) == 0
    np.testing.assert_allclose(J @ s, e, atol=1e-10)
    nowhere = np.full(4, 2e-4)
    assert box_least_squares(LeastSquares(J, e, damping, g, nowhere, nowhere), s, np.empty((4, 5))) > 0
    np.testing.assert_array_equal(s, nowhere)


def test_least_norm_is_the_weighted_pseudo_inverse() -> None:
    for seed in range(50):
        J, _, manipulability, weight, g, e, _, _ = random_problem(seed, 1.0)
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
