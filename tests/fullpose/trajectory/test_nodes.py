"""The grid covers the self-motion curve: every node is exact, and every exact pose has one near by."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.trajectory.nodes import OVERLAP, empty_nodes, fill_nodes, lattice
from fullpose.verify import payload_attitudes

RIGS = builtin_rigs()
DEG = np.pi / 180.0


def nodes_of(rig, C, grid):
    nodes = empty_nodes(grid.size)
    assert fill_nodes(grid.horizontal, C, grid.nodes, nodes) == nodes.alive.sum()
    return nodes


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-limited"])
def test_every_node_is_exact_and_inside_the_range(name):
    rig = RIGS[name]
    for C in Rotation.random(20, rng=np.random.default_rng(1)).as_matrix():
        position, measure, alive = nodes_of(rig, C, lattice(rig, 2.0 * DEG))
        d = position[alive]
        assert np.abs(payload_attitudes(rig, d) - C).max() < 5e-14
        assert np.allclose(measure[alive], np.sin(d[:, 1]) ** 2 + np.cos(d[:, 2]) ** 2, atol=1e-12)
        finite = np.isfinite(rig.position_max)
        assert (d[:, finite] <= rig.position_max[finite]).all()
        assert (d[:, finite] >= rig.position_min[finite]).all()


@settings(max_examples=200, deadline=None)
@given(st.tuples(*[st.floats(-3.1, 3.1)] * 4), st.sampled_from(["vertical-4", "horizontal-4"]))
def test_every_pose_away_from_the_singularity_has_a_node_within_the_covering_step(pose, name):
    rig, d = RIGS[name], np.array(pose)
    step = 1.0 * DEG
    assume(np.hypot(np.sin(d[1]), np.cos(d[2])) >= 0.1)  # the bound is claimed a few steps from the singularity
    C = payload_attitudes(rig, d[None])[0]
    position, _, alive = nodes_of(rig, C, lattice(rig, step))
    gap = np.abs(np.angle(np.exp(1j * (position[alive] - d)))).max(axis=1).min()
    assert gap <= 0.5 * step / OVERLAP * 1.02


def test_turns_are_counted_only_where_asked():
    wide = FrameLimits(-540 * DEG, 540 * DEG)
    rig = Rig("wide", Geometry.VERTICAL_4, (wide, FrameLimits(), FrameLimits(-DEG * 170, DEG * 170), wide))
    free = lattice(rig, DEG)
    assert free.wraps.tolist() == [True, True, False, True]
    assert free.copies.tolist() == [1, 1, 1, 1]
    counted = lattice(rig, DEG, np.array([True, True, True, False]))
    assert counted.wraps.tolist() == [False, True, False, True]
    assert counted.copies.tolist() == [4, 1, 1, 1]
    assert counted.states == 4 * 360 * 4
