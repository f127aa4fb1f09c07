"""The dynamic programme against an exhaustive search that shares nothing with it but the nodes."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import ACCELERATION, POSITION, RATE
from fullpose.plan.node_paths import Query, cheapest
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.shortest_path import PLAIN, Programme, Terms, reference_rates
from fullpose.verify import payload_attitudes

DEG = np.pi / 180.0
LIMITED = builtin_rigs()["vertical-limited"]
TURN = 2.0 * np.pi


def programme(rig, seed=3, stages=8, grid=12.0, rate=60.0, interval=0.1, terms=PLAIN, **changes):
    t, q = random_flight(seed, interval * (stages - 1), 1.0 / interval, rate * DEG)
    options = replace(PlanOptions(), **changes)
    return Programme(t, dcm_from_quaternion(q), rig, lattice(rig, grid * DEG), options, terms)


def brute_force(p):
    """The least cost by dense matrices over all pairs of nodes, inf where there is no node path."""
    position, cost, alive = p.nodes(0)
    best = np.where(alive, cost, np.inf)
    rates = reference_rates(p.rig)
    for k in range(1, len(p.time)):
        ahead, cost, alive = p.nodes(k)
        gap = ahead[None, :, :] - position[:, None, :]
        gap -= np.where(p.grid.wraps, TURN * np.rint(gap / TURN), 0.0)
        dt = p.time[k] - p.time[k - 1]
        allowed = (np.abs(gap) <= p.rig.max_rate * dt).all(axis=2)
        edges = (p.rig.weight * (gap / rates) ** 2).sum(axis=2) / dt
        total = best[:, None] + np.where(allowed, edges, np.inf)
        best = np.where(alive, total.min(axis=0) + cost, np.inf)
        position = ahead
    return best.min()


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("rate", [30.0, 90.0, 200.0])
@pytest.mark.parametrize("seed", range(4))
def test_same_cost_as_the_search_over_all_pairs(geometry, rate, seed):
    frames = tuple(FrameLimits(-s * DEG, s * DEG, r * DEG) for s, r in ((170, 200), (170, 250), (100, 250), (60, 600)))
    p = programme(Rig("r", geometry, frames), seed=seed, rate=rate)
    expected = brute_force(p)
    node_path = p.run()
    assert node_path.found == np.isfinite(expected)
    if node_path.found:
        assert node_path.cost == pytest.approx(expected, rel=1e-12)


def test_a_node_path_is_exact_continuous_and_within_the_rates():
    p = programme(LIMITED, stages=100, grid=2.0, interval=0.05)
    node_path = p.run()
    assert node_path.found
    assert np.abs(payload_attitudes(LIMITED, node_path.angles) - p.attitude).max() < 2e-13
    assert (np.abs(np.diff(node_path.angles, axis=0)) <= LIMITED.max_rate * 0.05 * (1 + 1e-9)).all()
    assert (np.abs(node_path.angles[:, 3]) <= 60 * DEG).all()


def test_pointers_computed_again_give_the_same_node_path(monkeypatch):
    p = programme(LIMITED, stages=200, grid=6.0, interval=0.05)
    once = p.run()
    monkeypatch.setattr("fullpose.trajectory.shortest_path.BACK_BYTES", 1)  # blocks of 64 stages
    again = p.run()
    assert np.array_equal(once.angles, again.angles)


def test_the_frontier_names_the_rate_that_closed_it():
    time = np.arange(0.0, 1.01, 0.05)
    C = dcm_from_euler(0.0, 200 * DEG * np.clip(time - 0.5, 0, None), 0.0)  # pitch alone, from half a second on
    slow = FrameLimits(-50 * DEG, 50 * DEG, 40 * DEG)
    rig = Rig("slow", Geometry.VERTICAL_4, (slow, FrameLimits(max_rate=60 * DEG), slow, slow))
    node_path = Programme(time, C, rig, lattice(rig, DEG), PlanOptions()).run()
    assert not node_path.found
    assert 0.5 < time[node_path.reached] < 0.8
    assert (node_path.frame, node_path.limit) == (1, RATE)


def test_the_frontier_names_the_range_that_closed_it():
    time = np.arange(0.0, 1.01, 0.05)
    C = dcm_from_euler(0.0, 90 * DEG * time, 0.0)
    narrow = FrameLimits(-20 * DEG, 20 * DEG)
    rig = Rig("narrow", Geometry.VERTICAL_4, (narrow, FrameLimits(-30 * DEG, 30 * DEG), narrow, narrow))
    node_path = Programme(time, C, rig, lattice(rig, DEG), PlanOptions()).run()
    assert not node_path.found
    assert node_path.limit == POSITION
    assert 20 <= 90 * time[node_path.reached] <= 60


def test_turns_of_a_bounded_frame_are_counted():
    # Yaw alone at the level: base and middle share it; two and a half turns fit, three do not.
    time = np.arange(0.0, 8.01, 0.05)
    frames = (
        FrameLimits(0.0, 450 * DEG),
        FrameLimits(-DEG, DEG),
        FrameLimits(-10 * DEG, 10 * DEG),
        FrameLimits(-DEG, DEG),
    )
    rig = Rig("turns", Geometry.VERTICAL_4, frames)
    counted = np.array([True, False, False, False])
    for turn, fits in ((450.0, True), (480.0, False)):
        C = dcm_from_euler(turn * DEG * time / 8.0, 0.0, 0.0)
        node_path = Programme(time, C, rig, lattice(rig, 2 * DEG, counted), PlanOptions()).run()
        assert node_path.found == fits
        if fits:
            assert node_path.angles[:, 0].min() >= 0.0
            assert node_path.angles[:, 0].max() <= 450 * DEG + 1e-12


def test_without_rate_limits_the_node_path_is_looked_for_nearby_and_then_everywhere():
    rig = Rig("free", Geometry.VERTICAL_4, (FrameLimits(),) * 4)
    near = programme(rig, stages=40, grid=4.0, interval=0.05)
    assert near.bounded
    assert (near._reach(1) < 1.5).all()
    everywhere = programme(rig, stages=40, grid=4.0, interval=0.05, terms=Terms(everywhere=True))
    assert not everywhere.bounded
    assert (everywhere._reach(1) > np.pi).all()
    assert near.run().cost == pytest.approx(everywhere.run().cost)  # the cheapest node path has no long edges
    assert not programme(LIMITED).bounded


def test_a_node_path_that_is_missing_nearby_is_looked_for_everywhere(monkeypatch):
    monkeypatch.setattr("fullpose.trajectory.shortest_path.LOOK", 0.0)
    monkeypatch.setattr("fullpose.trajectory.shortest_path.LOOK_CELLS", 0.0)
    p = programme(Rig("free", Geometry.VERTICAL_4, (FrameLimits(),) * 4), interval=0.05)
    assert not p.run().found
    query = Query(np.arange(len(p.time)), np.zeros(4, np.bool_), p.grid.step)
    assert cheapest(Problem(p.time, p.attitude, p.rig), query, None)[0].found


def test_inertia_that_closes_the_way_is_named_as_an_acceleration():
    pose = programme(LIMITED, stages=20, grid=2.0, interval=0.05).run().angles[0]
    moving = Terms(motion=(pose, np.array([3.0, -3.0, 3.0, 3.0])))
    sluggish = replace_acceleration(LIMITED, 1.0 * DEG)
    node_path = programme(sluggish, stages=20, grid=2.0, interval=0.05, terms=moving).run(pose)
    assert not node_path.found
    assert node_path.limit == ACCELERATION


def replace_acceleration(rig, value):
    frames = tuple(replace(frame, max_acceleration=value) for frame in rig.frames)
    return replace(rig, frames=frames)
