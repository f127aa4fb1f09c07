"""The room that a pose leaves, against the hull of the rates that the frames have."""

import itertools

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from fullpose.kinematics import jacobian
from fullpose.limits import MAX, MIN, RATE, limit_table
from fullpose.trajectory.stage_cost import room
from tests.support.previews import HORIZONTAL, LIMITED


@pytest.mark.parametrize("rig", [LIMITED, HORIZONTAL], ids=["vertical", "horizontal"])
def test_room_is_the_radius_of_the_ball_in_the_attainable_rates(rig) -> None:
    """Against the convex hull of the box's corners, with the Jacobian of the kinematics."""
    random = np.random.default_rng(2)
    table = limit_table(rig)
    for _ in range(20):
        d = random.uniform(-np.pi, np.pi, 4)
        d[3] = random.uniform(-1.0, 1.0)
        J = np.empty((3, 4))
        jacobian(rig.axes, d, J)
        low = np.maximum(-table[RATE], (table[MIN] - d) / 0.5)
        high = np.minimum(table[RATE], (table[MAX] - d) / 0.5)
        corners = np.array(list(itertools.product(*zip(low, high, strict=True))))
        ball = -ConvexHull(corners @ J.T).equations[:, 3].max()
        assert room(rig.geometry.horizontal, table, d, 0.5) == pytest.approx(ball, rel=1e-6)


def test_no_room_at_the_singularity() -> None:
    assert room(False, limit_table(LIMITED), np.array([0.4, 0.0, np.pi / 2, 0.1]), 0.5) == pytest.approx(0.0, abs=1e-9)
