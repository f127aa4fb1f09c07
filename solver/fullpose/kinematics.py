"""Forward kinematics of the rigs: payload attitude, Jacobian, null vector, manipulability (mathematics, section 2).

`axes` is `Rig.axes`; angles are d1..d4 [rad], base first. Rotations are passive: they carry vector components from
the outer frame into the inner one.
"""

import math

import numpy as np

from fullpose._jit import inlined, inner, kernel
from fullpose._typing import Array, Integers


@inlined
def turn(axis: int, angle: float, M: Array) -> None:
    """M <- R_axis(angle) M, in place; M (3, k). An absent axis leaves M as it is."""
    if axis < 0:
        return
    c = math.cos(angle)
    s = math.sin(angle)
    i = (axis + 1) % 3
    j = (axis + 2) % 3
    for k in range(M.shape[1]):
        a = M[i, k]
        b = M[j, k]
        M[i, k] = c * a + s * b
        M[j, k] = c * b - s * a


@inner
def payload_attitude(axes: Integers, d: Array, F: Array) -> None:
    """F <- R4(d4) R3(d3) R2(d2) R1(d1), body from reference. d (4,) [rad], F (3, 3)."""
    for i in range(3):
        for j in range(3):
            F[i, j] = 1.0 if i == j else 0.0
    for i in range(4):
        turn(axes[i], d[i], F)


@inner
def jacobian(axes: Integers, d: Array, J: Array) -> None:
    """J <- the body rate per frame rate, w = J d'; column i is R4..R(i+1) e_i. d (4,) [rad], J (3, 4)."""
    for i in range(4):
        for r in range(3):
            J[r, i] = 0.0
        if axes[i] < 0:
            continue
        J[axes[i], i] = 1.0
        for k in range(i + 1, 4):
            turn(axes[k], d[k], J[:, i : i + 1])


@inlined
def null_vector(J: Array, n: Array) -> float:
    """n <- the unit vector with J n = 0, from the signed 3x3 minors of J; returns the minors' norm.

    The norm is sqrt(det(J J^T)) (Cauchy-Binet); where it is zero, n is left zero. J (3, 4), n (4,).
    """
    total = 0.0
    for i in range(4):
        a, b, c = (1, 2, 3) if i == 0 else (0, 2, 3) if i == 1 else (0, 1, 3) if i == 2 else (0, 1, 2)
        minor = (
            J[0, a] * (J[1, b] * J[2, c] - J[1, c] * J[2, b])
            - J[0, b] * (J[1, a] * J[2, c] - J[1, c] * J[2, a])
            + J[0, c] * (J[1, a] * J[2, b] - J[1, b] * J[2, a])
        )
        n[i] = minor if i % 2 == 0 else -minor
        total += minor * minor
    norm = math.sqrt(total)
    if norm > 0.0:
        for i in range(4):
            n[i] /= norm
    return norm


@inlined
def self_motion(horizontal: bool, d: Array, n: Array) -> float:
    """`null_vector` of the Jacobian of a four-axis rig in closed form, but for the sign. d (4,) [rad], n (4,).

    n = (-cos d3, sin d2 sin d3, cos d2 cos d3, sin d2) / |..| of the vertical rig (mathematics, section 3);
    the horizontal one's d2 counts the other way (see `charts`).
    """
    s2 = math.sin(d[1])
    c3 = math.cos(d[2])
    n[0] = -c3
    n[1] = s2 * math.sin(d[2])
    n[2] = math.cos(d[1]) * c3
    n[3] = -s2 if horizontal else s2
    norm = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3])
    if norm > 0.0:
        for i in range(4):
            n[i] /= norm
    return norm


@inlined
def four_axis_pose(horizontal: bool, d: Array, F: Array, J: Array, n: Array) -> float:
    """F, J, n <- payload attitude, Jacobian and null vector of a four-axis rig; returns sqrt(det(J J^T)).

    `payload_attitude`, `jacobian` and `null_vector` (but for its sign) multiplied out, each sine and cosine taken once.
    Written for the vertical rig; the horizontal one sees y as z and z as -y, and its d2 counts the other way (see
    `charts`). d (4,) [rad], F (3, 3), J (3, 4), n (4,).
    """
    c1 = math.cos(d[0])
    s1 = math.sin(d[0])
    c2 = math.cos(d[1])
    s2 = math.sin(d[1])
    c3 = math.cos(d[2])
    s3 = math.sin(d[2])
    c4 = math.cos(d[3])
    s4 = math.sin(d[3])
    manipulability = self_motion(horizontal, d, n)
    y, z, side = (2, 1, -1.0) if horizontal else (1, 2, 1.0)
    s2 *= side
    J[0, 0] = c3 * s2
    J[y, 0] = c4 * c2 + s4 * (s3 * s2)
    J[z, 0] = side * (c4 * (s3 * s2) - s4 * c2)
    J[0, 1] = -side * s3
    J[y, 1] = side * (s4 * c3)
    J[z, 1] = c4 * c3
    J[0, 2] = 0.0
    J[y, 2] = c4
    J[z, 2] = -side * s4
    J[0, 3] = 1.0
    J[1, 3] = 0.0
    J[2, 3] = 0.0
    # F = R4 R3 R2 R1: R4 R3 R2 takes y to J's first column, z to its second (the vertical rig's) and x to a; R1 mixes
    # x and z.
    a0 = c3 * c2
    ay = s4 * (s3 * c2) - c4 * s2
    az = side * (c4 * (s3 * c2) + s4 * s2)
    F[0, 0] = c1 * a0 - s1 * s3
    F[y, 0] = c1 * ay + s1 * (s4 * c3)
    F[z, 0] = c1 * az + s1 * side * (c4 * c3)
    F[0, y] = J[0, 0]
    F[y, y] = J[y, 0]
    F[z, y] = J[z, 0]
    F[0, z] = -side * (c1 * s3 + s1 * a0)
    F[y, z] = side * (c1 * (s4 * c3) - s1 * ay)
    F[z, z] = c1 * (c4 * c3) - side * (s1 * az)
    return manipulability


@inlined
def singularity_measure(d: Array) -> float:
    """sin^2 d2 + cos^2 d3 of a four-axis rig: zero only at its singularity (mathematics, section 3). d (4,) [rad]."""
    s = math.sin(d[1])
    c = math.cos(d[2])
    return s * s + c * c


def singularity_measures(d: Array) -> Array:
    """`singularity_measure` of every row. d (n, 4) [rad], the measures (n,)."""
    return np.asarray(np.sin(d[:, 1]) ** 2 + np.cos(d[:, 2]) ** 2)


@inlined
def rotation_error(F: Array, C: Array, e: Array) -> float:
    """e <- the rotation vector of F C^T (body axes) [rad]; returns its length, the geodesic error [rad].

    Precise near zero: the length is atan2(|axis part|, cosine part). F, C (3, 3), e (3,). Near a half turn, where the
    axis part vanishes, the axis is taken from the symmetric part.
    """
    # E = F C^T, without a buffer: this runs in the inner loop.
    e00 = F[0, 0] * C[0, 0] + F[0, 1] * C[0, 1] + F[0, 2] * C[0, 2]
    e01 = F[0, 0] * C[1, 0] + F[0, 1] * C[1, 1] + F[0, 2] * C[1, 2]
    e02 = F[0, 0] * C[2, 0] + F[0, 1] * C[2, 1] + F[0, 2] * C[2, 2]
    e10 = F[1, 0] * C[0, 0] + F[1, 1] * C[0, 1] + F[1, 2] * C[0, 2]
    e11 = F[1, 0] * C[1, 0] + F[1, 1] * C[1, 1] + F[1, 2] * C[1, 2]
    e12 = F[1, 0] * C[2, 0] + F[1, 1] * C[2, 1] + F[1, 2] * C[2, 2]
    e20 = F[2, 0] * C[0, 0] + F[2, 1] * C[0, 1] + F[2, 2] * C[0, 2]
    e21 = F[2, 0] * C[1, 0] + F[2, 1] * C[1, 1] + F[2, 2] * C[1, 2]
    e22 = F[2, 0] * C[2, 0] + F[2, 1] * C[2, 1] + F[2, 2] * C[2, 2]
    # E is passive: E = exp(-[e]x), so the axis part has the opposite sign of an active rotation's.
    e[0] = 0.5 * (e12 - e21)
    e[1] = 0.5 * (e20 - e02)
    e[2] = 0.5 * (e01 - e10)
    sine = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
    cosine = 0.5 * (e00 + e11 + e22 - 1.0)
    angle = math.atan2(sine, cosine)
    if sine > 1e-9:
        for i in range(3):
            e[i] *= angle / sine
    elif cosine < 0.0:
        # The column of (E + 1) / 2 = a a^T with the largest diagonal gives the axis a.
        if e00 >= e11 and e00 >= e22:
            e[0], e[1], e[2] = e00 + 1.0, e10, e20
        elif e11 >= e22:
            e[0], e[1], e[2] = e01, e11 + 1.0, e21
        else:
            e[0], e[1], e[2] = e02, e12, e22 + 1.0
        norm = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
        for i in range(3):
            e[i] *= angle / norm
    return angle


@kernel
def matrix_error(F: Array, C: Array) -> float:
    """The largest absolute entry of F - C, the papers' figure; nan where one is. F, C (3, 3)."""
    largest = 0.0
    for i in range(3):
        for j in range(3):
            gap = abs(F[i, j] - C[i, j])
            if gap > largest or math.isnan(gap):  # once nan, nothing is greater
                largest = gap
    return largest


@kernel
def payload_attitudes(axes: Integers, d: Array, F: Array) -> None:
    """`payload_attitude` of every row. d (n, 4) [rad], F (n, 3, 3)."""
    for k in range(d.shape[0]):
        payload_attitude(axes, d[k], F[k])


@inner
def rotate_back(e: Array, C: Array, G: Array) -> None:
    """G <- exp(-[e]x) C, the attitude whose rotation error against C is e. e (3,) [rad], C, G (3, 3)."""
    angle = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
    if angle > 1e-8:
        a = math.sin(angle) / angle
        half = math.sin(0.5 * angle) / angle
        b = 2.0 * half * half
    else:
        a = 1.0
        b = 0.5
    for k in range(3):
        # Rodrigues on each column c: c - a e x c + b e x (e x c)
        c0 = C[0, k]
        c1 = C[1, k]
        c2 = C[2, k]
        x0 = e[1] * c2 - e[2] * c1
        x1 = e[2] * c0 - e[0] * c2
        x2 = e[0] * c1 - e[1] * c0
        G[0, k] = c0 - a * x0 + b * (e[1] * x2 - e[2] * x1)
        G[1, k] = c1 - a * x1 + b * (e[2] * x0 - e[0] * x2)
        G[2, k] = c2 - a * x2 + b * (e[0] * x1 - e[1] * x0)
