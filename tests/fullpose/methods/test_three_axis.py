"""The Euler angles as a method."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.methods.three_axis import METHOD, ThreeAxisOptions
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight

RIGS = builtin_rigs()
NAMES = {0: "X", 1: "Y", 2: "Z"}


def run(rig: str, C: NDArray[np.float64], start: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    stepper = METHOD.stepper(RIGS[rig], ThreeAxisOptions(), start, C[0])
    return stepper.block(np.arange(len(C)) / 1000.0, C).angles


def payload(rig: str, angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """F by SciPy, body from reference."""
    F = np.tile(np.eye(3), (len(angles), 1, 1))
    for axis, d in zip(RIGS[rig].geometry.axes, angles.T, strict=True):
        if axis >= 0:
            F = Rotation.from_euler(NAMES[axis], d[:, None]).as_matrix().transpose(0, 2, 1) @ F
    return F


@pytest.mark.parametrize("rig", ["vertical-3", "horizontal-3", "vertical-4", "horizontal-4"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_exact_on_every_scenario(rig: str, name: str) -> None:
    C = dcm_from_quaternion(SCENARIOS[name].quaternion)
    angles = run(rig, C)
    assert np.abs(payload(rig, angles) - C).max() < 1e-14
    absent = 2 if rig.endswith("4") else 0
    assert not angles[:, absent].any()


@pytest.mark.parametrize(("rig", "columns"), [("vertical-3", (1, 2, 3)), ("vertical-4", (0, 1, 3))])
def test_vertical_angles_are_yaw_pitch_roll(rig: str, columns: tuple[int, ...]) -> None:
    scenario = SCENARIOS["large_no_limit"]
    np.testing.assert_allclose(
        run(rig, dcm_from_quaternion(scenario.quaternion))[:, columns], scenario.euler, atol=1e-13
    )


def test_horizontal_angles_are_pitch_yaw_roll() -> None:
    _, q = random_flight(2, 1.0, 1000.0, 1.0)
    first, second, roll = run("horizontal-3", dcm_from_quaternion(q)).T[1:]
    expected = Rotation.from_euler("ZYX", np.stack([first, second, roll], axis=1))
    assert (expected.inv() * Rotation.from_quat(q, scalar_first=True)).magnitude().max() < 1e-14


def test_goes_straight_over_the_pole_but_blows_up_beside_it() -> None:
    time = np.arange(2001) / 1000.0
    over = run("vertical-3", dcm_from_euler(0.0 * time, time * np.pi / 2, 0.0 * time))
    assert over[-1, 2] == pytest.approx(np.pi)
    assert np.abs(np.diff(over[:, 1])).max() == 0.0
    # The nose passes the pole at 0.1 deg: the first axis must turn half way round in a few samples.
    lean = dcm_from_euler(0.0, 0.0, np.deg2rad(0.1)) @ dcm_from_euler(0.0 * time, time * np.pi / 2, 0.0 * time)
    beside = run("vertical-3", lean @ dcm_from_euler(0.0, 0.0, np.deg2rad(0.1)))
    assert np.abs(np.diff(beside[:, 1])).max() * 1000.0 > np.deg2rad(10_000.0)


def test_start_chooses_the_set_and_the_turns() -> None:
    C = dcm_from_euler([0.2, 0.21], [0.3, 0.31], [0.4, 0.41])
    turn = 2.0 * np.pi
    near = run("vertical-3", C, np.array([0.0, 0.2 + turn, 0.3, 0.4 - turn]))
    np.testing.assert_allclose(near[0, 1:], [0.2 + turn, 0.3, 0.4 - turn], atol=1e-14)
    other = run("vertical-3", C, np.array([0.0, np.pi, np.pi, np.pi]))
    np.testing.assert_allclose(other[0, 1:], [0.2 + np.pi, np.pi - 0.3, 0.4 + np.pi], atol=1e-14)


def test_blocks_do_not_matter() -> None:
    C = dcm_from_quaternion(SCENARIOS["double_loop"].quaternion)
    stepper = METHOD.stepper(RIGS["vertical-3"], ThreeAxisOptions(), None, C[0])
    parts = [stepper.block(np.arange(1.0), C[k : k + 1]).angles for k in range(500)]
    np.testing.assert_array_equal(np.vstack(parts), run("vertical-3", C[:500]))
