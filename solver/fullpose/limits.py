"""What one sample may do: the box of angles that the limits leave, such that the next sample has one too.

Rates and accelerations are those of the samples (the same differences `fullpose.verify` takes):
v_k = (x_k - x_{k-1}) / h_k and a_k = (v_{k+1} - v_k) / ((h_k + h_{k+1}) / 2).

Braking in discrete time. Let a frame have room R to its stop, rate v over the interval h just past, deceleration A.
Braking takes A (h_k + h_{k+1}) / 2 off the rate from one interval to the next, so the rates are the values, at the
middles of the intervals, of one line w of slope -A, and by the midpoint rule the distance run is the integral of w
from now on, until the last sample before w crosses zero. Whatever the intervals to come are, that is at most
u^2 / (2 A) with u = v - A h / 2. Hence a pose can be held inside its limits for ever if and only if
u <= 0 or u^2 <= 2 A R on both sides, and the rates over the next interval h that lead to such a pose are
v <= sqrt(2 A R) - A h / 2 where sqrt(2 A R) >= A h, else v <= R / h.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, kernel
from fullpose._typing import Array, Codes
from fullpose.bounds import CODES_PER_FRAME, limited_code
from fullpose.rig import Rig

MIN, MAX, RATE, ACCELERATION, WEIGHT, HOME = range(6)
POSITION_CODE, RATE_CODE, ACCELERATION_CODE = (limited_code(0, limit) for limit in range(3))

# Rounding must not turn a rate on its limit into one above it; the braking distance is reckoned with a little less
# than the deceleration there is, so that rounding cannot empty the box either.
INSIDE = 1.0 - 1e-9
STOP_MARGIN = 1e-10  # [rad] from the end stops, more than a sample's tolerance
BRAKING = 0.999


class Box(NamedTuple):
    """Where each frame may be at the next sample, and which limit set each bound."""

    lo: Array  # (4,) [rad]
    hi: Array
    lo_code: Codes  # (4,) `solution.limited_code`
    hi_code: Codes


@kernel
def empty_box() -> Box:
    """A box for `limit_box` to fill."""
    return Box(np.empty(4), np.empty(4), np.empty(4, np.int16), np.empty(4, np.int16))


def limit_table(rig: Rig) -> Array:
    """The rig's frames as the kernels read them: rows `MIN`, `MAX`, `RATE`, `ACCELERATION`, `WEIGHT`, `HOME`. (6, 4)"""
    return np.stack([rig.position_min, rig.position_max, rig.max_rate, rig.max_acceleration, rig.weight, rig.home])


@inlined
def approach_rate(room: float, deceleration: float, h: float) -> float:
    """The highest rate over an interval `h` [s] after which `room` still suffices to brake [rad/s].

    room [rad], deceleration [rad/s^2] may be infinite. Less than no room: the rate that goes back, so that tolerances
    do not add up from sample to sample.
    """
    if room <= 0.0 or math.isinf(deceleration):
        return room / h
    speed = math.sqrt(2.0 * deceleration * room)
    if speed >= deceleration * h:
        return speed - 0.5 * deceleration * h
    return room / h


@inlined
def limit_box(table: Array, d: Array, v: Array, h_past: float, h: float, box: Box) -> None:
    """box <- where each frame may be after the next interval `h` [s].

    d (4,) [rad]; v (4,) [rad/s] over the interval `h_past` just past; `h_past` = 0: there is none, any rate may follow.
    A pose kept inside this box sample after sample never meets an empty one (see above).
    """
    for i in range(4):
        # Braking distance and end stop.
        deceleration = BRAKING * table[ACCELERATION, i]
        top = np.inf
        bottom = -np.inf
        code = CODES_PER_FRAME * i + POSITION_CODE
        top_code = code
        bottom_code = code
        if table[MAX, i] < np.inf:
            top = approach_rate(table[MAX, i] - STOP_MARGIN - d[i], deceleration, h)
            bottom = -approach_rate(d[i] - table[MIN, i] - STOP_MARGIN, deceleration, h)
        limit = INSIDE * table[RATE, i]
        code = CODES_PER_FRAME * i + RATE_CODE
        if limit < top:
            top = limit
            top_code = code
        if -limit > bottom:
            bottom = -limit
            bottom_code = code
        if h_past > 0.0 and table[ACCELERATION, i] < np.inf:
            change = INSIDE * table[ACCELERATION, i] * 0.5 * (h_past + h)
            code = CODES_PER_FRAME * i + ACCELERATION_CODE
            if v[i] + change < top:
                top = v[i] + change
                top_code = code
            if v[i] - change > bottom:
                bottom = v[i] - change
                bottom_code = code
        lo = max(d[i] + bottom * h, table[MIN, i])
        hi = min(d[i] + top * h, table[MAX, i])
        if lo > hi:
            # Only by rounding: a frame that stands on its stop, or has no range.
            lo = hi = min(max(0.5 * (lo + hi), table[MIN, i]), table[MAX, i])
        box.lo[i] = lo
        box.hi[i] = hi
        box.lo_code[i] = bottom_code
        box.hi_code[i] = top_code


@inlined
def tolerances(table: Array, h_past: float, h: float, out: Array) -> None:
    """out <- how far outside its box a frame may round [rad]: 1e-8 of the narrowest limit's width. out (4,)"""
    for i in range(4):
        width = 1e-3
        if table[RATE, i] < np.inf:
            width = min(width, table[RATE, i] * h)
        if table[ACCELERATION, i] < np.inf:
            width = min(width, table[ACCELERATION, i] * 0.5 * (h_past + h) * h)
        out[i] = 1e-8 * width


@inlined
def inside(x: Array, lo: Array, hi: Array, tolerance: Array) -> bool:
    """Whether lo <= x <= hi within the tolerance; false for nan. All (4,)."""
    for i in range(4):  # noqa: SIM110 - a generator would cost an allocation in the inner loop
        if not (x[i] >= lo[i] - tolerance[i] and x[i] <= hi[i] + tolerance[i]):
            return False
    return True
