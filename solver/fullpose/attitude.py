"""Attitude conversions (mathematics, section 1). Angles [rad].

C is body from reference, passive: v_body = C v_reference.
Reference axes: x forward (north), y up, z right (east). Body axes: x nose, y up, z right wing.
"""

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array


def dcm_from_euler(yaw: ArrayLike, pitch: ArrayLike, roll: ArrayLike) -> Array:
    """C = Rx(roll) Rz(pitch) Ry(yaw). Three (n,) or scalars [rad] -> (n, 3, 3)."""
    psi, theta, gamma = np.broadcast_arrays(*np.atleast_1d(np.asarray(yaw, float), pitch, roll))
    cy, sy, cp, sp, cr, sr = (f(a) for a in (psi, theta, gamma) for f in (np.cos, np.sin))
    C = np.empty((*psi.shape, 3, 3))
    C[..., 0, 0] = cp * cy
    C[..., 0, 1] = sp
    C[..., 0, 2] = -cp * sy
    C[..., 1, 0] = sr * sy - cr * sp * cy
    C[..., 1, 1] = cr * cp
    C[..., 1, 2] = sr * cy + cr * sp * sy
    C[..., 2, 0] = cr * sy + sr * sp * cy
    C[..., 2, 1] = -sr * cp
    C[..., 2, 2] = cr * cy - sr * sp * sy
    return C


def euler_from_dcm(C: ArrayLike) -> tuple[Array, Array, Array]:
    """(yaw, pitch, roll) [rad] of C (n, 3, 3); at pitch = +-90 deg roll is zero and yaw carries the turn."""
    M = np.asarray(C, float)
    pitch = np.arctan2(M[..., 0, 1], np.hypot(M[..., 0, 0], M[..., 0, 2]))
    locked = np.hypot(M[..., 0, 0], M[..., 0, 2]) < 1e-12
    yaw = np.where(locked, np.arctan2(M[..., 2, 0], M[..., 2, 2]), np.arctan2(-M[..., 0, 2], M[..., 0, 0]))
    roll = np.where(locked, 0.0, np.arctan2(-M[..., 2, 1], M[..., 1, 1]))
    return yaw, pitch, roll


def dcm_from_quaternion(q: ArrayLike) -> Array:
    """C of the unit quaternion (w, x, y, z), the active rotation from reference to body axes. (n, 4) -> (n, 3, 3)."""
    w, x, y, z = np.moveaxis(np.asarray(q, float), -1, 0)
    C = np.empty((*w.shape, 3, 3))
    C[..., 0, 0] = 1 - 2 * (y * y + z * z)
    C[..., 0, 1] = 2 * (x * y + w * z)
    C[..., 0, 2] = 2 * (x * z - w * y)
    C[..., 1, 0] = 2 * (x * y - w * z)
    C[..., 1, 1] = 1 - 2 * (x * x + z * z)
    C[..., 1, 2] = 2 * (y * z + w * x)
    C[..., 2, 0] = 2 * (x * z + w * y)
    C[..., 2, 1] = 2 * (y * z - w * x)
    C[..., 2, 2] = 1 - 2 * (x * x + y * y)
    return C


def quaternion_from_euler(yaw: ArrayLike, pitch: ArrayLike, roll: ArrayLike) -> Array:
    """q = q_y(yaw) q_z(pitch) q_x(roll) (w, x, y, z). Three (n,) [rad] -> (n, 4); continuous in the angles."""
    psi, theta, gamma = np.broadcast_arrays(*np.atleast_1d(np.asarray(yaw, float), pitch, roll))
    cy, sy, cp, sp, cr, sr = (f(0.5 * a) for a in (psi, theta, gamma) for f in (np.cos, np.sin))
    return np.stack(
        [
            cy * cp * cr - sy * sp * sr,
            cy * cp * sr + sy * sp * cr,
            sy * cp * cr + cy * sp * sr,
            cy * sp * cr - sy * cp * sr,
        ],
        axis=-1,
    )


def quaternion_from_dcm(C: ArrayLike) -> Array:
    """The unit quaternion (w, x, y, z) of C (n, 3, 3), w >= 0; Shepperd's largest component, so never near 0/0."""
    M = np.asarray(C, float)
    d0, d1, d2 = M[..., 0, 0], M[..., 1, 1], M[..., 2, 2]
    # Four times the squares of (w, x, y, z), then each row of products by whichever is largest.
    squares = np.stack([1 + d0 + d1 + d2, 1 + d0 - d1 - d2, 1 - d0 + d1 - d2, 1 - d0 - d1 + d2], axis=-1)
    wx, wy, wz = M[..., 1, 2] - M[..., 2, 1], M[..., 2, 0] - M[..., 0, 2], M[..., 0, 1] - M[..., 1, 0]
    xy, xz, yz = M[..., 0, 1] + M[..., 1, 0], M[..., 0, 2] + M[..., 2, 0], M[..., 1, 2] + M[..., 2, 1]
    rows = np.stack(
        [
            np.stack([squares[..., 0], wx, wy, wz], axis=-1),
            np.stack([wx, squares[..., 1], xy, xz], axis=-1),
            np.stack([wy, xy, squares[..., 2], yz], axis=-1),
            np.stack([wz, xz, yz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    largest = np.argmax(squares, axis=-1)
    q = np.take_along_axis(rows, largest[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.asarray(np.where(q[..., :1] < 0.0, -q, q))


def quaternion_from_rotation_vector(v: Array) -> Array:
    """The unit quaternion (w, x, y, z) of the rotation vectors v (n, 3) [rad]. (n, 4)"""
    half = 0.5 * np.linalg.norm(v, axis=-1, keepdims=True)
    return np.concatenate([np.cos(half), 0.5 * v * np.sinc(half / np.pi)], axis=-1)


def rotation_vector_from_quaternion(q: Array) -> Array:
    """The rotation vectors (n, 3) [rad] of unit quaternions q (n, 4) of either sign, at most half a turn long."""
    shorter = np.where(q[..., :1] < 0.0, -q, q)
    sine = np.linalg.norm(shorter[..., 1:], axis=-1, keepdims=True)
    moved = sine > 0.0
    angle = np.arctan2(sine, shorter[..., :1])
    return np.asarray(2.0 * shorter[..., 1:] * np.where(moved, angle / np.where(moved, sine, 1.0), 1.0))


def quaternion_product(a: Array, b: Array) -> Array:
    """a b, Hamilton's product of (w, x, y, z): first b, then a, about fixed axes. (n, 4) or (4,) each."""
    aw, ax, ay, az = np.moveaxis(a, -1, 0)
    bw, bx, by, bz = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )


def quaternion_from_ned(q: ArrayLike) -> Array:
    """Ours from a north-east-down, forward-right-down quaternion (w, x, y, z): the axes change, x=N, y=-D, z=E.

    Both frames turn by the same quarter turn about x, so the vector part alone is re-read: (x, y, z) -> (x, -z, y).
    """
    w, x, y, z = np.moveaxis(np.asarray(q, float), -1, 0)
    return np.stack([w, x, -z, y], axis=-1)


def euler_from_ned(heading: ArrayLike, pitch: ArrayLike, bank: ArrayLike) -> tuple[Array, Array, Array]:
    """(yaw, pitch, roll) of NED (heading, pitch, bank): yaw = -heading, the others the same [rad]."""
    return -np.asarray(heading, float), np.asarray(pitch, float), np.asarray(bank, float)


# From (east, north, up) to (north, up, east): a third of a turn about (1, 1, 1), backward.
_NUE_FROM_ENU = np.array([0.5, -0.5, -0.5, -0.5])
# From our body axes to (forward, left, up): a quarter turn about x.
_FLU_FROM_OURS = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])


def quaternion_from_enu(q: ArrayLike) -> Array:
    """Ours from an east-north-up, forward-left-up quaternion (w, x, y, z), as ROS has it (REP 103). (n, 4)"""
    return quaternion_product(quaternion_product(_NUE_FROM_ENU, np.asarray(q, float)), _FLU_FROM_OURS)


def quaternion_from_rotations(order: str, angles: ArrayLike) -> Array:
    """The quaternion (n, 4) of three rotations about body axes, one after the other: "ZYX" with angles (n, 3) [rad].

    Body to reference in the axes of whoever wrote the angles (`Rotation.from_euler` of SciPy, capitals).
    """
    half = 0.5 * np.asarray(angles, float)
    rotations = np.zeros((len(order), *half.shape[:-1], 4))
    for k, axis in enumerate(order):
        rotations[k, ..., 0], rotations[k, ..., 1 + "XYZ".index(axis)] = np.cos(half[..., k]), np.sin(half[..., k])
    first, second, third = rotations
    return quaternion_product(quaternion_product(first, second), third)
