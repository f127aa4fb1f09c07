"""Conversions against SciPy's Rotation, which shares no code with them, at singular attitudes too."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fullpose.attitude import (
    dcm_from_euler,
    dcm_from_quaternion,
    euler_from_dcm,
    euler_from_ned,
    quaternion_from_dcm,
    quaternion_from_enu,
    quaternion_from_euler,
    quaternion_from_ned,
    quaternion_from_rotation_vector,
    quaternion_from_rotations,
    quaternion_product,
)

ANGLE = st.one_of(
    st.floats(-10.0, 10.0), st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, -np.pi, np.pi / 2 - 1e-9, 1e-300])
)


def scipy_dcm(yaw: float, pitch: float, roll: float) -> np.ndarray:
    return Rotation.from_euler("YZX", [yaw, pitch, roll]).as_matrix().T


@given(ANGLE, ANGLE, ANGLE)
def test_matrix_of_euler_angles(yaw: float, pitch: float, roll: float) -> None:
    np.testing.assert_allclose(dcm_from_euler(yaw, pitch, roll)[0], scipy_dcm(yaw, pitch, roll), atol=1e-14)


@given(ANGLE, ANGLE, ANGLE)
def test_euler_angles_give_their_matrix_back(yaw: float, pitch: float, roll: float) -> None:
    C = dcm_from_euler(yaw, pitch, roll)
    np.testing.assert_allclose(dcm_from_euler(*euler_from_dcm(C)), C, atol=3e-12)


@given(ANGLE, ANGLE, ANGLE)
def test_quaternion_is_the_active_rotation(yaw: float, pitch: float, roll: float) -> None:
    w, x, y, z = quaternion_from_euler(yaw, pitch, roll)[0]
    np.testing.assert_allclose(Rotation.from_quat([x, y, z, w]).as_matrix().T, scipy_dcm(yaw, pitch, roll), atol=1e-14)


@given(ANGLE, ANGLE, ANGLE)
def test_quaternion_and_matrix_agree_both_ways(yaw: float, pitch: float, roll: float) -> None:
    q = quaternion_from_euler(yaw, pitch, roll)
    C = dcm_from_quaternion(q)
    np.testing.assert_allclose(C[0], scipy_dcm(yaw, pitch, roll), atol=1e-14)
    back = quaternion_from_dcm(C)
    assert back[0, 0] >= 0.0
    np.testing.assert_allclose(abs(float(np.sum(back * q))), 1.0, atol=1e-14)
    np.testing.assert_allclose(dcm_from_quaternion(back), C, atol=2e-15)


@pytest.mark.parametrize("axis", range(3))
def test_half_turns_have_a_quaternion(axis: int) -> None:
    C = -np.eye(3)
    C[axis, axis] = 1.0
    np.testing.assert_allclose(dcm_from_quaternion(quaternion_from_dcm(C[None]))[0], C, atol=1e-15)


@given(ANGLE, ANGLE, ANGLE)
def test_north_east_down(heading: float, pitch: float, bank: float) -> None:
    """The same flight in NED: Z-Y-X angles, x=N, y=-D, z=E for the reference and x=F, y=-D, z=R for the body."""
    body_from_ned = Rotation.from_euler("ZYX", [heading, pitch, bank]).as_matrix().T
    change = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    ours = change @ body_from_ned @ change.T
    np.testing.assert_allclose(dcm_from_euler(*euler_from_ned(heading, pitch, bank))[0], ours, atol=1e-14)
    x, y, z, w = Rotation.from_matrix(body_from_ned.T).as_quat()
    np.testing.assert_allclose(dcm_from_quaternion(quaternion_from_ned([[w, x, y, z]]))[0], ours, atol=1e-14)


def test_enu_and_forward_left_up_are_the_same_attitude_in_other_axes() -> None:
    body_to_enu = Rotation.random(50, rng=np.random.default_rng(3))
    ours_from_enu = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    ours_from_flu = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    ours = ours_from_enu @ body_to_enu.as_matrix() @ ours_from_flu.T
    q = quaternion_from_enu(body_to_enu.as_quat(scalar_first=True))
    np.testing.assert_allclose(dcm_from_quaternion(q), ours.swapaxes(1, 2), atol=1e-14)


def test_facing_east_in_enu_is_a_heading_of_a_quarter_turn() -> None:
    ned = quaternion_from_ned(Rotation.from_euler("ZYX", [90, 0, 0], degrees=True).as_quat(scalar_first=True))
    np.testing.assert_allclose(
        dcm_from_quaternion(quaternion_from_enu([1.0, 0.0, 0.0, 0.0])), dcm_from_quaternion(ned), atol=1e-15
    )


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "ZXZ", "YXY"])
def test_turns_in_any_order(order: str) -> None:
    angles = np.random.default_rng(5).uniform(-3.0, 3.0, (40, 3))
    np.testing.assert_allclose(
        Rotation.from_quat(quaternion_from_rotations(order, angles), scalar_first=True).as_matrix(),
        Rotation.from_euler(order, angles).as_matrix(),
        atol=1e-14,
    )


def test_many_rows_at_once() -> None:
    euler = np.random.default_rng(1).uniform(-3.0, 3.0, (3, 50))
    rows = dcm_from_euler(*euler)
    assert rows.shape == (50, 3, 3)
    for k in range(50):
        np.testing.assert_array_equal(rows[k], dcm_from_euler(*euler[:, k])[0])


def test_product_and_rotation_vector_against_scipy() -> None:
    random = np.random.default_rng(4)
    v = random.normal(size=(50, 3)) * 10.0 ** random.uniform(-9.0, 0.5, (50, 1))
    v[0] = 0.0
    first, second = Rotation.from_rotvec(v), Rotation.random(50, rng=random)
    q, p = quaternion_from_rotation_vector(v), second.as_quat(scalar_first=True)
    np.testing.assert_allclose(q, first.as_quat(canonical=False, scalar_first=True), atol=1e-15)
    expected = (second * first).as_quat(canonical=True, scalar_first=True)
    product = quaternion_product(p, q)
    np.testing.assert_allclose(product * np.sign(product[:, :1]), expected, atol=1e-15)
