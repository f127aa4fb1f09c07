"""The penalised spline against dense least squares on SciPy's B-splines."""

import numpy as np
import pytest
from scipy.integrate import quad_vec
from scipy.interpolate import BSpline
from scipy.optimize import minimize

from fullpose._typing import Array
from fullpose.recorded.banded_cholesky import solve_banded
from fullpose.recorded.smoothing_spline import (
    cut_off_spline,
    freedom,
    gauss_points,
    roughness,
    spline,
    spline_at,
    uniform_knots,
)
from fullpose.recorded.spline_kernels import DEGREE, Knots, Tube
from fullpose.recorded.tube_curve import Programme, nearest_in_tube, projected
from tests.support.recorded import grid, noisy, quaternion, truth


def dense_roughness(knots: Knots) -> Array:
    """(size, size), integrated by SciPy piece by piece."""
    size = knots.pieces + DEGREE
    third = spline(knots, np.eye(size)).derivative(3)
    total = np.zeros((size, size))
    for piece in range(knots.pieces):
        low = knots.begin + piece * knots.interval
        total += quad_vec(lambda t: np.outer(third(t), third(t)), low, low + knots.interval, epsrel=1e-10)[0]
    return total


def dense(bands: Array) -> Array:
    width, n = bands.shape
    full = np.zeros((n, n))
    for b in range(width):
        full += np.diag(bands[width - 1 - b, b:], b)
    return full + np.triu(full, 1).T


@pytest.mark.parametrize(("width", "n"), [(1, 5), (3, 3), (6, 40), (18, 90)])
def test_banded_systems(width: int, n: int) -> None:
    random = np.random.default_rng(n)
    bands = random.normal(size=(width, n))
    bands[-1] += 3.0 * width
    right = random.normal(size=(n, 3))
    expected = np.linalg.solve(dense(bands), right)
    found = right.copy()
    assert solve_banded(bands.copy(), found)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
    bands[-1] = -1.0
    assert not solve_banded(bands, right)


def test_the_spline_is_scipys() -> None:
    knots = uniform_knots(2.0, 3.0, 0.07)
    c = np.random.default_rng(0).normal(size=(knots.pieces + DEGREE, 2))
    time = np.linspace(2.0, 3.0, 101)
    np.testing.assert_allclose(spline_at(knots, c, time), spline(knots, c)(time), atol=1e-13)
    np.testing.assert_allclose(dense(roughness(knots)), dense_roughness(knots), rtol=1e-8, atol=1e-6)


@pytest.mark.parametrize("cut_off", [2.0, 10.0])
def test_least_squares_and_roughness(cut_off: float) -> None:
    time = np.sort(np.random.default_rng(3).uniform(0.0, 1.0, 120))
    q = quaternion(noisy(truth("tumble", time), 0.1))
    made = cut_off_spline(time, q, cut_off)
    B = BSpline.design_matrix(np.clip(time, time[0], time[-1] - 1e-12), spline(made.knots, made.coefficients).t, DEGREE)
    interval = (time[-1] - time[0]) / 119
    A = B.T @ B + (2.0 * np.pi * cut_off) ** -6 / interval * dense_roughness(made.knots)
    np.testing.assert_allclose(made.coefficients, np.linalg.solve(A, B.T @ q), rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("cut_off", [3.0, 10.0, 40.0])
def test_degrees_of_freedom(cut_off: float) -> None:
    """The formula against the trace of the smoother itself."""
    time = grid(200.0, 1.0)
    made = cut_off_spline(time, quaternion(truth("gentle", time)), cut_off)
    B = BSpline.design_matrix(time - 1e-12 * (time == 1.0), spline(made.knots, made.coefficients).t, DEGREE).toarray()
    A = B.T @ B + (2.0 * np.pi * cut_off) ** -6 / 0.005 * dense_roughness(made.knots)
    trace = np.trace(B @ np.linalg.solve(A, B.T))
    assert freedom(cut_off, 1.0, time.size) == pytest.approx(trace, rel=0.02, abs=0.3)


def test_rate_curvature() -> None:
    """Against differences of the rates of SciPy's rotations."""
    time = grid(1000.0, 1.0)
    made = cut_off_spline(time, quaternion(truth("tumble", time)), 20.0)
    h = 1e-4
    at = np.linspace(0.3, 0.6, 7)

    def rate(t: Array) -> Array:
        ahead, behind = made.at(t + 0.5 * h), made.at(t - 0.5 * h)
        w = ahead[:, :1] * -behind[:, 1:] + behind[:, :1] * ahead[:, 1:] - np.cross(ahead[:, 1:], behind[:, 1:])
        return np.asarray(2.0 * w / h)

    expected = (rate(at + 10 * h) - 2.0 * rate(at) + rate(at - 10 * h)) / (10 * h) ** 2
    np.testing.assert_allclose(made.rate_curvature(at), expected, rtol=1e-3, atol=1e-3 * np.abs(expected).max())


def test_the_curve_in_a_tube_is_the_least_one() -> None:
    """Against SciPy's interior point on the same quadratic cost and balls."""
    random = np.random.default_rng(5)
    knots = Knots(0.0, 0.1, 10)
    time = np.linspace(0.0, 1.0, 60)
    target = 0.8 * np.stack([np.sin(6.0 * time + k) for k in range(3)], axis=1) + 0.3 * random.normal(size=(60, 3))
    at, _ = gauss_points(knots)
    linear = projected(knots, np.sin(at.ravel()[:, None] + np.arange(3.0)))
    data = (np.arange(60) % 3 == 0).astype(float)
    given = Programme(knots, Tube(time, target, data, 1.0), linear, 1e-4, (False, False))
    found = nearest_in_tube(given)
    size = knots.pieces + DEGREE
    B = spline(knots, np.eye(size))(time)
    G = dense_roughness(knots)

    def cost(x: Array) -> float:
        c = x.reshape(size, 3)
        e = B @ c - target
        return float(0.5e-4 * np.sum(c * (G @ c)) + 1e-4 * np.sum(linear * c) + 0.5 * np.sum(data[:, None] * e**2))

    def slope(x: Array) -> Array:
        c = x.reshape(size, 3)
        return np.asarray(1e-4 * (G @ c + linear) + B.T @ (data[:, None] * (B @ c - target))).ravel()

    def inside(x: Array) -> Array:
        return np.asarray(1.0 - np.sum((B @ x.reshape(size, 3) - target) ** 2, axis=1))

    def inside_slope(x: Array) -> Array:
        e = B @ x.reshape(size, 3) - target
        return np.asarray(-2.0 * np.einsum("ka,ki->kai", B, e).reshape(60, -1))

    best = minimize(
        cost,
        found.ravel(),
        jac=slope,
        method="SLSQP",
        constraints={"type": "ineq", "fun": inside, "jac": inside_slope},
        options={"maxiter": 500, "ftol": 1e-12},
    )
    assert best.success
    assert inside(found.ravel()).min() > 0.0
    assert cost(found.ravel()) <= best.fun + 0.1
    assert cost(found.ravel()) <= best.fun + 0.02 * abs(best.fun)
