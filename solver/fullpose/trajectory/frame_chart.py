"""The exact pose of an attitude where one frame's angle is known, whichever frame that is (mathematics, section 3).

From sin d2 cos d3 = V01, cos d2 cos d3 = M00, -sin d3 = M02 of the vertical rig, M = V Ry(d1)^T; the inner frame's
through the inner chart.
"""

import math

from fullpose._jit import inner, kernel
from fullpose._typing import Array
from fullpose.charts import TURN, base_chart, inner_chart, nearest, turn_to, vertical_view

BASE, OUTER, MIDDLE, INNER = range(4)


@inner
def base_angles(horizontal: bool, C: Array, frame: int, angle: float) -> tuple[float, float, bool]:
    """The two base angles with which frame 1..3 has `angle` at the attitude C (3, 3) [rad], and whether it may have it.

    Where outer or middle frame may not, both are the one of the nearest angle that it may.
    """
    v00, v01, v02, v10, _, v12, v20, _, v22 = vertical_view(horizontal, C)
    if frame == INNER:
        c = math.cos(angle)
        s = math.sin(angle)
        first = math.atan2(c * v12 - s * v22, s * v20 - c * v10)
        return first, first + 0.5 * TURN, True
    size = math.hypot(v00, v02)
    phase = math.atan2(v02, v00)  # M00 = size cos(d1 + phase), M02 = size sin(d1 + phase)
    if frame == MIDDLE:
        share = -math.sin(angle) / size
        turn = math.asin(min(max(share, -1.0), 1.0))
        return turn - phase, 0.5 * TURN - turn - phase, abs(share) <= 1.0
    d2 = -angle if horizontal else angle
    share = v01 * math.cos(d2) / (math.sin(d2) * size)
    turn = math.acos(min(max(share, -1.0), 1.0))
    return turn - phase, -turn - phase, abs(share) <= 1.0


@inner
def base_for(horizontal: bool, C: Array, frame: int, angle: float, near: float) -> float:
    """Of the base angles with which frame 1..3 has `angle` the one nearest to `near` [rad]; nan: there is none."""
    first, second, exists = base_angles(horizontal, C, frame, angle)
    if not exists:
        return math.nan
    first = nearest(first, near)
    second = nearest(second, near)
    return first if abs(first - near) < abs(second - near) else second


@inner
def pose_of(horizontal: bool, C: Array, frame: int, angle: float, branch: float, coast: float, d: Array) -> None:
    """d (4,) <- the pose in which a frame has `angle` [rad], next to it where there is none.

    branch: the sign of cos d3 for the base, of sin d2 (of the vertical rig) for the inner frame. Of outer and middle
    frame's two poses it is the one whose base is nearest to `coast` [rad].
    """
    if frame == BASE:
        base_chart(horizontal, C, angle, branch, d)
        return
    if frame == INNER:
        inner_chart(horizontal, C, angle, branch, d)
        return
    first, second, exists = base_angles(horizontal, C, frame, angle)
    first = nearest(first, coast)
    second = nearest(second, coast)
    base = first if abs(first - coast) < abs(second - coast) else second
    v01 = vertical_view(horizontal, C)[1]
    if frame == MIDDLE:
        upright = math.cos(angle) >= 0.0
    else:
        upright = (math.sin(angle) >= 0.0) == (v01 >= 0.0)
        if horizontal:
            upright = not upright
    base_chart(horizontal, C, base, 1.0 if upright else -1.0, d)
    if frame == OUTER and exists:
        d[1] = angle  # which has all its digits next to a needle, too


@inner
def branch_of(horizontal: bool, frame: int, d: Array) -> float:
    """Which of a frame's two poses d (4,) is: 1 or -1, the sign that changes at the fold of its chart."""
    if frame == BASE:
        return 1.0 if math.cos(d[2]) >= 0.0 else -1.0
    if frame == INNER:
        return 1.0 if (math.sin(d[1]) >= 0.0) != horizontal else -1.0
    return 1.0 if (math.sin(d[2]) if frame == OUTER else math.cos(d[1])) >= 0.0 else -1.0


@kernel
def frames_of(
    horizontal: bool, time: Array, attitude: Array, frame: int, angle: Array, branch: Array, first: Array, d: Array
) -> None:  # fmt: skip
    """d (n, 4) [rad] <- the frames of a path of one of them, angle (n,) [rad] at time (n,) [s], continuous.

    attitude (n, 3, 3); branch (n,) as in `pose_of`; first (4,) [rad], whose turns the first sample takes.
    """
    near = first
    rate = 0.0
    for k in range(angle.shape[0]):
        ahead = time[k] - time[k - 1] if k > 0 else 0.0
        pose_of(horizontal, attitude[k], frame, angle[k], branch[k], near[0] + rate * ahead, d[k])
        own = d[k, frame]
        turn_to(d[k], near[0], near[1], near[2], near[3])
        if frame == BASE:
            d[k, 0] = own
        rate = (d[k, 0] - near[0]) / ahead if k > 0 else 0.0
        near = d[k]
