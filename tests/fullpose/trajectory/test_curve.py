"""Projection onto the solutions, null vectors, smoothing and splines, against SciPy and the kernels of kinematics."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from fullpose.kinematics import jacobian, null_vector
from fullpose.rig import builtin_rigs
from fullpose.trajectory.bspline import FEW, spline_basis
from fullpose.trajectory.curve import (
    closest,
    closest_all,
    hermite,
    null_vectors,
    polish,
    smoothed,
    spline_rows,
    spline_slopes,
)
from fullpose.verify import payload_attitudes

RIGS = [builtin_rigs()[name] for name in ("vertical-4", "horizontal-4")]


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.name)
def test_closest_is_exact_and_moves_across_the_curve_only(rig):
    random = np.random.default_rng(2)
    J, n = np.empty((3, 4)), np.empty(4)
    for _ in range(200):
        exact = random.uniform(-3, 3, 4)
        if np.sin(exact[1]) ** 2 + np.cos(exact[2]) ** 2 < 0.1:
            continue
        C = payload_attitudes(rig, exact[None])[0]
        d = exact + random.normal(0, 1e-4, 4)
        begin = d.copy()
        assert closest(rig.axes, C, d) < 1e-14
        assert np.abs(payload_attitudes(rig, d[None])[0] - C).max() < 5e-15
        jacobian(rig.axes, d, J)
        null_vector(J, n)
        assert abs(n @ (d - begin)) < 1e-5 * np.abs(d - begin).max() + 1e-7


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.name)
def test_closest_goes_through_the_singularity_when_nothing_is_asked_of_it(rig):
    roll = np.linspace(-0.1, 0.1, 401)  # outer and inner turn as one where the middle frame is at 90 deg
    d = np.zeros((401, 4))
    d[:, 1], d[:, 2] = roll, 0.5 * np.pi
    C = payload_attitudes(rig, d)
    moved = d + np.array([0.0, 1e-6, 0.0, 0.0])
    assert closest_all(rig.axes, rig.geometry.horizontal, C, moved) == 0
    polish(rig.geometry.horizontal, C, moved)
    assert np.abs(payload_attitudes(rig, moved) - C).max() < 5e-15
    assert np.abs(np.diff(moved, 2, axis=0)).max() < 1e-8


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.name)
def test_null_vectors_are_those_of_the_jacobian_and_go_on_through_the_singularity(rig):
    random = np.random.default_rng(3)
    J, one = np.empty((3, 4)), np.empty(4)
    d = random.uniform(-3, 3, (300, 4))
    n = np.empty_like(d)
    null_vectors(rig.geometry.horizontal, d, n)
    for k in range(300):
        jacobian(rig.axes, d[k], J)
        null_vector(J, one)
        assert abs(abs(one @ n[k]) - 1.0) < 1e-12
    through = np.zeros((101, 4))
    through[:, 1], through[:, 2] = np.linspace(-0.1, 0.1, 101), 0.5 * np.pi
    along = np.empty_like(through)
    null_vectors(rig.geometry.horizontal, through, along)
    assert (np.sum(along[1:] * along[:-1], axis=1) > 0.99).all()


def test_spline_is_the_natural_cubic_one():
    random = np.random.default_rng(4)
    knots = np.cumsum(random.uniform(0.5, 1.5, 12))
    y = random.normal(size=(12, 4))
    at = np.linspace(knots[0], knots[-1], 500)
    out = np.empty((500, 4))
    spline_rows(knots, y, spline_slopes(knots, y), at, out)
    assert np.abs(out - CubicSpline(knots, y, bc_type="natural")(at)).max() < 1e-12


def test_smoothing_keeps_straight_lines_and_takes_the_steps_out_of_a_grid():
    ramp = np.outer(np.arange(40.0), [1.0, -2.0, 0.5, 0.0])
    assert np.abs(smoothed(ramp, 5.0) - ramp).max() < 1e-10
    steps = np.rint(ramp * 0.3)
    assert np.abs(np.diff(smoothed(steps, 5.0), 2, axis=0)).max() < 0.35 * np.abs(np.diff(steps, 2, axis=0)).max()


@pytest.mark.parametrize("n", [2, 5, FEW - 1, FEW, 50, 401])
def test_basis_is_a_partition_of_unity_and_shares_functions_from_sample_to_sample(n):
    time = np.arange(n) * 0.005
    basis = spline_basis(time, 0.025)
    assert np.abs(basis.values.sum(axis=1) - 1.0).max() < 1e-12
    assert (np.diff(basis.first) >= 0).all()
    assert (np.diff(basis.first) <= 1).all()
    assert basis.first[-1] + 4 <= basis.size


def test_hermite_and_its_derivatives_against_scipy():
    random = np.random.default_rng(6)
    for _ in range(20):
        (y0, y1, v0, v1), h = random.normal(size=4), random.uniform(0.1, 2.0)
        spline = CubicHermiteSpline([0.0, h], [y0, y1], [v0, v1])
        for s in (0.0, 0.3, 1.0):
            off_chord, first, second = hermite(y1 - y0, v0, v1, h, s)
            assert y0 + s * (y1 - y0) + off_chord == pytest.approx(spline(s * h), abs=1e-12)
            assert first == pytest.approx(spline(s * h, 1), abs=1e-11)
            assert second == pytest.approx(spline(s * h, 2), abs=1e-10)
