"""Nested node orientations against the solver's forward kinematics."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_quaternion, quaternion_from_dcm
from fullpose.kinematics import payload_attitude
from fullpose.rig import Geometry, Rig
from fullpose_server.scene.pose import frame_quaternions, multiply


@pytest.mark.parametrize("geometry", list(Geometry))
def test_nested_nodes_carry_the_payload_to_its_attitude(geometry: Geometry) -> None:
    rig = Rig("r", geometry)
    generator = np.random.default_rng(1)
    for angles in generator.uniform(-4.0, 4.0, (200, 4)):
        if not geometry.redundant:
            angles[0] = 0.0
        F = np.empty((3, 3))
        payload_attitude(rig.axes, angles, F)
        nodes = frame_quaternions(rig, angles)
        assert len(nodes) == len(geometry.frames)
        # Columns of the nested rotation are the body axes in the reference: the transpose of body-from-reference.
        nested = np.eye(3)
        for q in nodes:
            nested = nested @ Rotation.from_quat(q, scalar_first=True).as_matrix()
        np.testing.assert_allclose(nested, F.T, atol=1e-14)
        np.testing.assert_allclose(dcm_from_quaternion(multiply(nodes)), F, atol=1e-14)


def test_target_quaternion_and_nodes_speak_of_the_same_attitude() -> None:
    rig = Rig("r", Geometry.VERTICAL_4)
    angles = np.radians([20.0, -35.0, 50.0, 110.0])
    F = np.empty((3, 3))
    payload_attitude(rig.axes, angles, F)
    target = quaternion_from_dcm(F[None])[0]
    assert abs(multiply(frame_quaternions(rig, angles)) @ target) == pytest.approx(1.0, abs=1e-14)


def test_positive_angles_turn_the_nose_as_the_conventions_say() -> None:
    rig = Rig("r", Geometry.VERTICAL_3)  # yaw, pitch, roll

    def nose(yaw: float, pitch: float, roll: float) -> np.ndarray:
        q = multiply(frame_quaternions(rig, np.radians([0.0, yaw, pitch, roll])))
        return Rotation.from_quat(q, scalar_first=True).apply([1.0, 0.0, 0.0])

    np.testing.assert_allclose(nose(90.0, 0.0, 0.0), [0.0, 0.0, -1.0], atol=1e-15)  # yaw left: toward west, -z
    np.testing.assert_allclose(nose(0.0, 90.0, 0.0), [0.0, 1.0, 0.0], atol=1e-15)  # pitch up
    np.testing.assert_allclose(nose(0.0, 0.0, 90.0), [1.0, 0.0, 0.0], atol=1e-15)
