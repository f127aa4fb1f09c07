"""The start pose: exact, inside the limits, nearest; and what comes closest where there is none."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler
from fullpose.bounds import EXACT, limited_name
from fullpose.charts import base_chart, inner_chart
from fullpose.methods.start_pose import start_pose
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import attitude_errors, payload_attitudes

RIGS = builtin_rigs()
DEG = np.pi / 180.0


def error(rig: Rig, d: NDArray[np.float64], C: NDArray[np.float64]) -> float:
    return float(attitude_errors(payload_attitudes(rig, d[None]), C[None])[0][0])


def every_pose(rig: Rig, C: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """A dense sampling of all exact poses (m, 4), by brute force over both charts."""
    d = np.empty(4)
    poses = []
    for parameter in np.linspace(-np.pi, np.pi, count, endpoint=False):
        for branch in (1.0, -1.0):
            for chart in (base_chart, inner_chart):
                chart(rig.geometry.horizontal, C, parameter, branch, d)
                poses.append(d.copy())
    return np.array(poses)


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-limited"])
@pytest.mark.parametrize("seed", range(8))
def test_no_exact_pose_is_nearer_home(name: str, seed: int) -> None:
    rig = RIGS[name]
    C = Rotation.random(random_state=seed).as_matrix()
    d, code = start_pose(rig, C, None)
    assert code == EXACT
    assert error(rig, d, C) < 1e-14
    assert np.all((d >= rig.position_min) & (d <= rig.position_max))
    poses = every_pose(rig, C, 3000)
    poses = poses[np.all((poses >= rig.position_min) & (poses <= rig.position_max), axis=1)]
    assert np.sum(d**2) <= np.sum(poses**2, axis=1).min() + 1e-12


def test_a_start_that_fits_is_kept_to_the_digit() -> None:
    rig = RIGS["vertical-4"]
    near = np.array([7.0, -0.4, 0.5, 13.0])  # turns are kept as well
    d, code = start_pose(rig, payload_attitudes(rig, near[None])[0], near)
    assert code == EXACT
    np.testing.assert_allclose(d, near, atol=4e-15)


def test_the_turn_inside_the_range_is_taken() -> None:
    wide = FrameLimits(350.0 * DEG, 800.0 * DEG, home=400.0 * DEG)
    rig = Rig("wide", Geometry.VERTICAL_4, (wide, FrameLimits(), FrameLimits(), FrameLimits()))
    d, code = start_pose(rig, dcm_from_euler(10.0 * DEG, 0.0, 0.0)[0], None)
    assert code == EXACT
    assert 350.0 * DEG <= d[0] <= 800.0 * DEG


def test_where_no_pose_is_inside_the_frame_in_the_way_is_named() -> None:
    narrow = FrameLimits(-5.0 * DEG, 5.0 * DEG)
    rig = Rig("narrow", Geometry.VERTICAL_4, (narrow, narrow, narrow, narrow))
    C = dcm_from_euler(0.0, 0.0, 40.0 * DEG)[0]
    d, code = start_pose(rig, C, None)
    assert limited_name(code) == ("inner", "position")
    assert np.all(np.abs(d) <= 5.0 * DEG)
    # Roll 40 deg with every frame within 5: the best is 35 deg away.
    assert error(rig, d, C) == pytest.approx(35.0 * DEG, abs=1e-3)
