"""What the beam search weighs: the cost of a stage, of the pose at its end and of the step to it."""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, inner
from fullpose._typing import Array
from fullpose.kinematics import singularity_measure
from fullpose.limits import ACCELERATION, HOME, MAX, MIN, RATE, Box

UNLIMITED = 20.0  # [rad/s] of a frame without a rate limit, in the room
CLEAR = 0.05  # beside sin^2 d2 + cos^2 d3 in the cost: where its rise ends
NEAR_STOP = 0.02  # share of a range beside the room left in the cost


class Costs(NamedTuple):
    """What the search weighs: [1/s] but where said otherwise."""

    rates: float  # their squares as shares of the limits
    accelerations: float
    singularity: float
    ranges: float
    violation_cost: float
    homing: float  # [1/(rad^2 s)]
    at_end: float = 0.0  # [s] of standing at the last stage
    room: float = 0.0
    room_time: float = 0.0  # [s] that the room must last
    room_rate: float = 0.0  # [rad/s] that it is measured against


class Task(NamedTuple):
    """What holds for all stages."""

    horizontal: bool
    table: Array  # (6, 4) `limits.limit_table`
    costs: Costs


class Stage(NamedTuple):
    """The stage that is stepped to."""

    number: int
    attitude: Array  # (3, 3)
    trust: float
    ahead: float  # [s] the interval to it
    past: float  # [s] the interval before that
    slides: int  # tried from each state


@inlined
def followed(rate: float, distance: float, ahead: float) -> float:
    """The rate that a frame's limit and its distance from the stop allow for `ahead` [s]."""
    return min(rate, distance / ahead, UNLIMITED)


@inner
def room(horizontal: bool, table: Array, d: Array, ahead: float) -> float:
    """The body rate that could be followed for `ahead` [s] from d, whatever its direction [rad/s].

    The frame rates that the rate limits and the ranges allow for so long make a box; the body rates J v of a box are a
    zonotope, and the answer is the radius of the ball inside it: the least support over the normals of its faces, which
    are the cross products of two columns of J. Zero at the singularity, and on an end stop that matters.
    """
    s2 = -math.sin(d[1]) if horizontal else math.sin(d[1])
    c2 = math.cos(d[1])
    s3 = math.sin(d[2])
    c3 = math.cos(d[2])
    # Columns of R4^T J, as the vertical rig has them.
    column = ((c3 * s2, c2, s3 * s2), (-s3, 0.0, c3), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    low1 = followed(table[RATE, 1], d[1] - table[MIN, 1], ahead)
    high1 = followed(table[RATE, 1], table[MAX, 1] - d[1], ahead)
    if horizontal:
        low1, high1 = high1, low1
    low = (
        followed(table[RATE, 0], d[0] - table[MIN, 0], ahead), low1,
        followed(table[RATE, 2], d[2] - table[MIN, 2], ahead), followed(table[RATE, 3], d[3] - table[MIN, 3], ahead),
    )  # fmt: skip
    high = (
        followed(table[RATE, 0], table[MAX, 0] - d[0], ahead), high1,
        followed(table[RATE, 2], table[MAX, 2] - d[2], ahead), followed(table[RATE, 3], table[MAX, 3] - d[3], ahead),
    )  # fmt: skip
    least = np.inf
    for i in range(4):
        for j in range(i):
            a = column[i]
            b = column[j]
            x = a[1] * b[2] - a[2] * b[1]
            y = a[2] * b[0] - a[0] * b[2]
            z = a[0] * b[1] - a[1] * b[0]
            size = math.sqrt(x * x + y * y + z * z)
            if size < 1e-6:
                continue
            up = 0.0
            down = 0.0
            for k in range(4):
                p = (x * column[k][0] + y * column[k][1] + z * column[k][2]) / size
                if p > 0.0:
                    up += p * high[k]
                    down += p * low[k]
                else:
                    up -= p * low[k]
                    down -= p * high[k]
            least = min(least, up, down)
    return max(least, 0.0)


@inner
def pose_cost(task: Task, d: Array) -> float:
    """What a pose costs a second: little room, nearness of the singularity and of the end stops, distance from home."""
    table = task.table
    costs = task.costs
    total = -costs.singularity * math.log((singularity_measure(d) + CLEAR) / (2.0 + CLEAR))
    for i in range(4):
        half = 0.5 * (table[MAX, i] - table[MIN, i])
        if half > 0.0 and half < np.inf:
            u = (d[i] - table[MIN, i]) / half - 1.0
            u *= u
            total += costs.ranges * u * u / max(1.0 + NEAR_STOP - u, NEAR_STOP)
            off = d[i] - table[HOME, i]
            total += costs.homing * off * off
    if costs.room > 0.0:
        share = costs.room_rate / (room(task.horizontal, table, d, costs.room_time) + 0.1 * costs.room_rate)
        total += costs.room * share * share
    return total


@inner
def step_cost(task: Task, stage: Stage, rate: Array, new_rate: Array, x: Array, box: Box) -> tuple[float, float]:
    """(what the step to x costs a second, how far it exceeds its box) from a state with `rate`, at `new_rate`. (4,)"""
    table = task.table
    costs = task.costs
    h = stage.ahead
    cost = 0.0
    violation = 0.0
    for i in range(4):
        share = new_rate[i] / table[RATE, i]
        cost += costs.rates * share * share
        if stage.past > 0.0:
            change = (new_rate[i] - rate[i]) / (0.5 * (stage.past + h) * table[ACCELERATION, i])
            cost += costs.accelerations * change * change
        out = max(box.lo[i] - x[i], x[i] - box.hi[i])
        if out > 0.0:
            out /= min(0.5 * table[ACCELERATION, i] * h * h, table[RATE, i] * h, 1.0)
            violation += max(0.0, out - 0.02)
    cost += pose_cost(task, x)
    return cost, violation
