"""The two closed-form charts of the self-motion curve (mathematics, section 3; Lin 2022, Zhao 2025).

For an attitude C the solutions of a four-axis rig form curves. A chart gives the other three angles where one is
known: the base chart from d1 (folds where cos d3 = 0), the inner chart from d4 (folds where sin d2 = 0). The formulae
are the vertical rig's (y, z, y, x). The horizontal rig (z, y, z, x) is the same seen through a quarter turn about x,
which takes y to z and z to -y, so that its d2 counts the other way.
"""

import math

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array

TURN = 2.0 * math.pi


@inlined
def nearest(angle: float, reference: float) -> float:
    """The angle, plus whole turns, nearest to `reference` [rad]."""
    return angle + TURN * float(np.rint((reference - angle) / TURN))


@inlined
def vertical_view(horizontal: bool, C: Array) -> tuple[float, ...]:
    """The nine entries, row by row, of the attitude C (3, 3) as the vertical rig sees it.

    Rows and columns x, z, -y of the horizontal rig's.
    """
    if horizontal:
        return C[0, 0], C[0, 2], -C[0, 1], C[2, 0], C[2, 2], -C[2, 1], -C[1, 0], -C[1, 2], C[1, 1]
    return C[0, 0], C[0, 1], C[0, 2], C[1, 0], C[1, 1], C[1, 2], C[2, 0], C[2, 1], C[2, 2]


def vertical_views(attitude: Array, horizontal: bool) -> Array:
    """`vertical_view` of attitudes (n, 3, 3). (n, 3, 3)"""
    if not horizontal:
        return attitude
    turned = attitude[:, [0, 2, 1]][:, :, [0, 2, 1]]
    turned[:, 2, :] *= -1.0
    turned[:, :, 2] *= -1.0
    return turned


@inlined
def base_chart(horizontal: bool, C: Array, d1: float, branch: float, d: Array) -> None:
    """d <- the solution with base angle d1 and sign(cos d3) = branch (+1 or -1), angles in (-pi, pi] but d1 itself.

    C (3, 3) body from reference, d (4,) [rad].
    """
    c = math.cos(d1)
    s = math.sin(d1)
    # M = V Ry(d1)^T
    v00, v01, v02, v10, v11, v12, v20, v21, v22 = vertical_view(horizontal, C)
    m00 = v00 * c - v02 * s
    m01 = v01
    m02 = v00 * s + v02 * c
    m10 = v10 * c - v12 * s
    m20 = v20 * c - v22 * s
    d[0] = d1
    cos_d3 = branch * math.hypot(m00, m01)
    d[2] = math.atan2(-m02, cos_d3)
    d[1] = 0.0 if cos_d3 == 0.0 else math.atan2(branch * m01, branch * m00)
    # d4 with d2 undone, M Rz(d2)^T = Rx(d4) Ry(d3): exact for any d2, so also on the fold, where d2 is not determined.
    c = 1.0 if cos_d3 == 0.0 else m00 / cos_d3
    s = 0.0 if cos_d3 == 0.0 else m01 / cos_d3
    d[3] = math.atan2(m20 * s - v21 * c, v11 * c - m10 * s)
    if horizontal:
        d[1] = -d[1]


@inlined
def inner_chart(horizontal: bool, C: Array, d4: float, branch: float, d: Array) -> None:
    """d <- the solution with inner angle d4 and sign(sin d2) = branch (+1 or -1, of the vertical rig's d2).

    C (3, 3) body from reference, d (4,) [rad]. For the horizontal rig the branch is that of -d2.
    """
    c = math.cos(d4)
    s = math.sin(d4)
    # N = Rx(d4)^T V
    v00, _, v02, v10, v11, v12, v20, v21, v22 = vertical_view(horizontal, C)
    n10 = c * v10 - s * v20
    n11 = c * v11 - s * v21
    n12 = c * v12 - s * v22
    n20 = s * v10 + c * v20
    n22 = s * v12 + c * v22
    d[3] = d4
    sin_d2 = branch * math.hypot(n10, n12)
    d[1] = math.atan2(sin_d2, n11)
    d[0] = 0.0 if sin_d2 == 0.0 else math.atan2(branch * n12, -branch * n10)
    # d3 with d1 undone, N Ry(d1)^T = Ry(d3) Rz(d2): exact for any d1, so also on the fold, where d1 is not determined.
    c = 1.0 if sin_d2 == 0.0 else -n10 / sin_d2
    s = 0.0 if sin_d2 == 0.0 else n12 / sin_d2
    d[2] = math.atan2(-(v00 * s + v02 * c), n20 * s + n22 * c)
    if horizontal:
        d[1] = -d[1]


@inlined
def turn_to(d: Array, n0: float, n1: float, n2: float, n3: float) -> None:
    """d <- its angles at the turns nearest to n0..n3 [rad]."""
    d[0] = nearest(d[0], n0)
    d[1] = nearest(d[1], n1)
    d[2] = nearest(d[2], n2)
    d[3] = nearest(d[3], n3)


@inner
def project_inner(horizontal: bool, C: Array, near: Array, d: Array) -> None:
    """d <- the exact solution for C with the inner angle of `near`, on its branch and at the turns nearest to it.

    near, d (4,) [rad]; they may be the same array.
    """
    n0, n1, n2, n3 = near[0], near[1], near[2], near[3]
    upward = math.sin(n1) > 0.0
    if horizontal:
        upward = not upward
    inner_chart(horizontal, C, n3, 1.0 if upward else -1.0, d)
    turn_to(d, n0, n1, n2, n3)


@inner
def project(horizontal: bool, C: Array, near: Array, d: Array) -> None:
    """d <- an exact solution for C next to `near`, in the chart that is farther from its fold.

    Keeps d1 (base chart) or d4 (inner chart) of `near` and its branch; the others take the turn nearest to `near`.
    near, d (4,) [rad]; they may be the same array.
    """
    cos_d3 = math.cos(near[2])
    sin_d2 = math.sin(near[1])
    n0, n1, n2, n3 = near[0], near[1], near[2], near[3]
    if abs(cos_d3) < abs(sin_d2):
        project_inner(horizontal, C, near, d)
        return
    base_chart(horizontal, C, n0, 1.0 if cos_d3 >= 0.0 else -1.0, d)
    turn_to(d, n0, n1, n2, n3)
