"""How much of the limits a path can leave at a point of the plane of time and base angle (mathematics, section 14).

A point (t, d1) and the sign of cos d3 give the other three angles, by the base chart. What is left of a frame's range
there is the distance to its nearer end over half of the range, in the turn that leaves most. The frames' rates there
are p + z n: p any that turns the payload as the flight does, n the null vector of the Jacobian, z free, since the base
may go at any rate. The rates are within their limits by the share that the best z leaves,

    1 - min over z of max over frames of |p_i + z n_i| / L_i.

So no path through the point leaves more of the limits, however it runs there: the margin is a bound, not a promise.
Accelerations are no part of it: what they ask for depends on how a path comes and goes.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, inner, kernel
from fullpose._typing import Array, Codes
from fullpose.bounds import CODES_PER_FRAME, EXACT
from fullpose.charts import base_chart, nearest
from fullpose.kinematics import four_axis_pose
from fullpose.least_squares import least_norm, squared_damping
from fullpose.limits import MAX, MIN, POSITION_CODE, RATE, RATE_CODE

TIED = 1e-9  # shares of two rate limits nearer than this are alike
SIDES = (1.0, -1.0)  # of the first axis of `Cells`: the sign of cos d3


class Cells(NamedTuple):
    """The map: sides of cos d3, times, base angles."""

    margin: Array  # (2, m, r) share of a limit left at most; negative where a limit is passed whatever the base does
    binding: Codes  # (2, m, r) `bounds.limited_code` of the limit that leaves no more
    against: Codes  # (2, m, r) of the rate limit that holds that one, `EXACT` where none does


@inner
def range_left(table: Array, frame: int, angle: float) -> float:
    """The distance of a frame's angle to the nearer end of its range over half of it; inf without a range.

    table (6, 4) `limits.limit_table`. The base is in the turn that it is in, another frame in the one nearest the
    middle.
    """
    low, high = table[MIN, frame], table[MAX, frame]
    if math.isinf(high):
        return math.inf
    half = 0.5 * (high - low)
    if frame > 0:
        angle = nearest(angle, low + half)
    off = abs(angle - low - half)
    if half > 0.0:
        return float(1.0 - off / half)
    return 1.0 if off == 0.0 else -math.inf


@inner
def largest_share(p: Array, n: Array, z: float) -> float:
    """The largest |p + z n| of p, n (4,)."""
    largest = 0.0
    for i in range(4):
        largest = max(largest, abs(p[i] + z * n[i]))
    return largest


@inner
def least_largest(p: Array, n: Array) -> tuple[float, float]:
    """(value, z) of the least over z of the largest |p + z n|; p, n (4,).

    The largest of lines is convex, and least where two of them meet or one is zero.
    """
    best, at = math.inf, 0.0
    for i in range(4):
        for j in range(i + 1):
            for sign in (1.0, -1.0):
                slope = n[i] - sign * n[j] if j < i else n[i]
                if slope == 0.0:
                    continue
                z = -(p[i] - sign * p[j]) / slope if j < i else -p[i] / slope
                value = largest_share(p, n, z)
                if value < best:
                    best, at = value, z
    return (best, at) if best < math.inf else (largest_share(p, n, 0.0), 0.0)


@inlined
def tied_frames(p: Array, n: Array, z: float, largest: float) -> tuple[int, int]:
    """(frame, other) whose |p + z n| is the largest, the base last; other is -1 where one frame alone has it."""
    first = other = -1
    for k in range(4):
        i = (k + 1) % 4
        if abs(p[i] + z * n[i]) >= largest - TIED * max(1.0, largest):
            if first < 0:
                first = i
            elif other < 0:
                other = i
    return first, other


@kernel
def fill_cells(horizontal: bool, table: Array, attitude: Array, body_rate: Array, base: Array, cells: Cells) -> None:
    """cells <- the map of attitudes (m, 3, 3) that turn by body_rate (m, 3) [rad/s], at base angles (r,) [rad].

    table (6, 4) `limits.limit_table`.
    """
    d, p, n = np.empty(4), np.empty(4), np.empty(4)
    F, J = np.empty((3, 3)), np.empty((3, 4))
    ones, zeros = np.ones(4), np.zeros(4)
    for j in range(attitude.shape[0]):
        for i in range(base.shape[0]):
            for side in range(2):
                base_chart(horizontal, attitude[j], base[i], SIDES[side], d)
                measure = four_axis_pose(horizontal, d, F, J, n)
                least_norm(J, ones, zeros, body_rate[j], squared_damping(measure), p)
                for k in range(4):
                    p[k] /= table[RATE, k]  # shares of the limits from here on
                    n[k] /= table[RATE, k]
                share, z = least_largest(p, n)
                margin = 1.0 - share
                frame, other = tied_frames(p, n, z, share)
                code = EXACT if share == 0.0 else RATE_CODE + CODES_PER_FRAME * frame
                against = EXACT if other < 0 or share == 0.0 else RATE_CODE + CODES_PER_FRAME * other
                for k in range(4):
                    left = range_left(table, k, d[k])
                    if left < margin:
                        margin, code, against = left, POSITION_CODE + CODES_PER_FRAME * k, EXACT
                cells.margin[side, j, i] = margin
                cells.binding[side, j, i] = code
                cells.against[side, j, i] = against
