"""Rows and models against finite differences, refinement against the limits."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import ACCELERATION, LOWER, POSITION, RATE, UPPER, Bound
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.bspline import spline_basis
from fullpose.trajectory.constraints import exceeded, largest_violation, lead_cuts, rig_limits, rows_within_reach
from fullpose.trajectory.cost import Cost, QuadraticModel, cost_bands, cost_of, path_cost
from fullpose.trajectory.curve import null_vectors
from fullpose.trajectory.linearisation import (
    JERK_ROW,
    POSITION_UNIT,
    ROW,
    Iterate,
    Reach,
    Rows,
    difference,
    displaced,
    fill_row,
    limit_rows,
)
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import Programme
from fullpose.trajectory.sqp import Boundary, discretised, refine
from fullpose.trajectory.windows import refine_path, smooth_curve, stage_samples
from fullpose.verify import differences, payload_attitudes, verify

DEG = np.pi / 180.0
RIG = builtin_rigs()["vertical-limited"]


@pytest.fixture(scope="module")
def flight():
    """(the problem, an exact smooth path that is not refined)"""
    t, q = random_flight(3, 4.0, 250.0, 110 * DEG)
    C = dcm_from_quaternion(q)
    samples = stage_samples(t, 0.05)
    node_path = Programme(t[samples], C[samples], RIG, lattice(RIG, DEG), PlanOptions()).run()
    return Problem(t, C, RIG), smooth_curve(Problem(t, C, RIG), samples, node_path)


@pytest.fixture(scope="module")
def at(flight):
    """The unrefined path and its null vectors."""
    problem, d = flight
    n = np.empty_like(d)
    null_vectors(False, d, n)
    return Iterate(problem.time, d, n)


@pytest.mark.parametrize("kind", [0, 1, 2, 3])
def test_rows_are_the_derivatives_of_the_differences(at, kind):
    t, d, n = at
    basis = spline_basis(t, 0.025)
    row = np.empty(JERK_ROW)
    random = np.random.default_rng(1)
    for k in random.integers(2, len(t) - 1, 25):
        for i in range(4):
            origin = fill_row(kind, int(k), i, at, basis, row)
            c = np.zeros(basis.size)
            one = min(origin + int(random.integers(0, 4)), basis.size - 1)
            c[one] = 1.0
            moved = np.empty_like(d)
            displaced(d, n, basis, c, moved)
            expected = difference(kind, int(k), i, t, moved) - difference(kind, int(k), i, t, d)
            assert row[one - origin] == pytest.approx(expected, rel=1e-6, abs=1e-7 if kind < 3 else 1e-4)


def test_over_limits_agrees_with_the_independent_check(flight):
    problem, d = flight
    t, limits = problem.time, rig_limits(RIG)
    violation, whose = exceeded(t, 3.0 * d, limits)
    peaks = verify(t, 3.0 * d, RIG).peaks
    assert violation[1:, 1].max() == pytest.approx((peaks[:, 1] / RIG.max_rate).max() - 1.0)
    assert violation[:, 2].max() == pytest.approx((peaks[:, 2] / RIG.max_acceleration).max() - 1.0)
    value, sample, frame, kind = largest_violation(t, 3.0 * d, limits)
    assert value == violation.max()
    assert violation[sample, kind] == value
    assert whose[sample, kind] == frame


def test_cost_bands_are_the_gradient_of_the_cost(at):
    t, d, n = at
    basis = spline_basis(t, 0.025)
    weights = Cost(np.ones(4), 0.01 * np.ones(4), home=np.zeros(4), homing=0.3, margin=0.05, rise=0.0)
    H, g = QuadraticModel(np.zeros((basis.size, ROW)), np.zeros(basis.size))
    cost_bands(at, basis, 1, weights, QuadraticModel(H, g))

    def cost(c):
        moved = np.empty_like(d)
        displaced(d, n, basis, c, moved)
        v = np.diff(moved, axis=0) / 0.004
        a = np.diff(v, axis=0) / 0.004
        dt = np.full(len(t), 0.004)
        dt[0] = 0.004
        dt[-1] = 1.0  # a sample has the time up to the next; the last has none, and counts for a second
        return 0.3 * (moved**2 * dt[:, None]).sum() + (v**2 * dt[1:, None]).sum() + 0.01 * (a**2 * dt[1:-1, None]).sum()

    zero = np.zeros(basis.size)
    for j in range(5, basis.size - 8, 17):
        c = zero.copy()
        c[j] = 1e-4
        slope = (cost(c) - cost(-c)) / 2e-4
        bend = (cost(c) - 2 * cost(zero) + cost(-c)) / 1e-8
        assert g[j] == pytest.approx(slope, rel=1e-5, abs=1e-6)
        assert H[j, 0] == pytest.approx(bend, rel=1e-3)


def test_refinement_brings_a_path_inside_exact_and_cheaper(flight):
    problem, d = flight
    most = verify(problem.time, d, RIG).peaks[:, 2]  # the path goes a quarter over 0.8 of what it asks for
    frames = tuple(replace(f, max_acceleration=0.8 * a) for f, a in zip(RIG.frames, most, strict=True))
    problem = replace(problem, rig=replace(RIG, frames=frames))
    t, C, rig = problem.time, problem.attitude, problem.rig
    cost, stride = cost_of(rig, problem.options), discretised(problem).stride
    assert largest_violation(t, d, rig_limits(rig)).share == pytest.approx(0.25)
    result = refine(problem, d, Boundary())
    assert result.violation.share <= 0.0
    assert path_cost(t, result.angles, cost, stride) < 0.8 * path_cost(t, d, cost, stride)
    found = verify(t, result.angles, rig, C)
    assert found.violations == ()
    assert found.max_matrix_error < 5e-15


def test_windows_join_without_a_corner(flight):
    problem, d = flight
    whole = refine_path(problem, d.copy())
    parts = refine_path(replace(problem, options=PlanOptions(window=1.2, overlap=0.4)), d.copy())
    assert np.abs(parts.angles - whole.angles).max() > 1e-3  # they are not the same
    for path in (whole, parts):
        assert path.failures == ()
        assert verify(problem.time, path.angles, RIG, problem.attitude).violations == ()
    assert np.abs(payload_attitudes(RIG, parts.angles) - problem.attitude).max() < 5e-15


def test_pinned_ends_stay(flight):
    problem, d = flight
    result = refine(problem, d, Boundary(pinned=(True, True)))
    assert np.abs(result.angles[[0, -1]] - d[[0, -1]]).max() < 1e-12
    assert np.abs(result.angles - d).max() > 1e-3  # what is between them moved
    free = refine(problem, d, Boundary())
    assert np.abs(free.angles[[0, -1]] - d[[0, -1]]).max() > 1e-6  # and they would have, too


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
        cuts = lead_cuts(Iterate(t, d, n), spline_basis(t, 0.025), rig_limits(RIG), (not at_end, at_end))
        assert (min(cut.value for cut in cuts) < 0.0) == broken


def test_limit_rows_count_what_does_not_fit_and_name_their_bounds(at):
    t, d, n = at
    basis, limits = spline_basis(t, 0.025), rig_limits(RIG)
    reach = Reach(2, np.zeros((len(t), 3), np.uint8), 0.3, 0.0)

    def rows(room):
        out = Rows(np.empty(room, np.int64), np.empty((room, ROW)), np.empty(room), np.empty((room, 3), np.int64))
        return limit_rows(at, basis, limits, reach, out), out

    count, _ = rows(1)
    assert count > 100
    again, out = rows(count)
    assert again == count
    assert len(rows_within_reach(at, basis, limits, reach).origin) == count
    # At the bound that a row names, the path displaced by a step is as far from it as the row says.
    c = 1e-4 * np.random.default_rng(3).normal(size=basis.size + ROW)  # rows at the end reach beyond the last
    moved = np.empty_like(d)
    displaced(d, n, basis, c, moved)
    rate, acceleration = differences(t, moved)
    bound = Bound(*out.bound.T)
    assert set(bound.limit) == {POSITION, RATE, ACCELERATION}
    assert set(bound.side) == {LOWER, UPPER}
    left = {
        (POSITION, UPPER): (limits.high - moved) / POSITION_UNIT,
        (POSITION, LOWER): (moved - limits.low) / POSITION_UNIT,
        (RATE, UPPER): 1.0 - rate / limits.rate,
        (RATE, LOWER): 1.0 + rate / limits.rate,
        (ACCELERATION, UPPER): 1.0 - acceleration / limits.acceleration,
        (ACCELERATION, LOWER): 1.0 + acceleration / limits.acceleration,
    }
    for r in range(0, count, 37):
        said = out.room[r] - out.rows[r] @ c[out.origin[r] : out.origin[r] + ROW]
        place = left[bound.limit[r], bound.side[r]][:, bound.frame[r]]
        assert np.abs(place - said).min() < 1e-9
