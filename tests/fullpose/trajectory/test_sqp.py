"""Rows against finite differences, the quadratic programme against SciPy, refinement against the limits."""

import numpy as np
import pytest
from scipy.optimize import minimize

from fullpose.attitude import dcm_from_quaternion
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.bspline import spline_basis
from fullpose.trajectory.constraints import rig_limits
from fullpose.trajectory.curve import null_vectors
from fullpose.trajectory.linearisation import (
    ROW,
    cost_bands,
    difference,
    displaced,
    error_bands,
    fill_row,
    limit_rows,
    over_limits,
)
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.qp import QuadraticProgramme, matrices, solve_programme
from fullpose.trajectory.shortest_path import Programme
from fullpose.trajectory.sqp import lead_cuts, refine, worst
from fullpose.trajectory.windows import refine_path, smooth_curve, stage_samples
from fullpose.verify import payload_attitudes, verify

DEG = np.pi / 180.0
RIG = builtin_rigs()["vertical-limited"]


@pytest.fixture(scope="module")
def flight():
    """(time, attitude, an exact smooth path that is not refined)"""
    t, q = random_flight(3, 4.0, 250.0, 110 * DEG)
    C = dcm_from_quaternion(q)
    samples = stage_samples(t, 0.05)
    node_path = Programme(t[samples], C[samples], RIG, lattice(RIG, DEG), PlanOptions()).run()
    return t, C, smooth_curve(t, C, RIG, samples, node_path, None)


@pytest.mark.parametrize("kind", [0, 1, 2])
def test_rows_are_the_derivatives_of_the_differences(flight, kind):
    t, _, d = flight
    n = np.empty_like(d)
    null_vectors(False, d, n)
    basis = spline_basis(t, 0.025)
    row = np.empty(ROW)
    random = np.random.default_rng(1)
    for k in random.integers(1, len(t) - 1, 25):
        for i in range(4):
            origin = fill_row(kind, int(k), i, t, n, basis.first, basis.values, row)
            c = np.zeros(basis.size)
            at = min(origin + int(random.integers(0, 4)), basis.size - 1)
            c[at] = 1.0
            moved = np.empty_like(d)
            displaced(d, n, basis.first, basis.values, c, moved)
            expected = difference(kind, int(k), i, t, moved) - difference(kind, int(k), i, t, d)
            assert row[at - origin] == pytest.approx(expected, rel=1e-6, abs=1e-7)


def test_over_limits_agrees_with_the_independent_check(flight):
    t, _, d = flight
    over, whose = np.empty((len(t), 3)), np.empty((len(t), 3), np.int8)
    limits = rig_limits(RIG)
    over_limits(t, 3.0 * d, limits.low, limits.high, limits.rate, limits.acceleration, over, whose)
    peaks = verify(t, 3.0 * d, RIG).peaks
    assert over[1:, 1].max() == pytest.approx((peaks[:, 1] / RIG.max_rate).max() - 1.0)
    assert over[:, 2].max() == pytest.approx((peaks[:, 2] / RIG.max_acceleration).max() - 1.0)
    value, sample, frame, kind = worst(t, 3.0 * d, limits)
    assert value == over.max()
    assert over[sample, kind] == value
    assert whose[sample, kind] == frame


def test_cost_bands_are_the_gradient_of_the_cost(flight):
    t, _, d = flight
    n = np.empty_like(d)
    null_vectors(False, d, n)
    basis = spline_basis(t, 0.025)
    weights = np.ones(4), 0.01 * np.ones(4)
    H, g = np.zeros((basis.size, ROW)), np.zeros(basis.size)
    cost_bands(t, d, n, basis.first, basis.values, 1, *weights, np.zeros(4), 0.3, 0.05, 0.0, H, g)

    def cost(c):
        moved = np.empty_like(d)
        displaced(d, n, basis.first, basis.values, c, moved)
        v = np.diff(moved, axis=0) / 0.004
        a = np.diff(v, axis=0) / 0.004
        dt = np.full(len(t), 0.004)
        dt[0] = 0.004
        dt[-1] = 1.0  # a sample has the time up to the next; the last has none, and counts for a second
        return 0.3 * (moved**2 * dt[:, None]).sum() + (v**2 * dt[1:, None]).sum() + 0.01 * (a**2 * dt[1:-1, None]).sum()

    zero = np.zeros(basis.size)
    for at in range(5, basis.size - 8, 17):
        c = zero.copy()
        c[at] = 1e-4
        slope = (cost(c) - cost(-c)) / 2e-4
        bend = (cost(c) - 2 * cost(zero) + cost(-c)) / 1e-8
        assert g[at] == pytest.approx(slope, rel=1e-5, abs=1e-6)
        assert H[at, 0] == pytest.approx(bend, rel=1e-3)


def test_error_bands_are_the_gradient_of_the_attitude_error(flight):
    t, C, d = flight
    random = np.random.default_rng(2)
    basis = spline_basis(t, 0.05)
    x = d + 0.05 * np.sin(np.outer(t, random.uniform(1, 3, 4)))
    nothing = np.zeros(4)

    def total(x):
        H, g = np.zeros((4 * basis.size, 4 * ROW)), np.zeros(4 * basis.size)
        return error_bands(RIG.axes, t, C, x, basis.first, basis.values, 1, 1.0, nothing, nothing, H, g), g

    _, g = total(x)
    for at in range(9, 4 * basis.size - 30, 41):
        frame = at % 4
        bump = np.zeros(basis.size)
        bump[at // 4] = 1e-5
        step = np.zeros_like(x)
        displaced(np.zeros_like(x), np.tile(np.eye(4)[frame], (len(t), 1)), basis.first, basis.values, bump, step)
        slope = (total(x + step)[0] - total(x - step)[0]) / 2e-5
        assert g[at] == pytest.approx(slope, rel=2e-2, abs=1e-6)  # the model leaves the error's own curvature out


def test_programme_agrees_with_scipy():
    random = np.random.default_rng(5)
    basis = spline_basis(np.arange(40) * 0.01, 0.05)
    m = basis.size
    bands = np.zeros((m, ROW))
    bands[:, 0], bands[:, 1] = 4.0, 1.0
    origin = random.integers(0, m - ROW, 12)
    rows = random.normal(size=(12, ROW))
    problem = QuadraticProgramme(
        bands, random.normal(size=m), origin, rows, np.full(12, 0.3), np.zeros(12, np.int64), origin, 0.5, (True, False)
    )
    answer = solve_programme(problem)
    assert answer.solved
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


def test_refinement_is_exact_inside_and_cheaper(flight):
    t, C, d = flight
    result = refine(t, C, d, RIG, PlanOptions())
    assert result.over <= 0.0
    found = verify(t, result.angles, RIG, C)
    assert found.violations == ()
    assert found.max_matrix_error < 5e-15


def test_windows_join_without_a_corner(flight):
    t, C, d = flight
    whole = refine_path(t, C, d.copy(), RIG, PlanOptions())
    parts = refine_path(t, C, d.copy(), RIG, PlanOptions(window=1.2, overlap=0.4))
    for path in (whole, parts):
        assert path.failures == ()
        assert verify(t, path.angles, RIG, C).violations == ()
    assert np.abs(payload_attitudes(RIG, parts.angles) - C).max() < 5e-15


def test_pinned_ends_stay(flight):
    t, C, d = flight
    result = refine(t, C, d, RIG, PlanOptions(), pinned=(True, True))
    assert np.abs(result.angles[[0, -1]] - d[[0, -1]]).max() < 1e-12


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("at_end", [False, True])
def test_lead_cuts_are_broken_only_where_there_is_no_way_to_brake(side, at_end):
    t = np.arange(200) * 0.002
    rate, stop = 200 * DEG, 60 * DEG
    braking = rate**2 / (2.0 * RIG.max_acceleration[3])
    for room, broken in ((0.5 * braking, True), (3.0 * braking, False)):
        d = np.tile([0.1, 0.5, 0.2, 0.0], (len(t), 1))
        along = side * rate * (t - t[-1]) if at_end else -side * rate * t
        d[:, 3] = along + side * (stop - room)  # toward the stop at the end, away from it at the beginning
        n = np.empty_like(d)
        null_vectors(False, d, n)
        cuts = lead_cuts(t, d, n, spline_basis(t, 0.025), rig_limits(RIG), (not at_end, at_end))
        assert (min(cut.value for cut in cuts) < 0.0) == broken


def test_limit_rows_counts_what_does_not_fit(flight):
    t, _, d = flight
    n = np.empty_like(d)
    null_vectors(False, d, n)
    basis = spline_basis(t, 0.025)
    limits = rig_limits(RIG)

    def rows(room):
        out = np.empty(room, np.int64), np.empty((room, ROW)), np.empty(room), np.empty(room, np.int64)
        count = limit_rows(
            t, d, n, basis.first, basis.values, 2, np.zeros((len(t), 3), np.uint8), 0.3, limits.low, limits.high,
            limits.rate, limits.acceleration, 0.0, *out,
        )  # fmt: skip
        return count, out

    count, _ = rows(1)
    assert count > 100
    again, (origin, values, bound, tag) = rows(count)
    assert again == count
    assert (tag[1:] // 12 >= tag[:-1] // 12).all()
    assert np.isfinite(values).all()
    assert np.isfinite(bound).all()
    assert origin.max() < basis.size
