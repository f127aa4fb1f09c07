"""Motions of one frame in the plane of time and its angle, as the search tries them (mathematics, section 14).

A motion is a cubic of the plane's own frame from where a state is, its second and third derivative, and the time of the
needle that it runs exactly through, where the branch changes; `NO_NEEDLE` where it runs through none.
"""

import math
from typing import NamedTuple

from fullpose._jit import inlined, inner
from fullpose._typing import Array, Integers
from fullpose.charts import TURN
from fullpose.limits import ACCELERATION, MAX, MIN
from fullpose.trajectory.frame_chart import base_for

SOFT = 0.95  # share of a limit from which it costs
NO_NEEDLE = math.inf
TOGETHER = 1e-6  # [s] two aims nearer than this are sides of one
SETTLING = 2  # rounds in which an aim and the slope there agree


class Plane(NamedTuple):
    """What holds for all stages."""

    horizontal: bool
    table: Array  # (6, 4) `limits.limit_table`
    frame: int  # whose plane it is: its own frame
    wraps: bool  # whether whole turns of that are alike
    cell: float  # [rad] of its angle
    counted: Array  # (4,) 1 where a frame's turns tell states apart
    rate_cell: Array  # (4,) [rad/s] the rates' cells of the own frame and of frames that lead; inf: of no account
    violation_cost: float  # [1/s] of a limit exceeded e times


class Stage(NamedTuple):
    """What is stepped to: fine samples after the stage's beginning."""

    at: Array  # (k,) [s] from the beginning, increasing
    attitude: Array  # (k, 3, 3)
    needle: float  # [s] from the beginning, `NO_NEEDLE` where it has none
    ahead: Array  # (m,) [s] from the beginning of the needles that may be aimed at, the stage's own the first of them
    ahead_angle: Array  # (m,) [rad] the own frame's angles there, up to half turns,
    ahead_bend: Array  # (m,) [s^2/rad] and how far beside them a path of some slope runs, by its square


class Controls(NamedTuple):
    """What is tried from each state, beside what aims at needles."""

    own: Array  # (c,) [rad/s^2] constant accelerations of the own frame
    frame: Integers  # (l,) another frame that leads, in the plane of the base,
    share: Array  # (l,) and by which share of its acceleration limit, or 2: to rest at the end of its range
    slope: Array  # (s,) [rad/s] beside the mean one, with which a needle is run through


@inlined
def angle_at(angle: float, rate: float, second: float, third: float, at: float) -> float:
    """The own frame's angle `at` seconds into a motion [rad]."""
    return angle + at * (rate + at * (0.5 * second + at * third / 6.0))


@inlined
def rate_at(rate: float, second: float, third: float, at: float) -> float:
    """Its rate there [rad/s]."""
    return rate + at * (second + 0.5 * at * third)


@inner
def frame_at(table: Array, frame: int, angle: float, rate: float, acceleration: float, at: float) -> float:
    """The angle of a frame `at` seconds on, at constant acceleration, no farther than the ends of its range [rad]."""
    there = angle + at * (rate + 0.5 * at * acceleration)
    return float(min(max(there, table[MIN, frame]), table[MAX, frame]))


@inner
def led_by(
    plane: Plane, stage: Stage, frame: int, share: float, own: Array, pose: Array, past: float, motion: Array
) -> bool:  # fmt: skip
    """motion <- the base's that moves another frame at constant acceleration; False where there is none.

    share: of the frame's acceleration limit; 2: whatever brings it to rest at the end of its range that is ahead.
    own (3,), pose (2, 4) of a state, `past` [s] between its two poses.
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
    first = base_for(plane.horizontal, stage.attitude[h], frame, there, own[0] + own[1] * half)
    there = frame_at(plane.table, frame, angle, rate, acceleration, min(end, stop))
    second = base_for(
        plane.horizontal, stage.attitude[k - 1], frame, there, first + (first - own[0]) / half * (end - half)
    )
    if math.isnan(first) or math.isnan(second):
        return False
    a = 2.0 * (first - own[0] - own[1] * half) / (half * half)
    b = 2.0 * (second - own[0] - own[1] * end) / (end * end)
    motion[1] = 3.0 * (b - a) / (end - half)
    motion[0] = a - motion[1] * half / 3.0
    motion[2] = NO_NEEDLE
    return True


@inlined
def needle_angle(angle: float, coast: float, other: bool) -> float:
    """Of the angles `angle` plus half turns [rad] the one below `coast`, or the `other`, above it."""
    half = 0.5 * TURN
    there = angle + half * math.floor((coast - angle) / half)
    return there + half if other else there


@inner
def through_needle(stage: Stage, own: Array, other: bool, slope: float, motion: Array) -> None:
    """motion <- the one that runs exactly through the stage's needle, `slope` [rad/s] faster than on average."""
    t = stage.needle
    rise = needle_angle(stage.ahead_angle[0], own[0] + own[1] * t, other) - own[0]
    end_rate = rise / t + slope
    motion[0] = (6.0 * rise / t - 4.0 * own[1] - 2.0 * end_rate) / t
    motion[1] = (6.0 * own[1] + 6.0 * end_rate - 12.0 * rise / t) / (t * t)
    motion[2] = t


@inner
def aimed(stage: Stage, own: Array, first: int, second: int, sides: int, most: float, motion: Array) -> bool:
    """motion <- the parabola to a needle ahead, or the cubic through two; False where it needs more than `most`.

    sides: bit 0 for the side of the first, bit 1 for that of the second; second < 0: there is none.
    most [rad/s^2] of the own frame.
    """
    t1 = stage.ahead[first]
    coast = own[0] + own[1] * t1
    # Beside the angle by the square of the slope there, which is not known before: one turn more is near enough.
    rise1 = needle_angle(stage.ahead_angle[first], coast, sides % 2 == 1) - coast
    aside = 0.0
    for _ in range(SETTLING if stage.ahead_bend[first] != 0.0 else 0):
        aside = stage.ahead_bend[first] * (own[1] + 2.0 * (rise1 + aside) / t1) ** 2
    q1 = 2.0 * (rise1 + aside) / (t1 * t1)
    motion[0] = q1
    motion[1] = 0.0
    if second >= 0:
        t2 = stage.ahead[second]
        if t2 - t1 < TOGETHER:
            return False
        coast = own[0] + own[1] * t2 + 0.5 * q1 * t2 * t2
        rise2 = needle_angle(stage.ahead_angle[second], coast, sides >= 2) - own[0] - own[1] * t2
        aside = 0.0
        for _ in range(SETTLING if stage.ahead_bend[second] != 0.0 else 0):
            q2 = 2.0 * (rise2 + aside) / (t2 * t2)
            third = 3.0 * (q2 - q1) / (t2 - t1)
            slope = own[1] + t2 * (q1 - third * t1 / 3.0 + 0.5 * third * t2)
            aside = stage.ahead_bend[second] * slope * slope
        q2 = 2.0 * (rise2 + aside) / (t2 * t2)
        motion[1] = 3.0 * (q2 - q1) / (t2 - t1)
        motion[0] = q1 - motion[1] * t1 / 3.0
    end = stage.at[stage.at.shape[0] - 1]
    through = first == 0 and stage.needle < NO_NEEDLE
    motion[2] = stage.needle if through else NO_NEEDLE
    return bool(abs(motion[0]) <= most and abs(motion[0] + motion[1] * end) <= most)


@inner
def tried(
    plane: Plane, stage: Stage, controls: Controls, number: int, own: Array, pose: Array, past: float, motion: Array
) -> int:
    """motion <- the one of a number, from a state: own (3,), pose (2, 4), past [s].

    Returns 0; for what aims at needles, 1 and more; -1 where there is none.
    """
    steady = controls.own.shape[0]
    led = steady + controls.frame.shape[0]
    through = led + (2 * controls.slope.shape[0] if stage.needle < NO_NEEDLE else 0)
    if number < steady:
        motion[0], motion[1], motion[2] = controls.own[number], 0.0, NO_NEEDLE
        return 0
    if number < led:
        c = number - steady
        return 0 if led_by(plane, stage, controls.frame[c], controls.share[c], own, pose, past, motion) else -1
    if number < through:
        c = number - led
        through_needle(stage, own, c % 2 == 1, controls.slope[c // 2], motion)
        return 0
    needles = stage.ahead.shape[0]
    aim = number - through
    sides, first, second = aim % 4, aim // 4 // needles, aim // 4 % needles
    if second < first or (second == first and sides >= 2):
        return -1
    most = controls.own[steady - 1] / SOFT
    return int(aim + 1) if aimed(stage, own, first, second if second > first else -1, sides, most, motion) else -1


@inlined
def count_of(stage: Stage, controls: Controls) -> int:
    """How many motions are tried from each state."""
    through = 2 * controls.slope.shape[0] if stage.needle < NO_NEEDLE else 0
    return int(controls.own.shape[0] + controls.frame.shape[0] + through + 4 * stage.ahead.shape[0] ** 2)
