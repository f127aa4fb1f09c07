"""Forward kinematics against SciPy and MuJoCo, the Jacobian against finite differences, the laws of the null vector."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fullpose.attitude import euler_from_dcm
from fullpose.kinematics import (
    four_axis_pose,
    jacobian,
    matrix_error,
    null_vector,
    payload_attitude,
    payload_attitudes,
    rotate_back,
    rotation_error,
    self_motion,
    singularity_measure,
)
from fullpose.rig import Rig, builtin_rigs
from tests.support.mujoco_rig import PAYLOAD, mujoco_rig

RIGS = builtin_rigs()
FOUR = ("vertical-4", "horizontal-4")
ANGLES = st.lists(st.floats(-7.0, 7.0), min_size=4, max_size=4).map(np.array)
VECTOR = st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3).map(np.array)


def attitude_of(rig: Rig, d: NDArray[np.float64]) -> NDArray[np.float64]:
    F = np.empty((3, 3))
    payload_attitude(rig.axes, d, F)
    return F


def jacobian_of(rig: Rig, d: NDArray[np.float64]) -> NDArray[np.float64]:
    J = np.empty((3, 4))
    jacobian(rig.axes, d, J)
    return J


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-3", "horizontal-3"])
def test_ten_thousand_poses_against_scipy(name: str) -> None:
    rig = RIGS[name]
    d = np.random.default_rng(2).uniform(-np.pi, np.pi, (10_000, 4))
    F = np.empty((10_000, 3, 3))
    payload_attitudes(rig.axes, d, F)
    sequence = "".join("XYZ"[axis] for axis in rig.geometry.axes if axis >= 0)
    product = Rotation.from_matrix(np.broadcast_to(np.eye(3), (10_000, 3, 3)))
    for column, axis in zip(rig.geometry.frames, sequence, strict=True):
        product = product * Rotation.from_euler(axis, d[:, column : column + 1])
    assert np.abs(F - np.swapaxes(product.as_matrix(), 1, 2)).max() <= 1e-14


@pytest.mark.parametrize("name", FOUR)
def test_ten_thousand_poses_against_mujoco(name: str) -> None:
    rig = RIGS[name]
    model = mujoco_rig(rig)
    data = mujoco.MjData(model)
    inner = model.body(PAYLOAD).id
    worst = 0.0
    for d in np.random.default_rng(3).uniform(-np.pi, np.pi, (10_000, 4)):
        data.qpos[:] = d
        mujoco.mj_kinematics(model, data)
        worst = max(worst, float(np.abs(data.xmat[inner].reshape(3, 3).T - attitude_of(rig, d)).max()))
    assert worst <= 1e-14


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-3", "horizontal-3"])
@given(d=ANGLES)
def test_jacobian_against_finite_differences(name: str, d: NDArray[np.float64]) -> None:
    rig = RIGS[name]
    J = jacobian_of(rig, d)
    step = 1e-6
    for i in range(4):
        ahead, behind = d.copy(), d.copy()
        ahead[i] += step
        behind[i] -= step
        # The body rate: the rotation from behind to ahead, in body axes, over the time of one second.
        turn = Rotation.from_matrix(attitude_of(rig, behind) @ attitude_of(rig, ahead).T).as_rotvec() / (2.0 * step)
        np.testing.assert_allclose(J[:, i], turn, atol=1e-8)


@pytest.mark.parametrize("name", FOUR)
@given(d=ANGLES)
def test_null_vector(name: str, d: NDArray[np.float64]) -> None:
    J = jacobian_of(RIGS[name], d)
    n = np.empty(4)
    manipulability = null_vector(J, n)
    assert np.abs(J @ n).max() <= 1e-14
    np.testing.assert_allclose(manipulability**2, np.linalg.det(J @ J.T), atol=1e-13)
    if manipulability > 0.0:
        np.testing.assert_allclose(np.linalg.norm(n), 1.0, atol=1e-14)


@pytest.mark.parametrize("name", FOUR)
@given(d=ANGLES)
def test_the_closed_forms_are_the_products_multiplied_out(name: str, d: NDArray[np.float64]) -> None:
    rig = RIGS[name]
    F, J, n, along = np.empty((3, 3)), np.empty((3, 4)), np.empty(4), np.empty(4)
    manipulability = four_axis_pose(rig.geometry.horizontal, d, F, J, n)
    np.testing.assert_allclose(F, attitude_of(rig, d), rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(J, jacobian_of(rig, d), rtol=0.0, atol=1e-15)
    assert manipulability == pytest.approx(null_vector(J, along), abs=1e-15)
    if manipulability > 0.0:
        np.testing.assert_allclose(np.linalg.norm(n), 1.0, atol=1e-14)
        assert np.abs(J @ n).max() * manipulability <= 1e-15  # the direction is lost where the manipulability is
    assert self_motion(rig.geometry.horizontal, d, along) == manipulability
    np.testing.assert_array_equal(along, n)


@given(d=ANGLES)
def test_the_two_identities_of_the_vertical_rig(d: NDArray[np.float64]) -> None:
    """mathematics, section 3: sin d2 cos d3 = sin(pitch), det(J J^T) = 2 (1 - cos^2 d2 sin^2 d3)."""
    rig = RIGS["vertical-4"]
    _, pitch, _ = euler_from_dcm(attitude_of(rig, d)[None])
    np.testing.assert_allclose(np.sin(d[1]) * np.cos(d[2]), np.sin(pitch[0]), atol=1e-14)
    J = jacobian_of(rig, d)
    np.testing.assert_allclose(np.linalg.det(J @ J.T), 2.0 * (1.0 - (np.cos(d[1]) * np.sin(d[2])) ** 2), atol=1e-13)


@pytest.mark.parametrize("name", FOUR)
@pytest.mark.parametrize("outer", [0.0, np.pi, -np.pi])
@pytest.mark.parametrize("middle", [np.pi / 2, -np.pi / 2])
def test_the_singularity_and_only_it_has_no_volume(name: str, outer: float, middle: float) -> None:
    d = np.array([0.3, outer, middle, -0.8])
    n = np.empty(4)
    assert null_vector(jacobian_of(RIGS[name], d), n) <= 1e-15
    assert singularity_measure(d) <= 1e-30
    d[1] += 0.01
    assert null_vector(jacobian_of(RIGS[name], d), n) > 0.01
    assert singularity_measure(d) > 5e-5


@given(VECTOR.filter(lambda v: np.linalg.norm(v) > 1e-3), st.floats(0.0, np.pi))
def test_rotation_error_is_the_rotation_vector(axis: NDArray[np.float64], angle: float) -> None:
    axis = axis / np.linalg.norm(axis)
    C = Rotation.random(random_state=1).as_matrix()
    # F lies ahead of C by the turn about `axis` in body axes: passive, so the transpose.
    F = Rotation.from_rotvec(axis * angle).as_matrix().T @ C
    e = np.empty(3)
    assert rotation_error(F, C, e) == pytest.approx(angle, abs=1e-12)
    if angle < np.pi - 1e-6:
        np.testing.assert_allclose(e, axis * angle, atol=1e-9)
    else:
        np.testing.assert_allclose(np.abs(e @ axis), angle, atol=1e-6)


@pytest.mark.parametrize("angle", [1e-12, 1e-9, 1e-6, 1e-3])
def test_small_errors_keep_their_digits(angle: float) -> None:
    C = np.eye(3)
    F = Rotation.from_rotvec([0.0, angle, 0.0]).as_matrix().T
    assert rotation_error(F, C, np.empty(3)) == pytest.approx(angle, rel=1e-9)


def test_matrix_error_sees_the_largest_entry_and_nan() -> None:
    F = np.eye(3)
    C = np.eye(3)
    C[1, 2] = -0.25
    assert matrix_error(F, C) == 0.25
    C[0, 0] = np.nan
    assert np.isnan(matrix_error(F, C))


@given(st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3).map(np.array))
def test_rotate_back_is_undone_by_the_rotation_error(e: NDArray[np.float64]) -> None:
    C = Rotation.random(random_state=4).as_matrix()
    G = np.empty((3, 3))
    rotate_back(e, C, G)
    np.testing.assert_allclose(G, Rotation.from_rotvec(e).as_matrix().T @ C, atol=1e-14)
    out = np.empty(3)
    angle = rotation_error(G, C, out)
    if np.linalg.norm(e) < 3.0:
        assert angle == pytest.approx(np.linalg.norm(e), abs=1e-12)
        np.testing.assert_allclose(out, e, atol=1e-9)
