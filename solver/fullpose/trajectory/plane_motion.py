"""Motions of the base in the plane of time and base angle, as the search tries them (mathematics, section 14).

A motion is a cubic of the base angle from where a state is, its second and third derivative, and the time of the needle
that it runs exactly through, where the branch changes; `NO_NEEDLE` where it runs through none.
"""

import math
from typing import NamedTuple

from fullpose._jit import inlined, inner
from fullpose._typing import Array, Integers
from fullpose.charts import TURN, nearest, vertical_view
from fullpose.limits import ACCELERATION, MAX, MIN

SOFT = 0.95  # share of a limit from which it costs
NO_NEEDLE = math.inf


class Plane(NamedTuple):
    """What holds for all stages."""

    horizontal: bool
    table: Array  # (6, 4) `limits.limit_table`
    base_wraps: bool  # whether whole turns of the base are alike
    counted: Array  # (4,) 1 where a frame's turns tell states apart
    rate_cell: Array  # (4,) [rad/s] the rates' cells of the base and of frames that lead; inf: of no account


class Stage(NamedTuple):
    """What is stepped to: fine samples after the stage's beginning."""

    at: Array  # (k,) [s] from the beginning, increasing
    attitude: Array  # (k, 3, 3)
    needle: float  # [s] from the beginning, `NO_NEEDLE` where it has none
    ahead: Array  # (m,) [s] from the beginning of the needles that may be aimed at, the stage's own the first of them
    ahead_base: Array  # (m,) [rad] their base angles, up to half turns


class Controls(NamedTuple):
    """What is tried from each state, beside what aims at needles."""

    base: Array  # (c,) [rad/s^2] constant accelerations of the base
    frame: Integers  # (l,) another frame that leads,
    share: Array  # (l,) and by which share of its acceleration limit, or 2: to rest at the end of its range
    slope: Array  # (s,) [rad/s] beside the mean one, with which a needle is run through


@inlined
def base_at(angle: float, rate: float, second: float, third: float, at: float) -> float:
    """The base angle `at` seconds into a motion [rad]."""
    return angle + at * (rate + at * (0.5 * second + at * third / 6.0))


@inlined
def rate_at(rate: float, second: float, third: float, at: float) -> float:
    """Its rate there [rad/s]."""
    return rate + at * (second + 0.5 * at * third)


@inner
def base_for(horizontal: bool, C: Array, frame: int, angle: float, near: float) -> float:
    """The base angle nearest to `near` with which frame 1..3 has `angle` at the attitude C (3, 3); nan: there is none.

    From sin d2 cos d3 = V01, cos d2 cos d3 = M00, -sin d3 = M02; the inner frame's through the inner chart.
    """
    v00, v01, v02, v10, _, v12, v20, _, v22 = vertical_view(horizontal, C)
    size = math.hypot(v00, v02)
    phase = math.atan2(v02, v00)  # M00 = size cos(d1 + phase), M02 = size sin(d1 + phase)
    if frame == 3:
        c, s = math.cos(angle), math.sin(angle)
        n10 = c * v10 - s * v20
        n12 = c * v12 - s * v22
        first = math.atan2(n12, -n10)
        second = first + 0.5 * TURN
    elif frame == 2:
        if abs(math.sin(angle)) > size:
            return math.nan
        turn = math.asin(-math.sin(angle) / size)
        first = turn - phase
        second = 0.5 * TURN - turn - phase
    else:
        d2 = -angle if horizontal else angle
        s = math.sin(d2)
        m00 = v01 * math.cos(d2)
        if abs(m00) > size * abs(s) or s == 0.0:
            return math.nan
        turn = math.acos(m00 / s / size)
        first = turn - phase
        second = -turn - phase
    first = nearest(first, near)
    second = nearest(second, near)
    return first if abs(first - near) < abs(second - near) else second


@inner
def frame_at(table: Array, frame: int, angle: float, rate: float, acceleration: float, at: float) -> float:
    """The angle of a frame `at` seconds on, at constant acceleration, no farther than the ends of its range [rad]."""
    there = angle + at * (rate + 0.5 * at * acceleration)
    return float(min(max(there, table[MIN, frame]), table[MAX, frame]))


@inner
def led_by(
    plane: Plane, stage: Stage, frame: int, share: float, base: Array, pose: Array, past: float, motion: Array
) -> bool:  # fmt: skip
    """motion <- the base's that moves another frame at constant acceleration; False where there is none.

    share: of the frame's acceleration limit; 2: whatever brings it to rest at the end of its range that is ahead.
    base (3,), pose (2, 4) of a state, `past` [s] between its two poses.
    """
    k = stage.at.shape[0]
    if k < 2 or past <= 0.0:
        return False
    angle = pose[0, frame]
    rate = (angle - pose[1, frame]) / past
    if share > 1.0:
        room = plane.table[MAX, frame] - angle if rate > 0.0 else angle - plane.table[MIN, frame]
        acceleration = -0.5 * rate * abs(rate) / room if 1e-9 < room < math.inf else 0.0
    else:
        acceleration = share * plane.table[ACCELERATION, frame]
    rate += 0.5 * past * acceleration
    stop = -rate / acceleration if share > 1.0 and rate * acceleration < 0.0 else math.inf
    h = (k - 1) // 2
    half = stage.at[h]
    end = stage.at[k - 1]
    there = frame_at(plane.table, frame, angle, rate, acceleration, min(half, stop))
    first = base_for(plane.horizontal, stage.attitude[h], frame, there, base[0] + base[1] * half)
    there = frame_at(plane.table, frame, angle, rate, acceleration, min(end, stop))
    second = base_for(
        plane.horizontal, stage.attitude[k - 1], frame, there, first + (first - base[0]) / half * (end - half)
    )
    if math.isnan(first) or math.isnan(second):
        return False
    a = 2.0 * (first - base[0] - base[1] * half) / (half * half)
    b = 2.0 * (second - base[0] - base[1] * end) / (end * end)
    motion[1] = 3.0 * (b - a) / (end - half)
    motion[0] = a - motion[1] * half / 3.0
    motion[2] = NO_NEEDLE
    return True


@inlined
def needle_angle(base: float, coast: float, other: bool) -> float:
    """Of the angles `base` plus half turns [rad] the one below `coast`, or the `other`, above it."""
    half = 0.5 * TURN
    there = base + half * math.floor((coast - base) / half)
    return there + half if other else there


@inner
def through_needle(stage: Stage, base: Array, other: bool, slope: float, motion: Array) -> None:
    """motion <- the base's that runs exactly through the stage's needle, `slope` [rad/s] faster than on average."""
    t = stage.needle
    rise = needle_angle(stage.ahead_base[0], base[0] + base[1] * t, other) - base[0]
    end_rate = rise / t + slope
    motion[0] = (6.0 * rise / t - 4.0 * base[1] - 2.0 * end_rate) / t
    motion[1] = (6.0 * base[1] + 6.0 * end_rate - 12.0 * rise / t) / (t * t)
    motion[2] = t


@inner
def aimed(stage: Stage, base: Array, first: int, second: int, sides: int, most: float, motion: Array) -> bool:
    """motion <- the parabola to a needle ahead, or the cubic through two; False where it needs more than `most`.

    sides: bit 0 for the side of the first, bit 1 for that of the second; second < 0: there is none.
    most [rad/s^2] of the base.
    """
    t1 = stage.ahead[first]
    coast = base[0] + base[1] * t1
    rise1 = needle_angle(stage.ahead_base[first], coast, sides % 2 == 1) - coast
    q1 = 2.0 * rise1 / (t1 * t1)
    motion[0] = q1
    motion[1] = 0.0
    if second >= 0:
        t2 = stage.ahead[second]
        coast = base[0] + base[1] * t2 + 0.5 * q1 * t2 * t2
        rise2 = needle_angle(stage.ahead_base[second], coast, sides >= 2) - base[0] - base[1] * t2
        q2 = 2.0 * rise2 / (t2 * t2)
        motion[1] = 3.0 * (q2 - q1) / (t2 - t1)
        motion[0] = q1 - motion[1] * t1 / 3.0
    end = stage.at[stage.at.shape[0] - 1]
    own = first == 0 and stage.needle < NO_NEEDLE
    motion[2] = stage.needle if own else NO_NEEDLE
    return bool(abs(motion[0]) <= most and abs(motion[0] + motion[1] * end) <= most)


@inner
def tried(
    plane: Plane, stage: Stage, controls: Controls, number: int, base: Array, pose: Array, past: float, motion: Array
) -> int:
    """motion <- the one of a number, from a state: base (3,), pose (2, 4), past [s].

    Returns 0; for what aims at needles, 1 and more; -1 where there is none.
    """
    own = controls.base.shape[0]
    led = own + controls.frame.shape[0]
    through = led + (2 * controls.slope.shape[0] if stage.needle < NO_NEEDLE else 0)
    if number < own:
        motion[0], motion[1], motion[2] = controls.base[number], 0.0, NO_NEEDLE
        return 0
    if number < led:
        c = number - own
        return 0 if led_by(plane, stage, controls.frame[c], controls.share[c], base, pose, past, motion) else -1
    if number < through:
        c = number - led
        through_needle(stage, base, c % 2 == 1, controls.slope[c // 2], motion)
        return 0
    needles = stage.ahead.shape[0]
    aim = number - through
    sides, first, second = aim % 4, aim // 4 // needles, aim // 4 % needles
    if second < first or (second == first and sides >= 2):
        return -1
    most = controls.base[own - 1] / SOFT
    return int(aim + 1) if aimed(stage, base, first, second if second > first else -1, sides, most, motion) else -1


@inlined
def count_of(stage: Stage, controls: Controls) -> int:
    """How many motions are tried from each state."""
    through = 2 * controls.slope.shape[0] if stage.needle < NO_NEEDLE else 0
    return int(controls.base.shape[0] + controls.frame.shape[0] + through + 4 * stage.ahead.shape[0] ** 2)
