"""The way ahead of a rig in motion: a search over the self-motion that knows the acceleration limits.

The horizon is cut into stages of some 50 ms. A state is a pose with its rates; from each, a few slides along the
self-motion are tried inside the box that position, rate, acceleration and braking distance leave (the step's own,
`fullpose.limits.limit_box`, on stages instead of samples). Of the states that reach one cell of place and rate the
cheapest is kept, and of the cells the cheapest `beam`. So the choice of the way round (which side, which chart) and the
inertia of the frames are decided together, which a path of nodes under rate limits alone cannot.

Where no slide stays inside the box the one that shares the excess is taken, dearly paid for: the way found is then the
one that exceeds least and latest.
"""

import math

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.charts import TURN, project
from fullpose.limits import ACCELERATION, HOME, MAX, MIN, RATE, WEIGHT, empty_box, limit_box, tolerances
from fullpose.step import clamp, null_interval

# Indices of the weights of the cost, one array
RATES, ACCELERATIONS, SINGULARITY, RANGES, EXCESS, AT_END, HOMING, ROOM, ROOM_TIME, ROOM_RATE = range(10)
WEIGHTS = 10

PLACES = 90  # cells a turn of the place along the curve
SPEEDS = 60  # cells of the rate along it, between -FASTEST and FASTEST: finer than one stage can change it
FASTEST = math.radians(480.0)  # [rad/s]; what is faster shares the last cell
WIDEST = math.radians(30.0)  # [rad] a slide in one stage where no limit bounds it
FREE_SLIDES = 8  # times as many slides where the first rate is free
UNLIMITED = 20.0  # [rad/s] of a frame without a rate limit, in the room
CLEAR = 0.05  # beside sin^2 d2 + cos^2 d3 in the cost: where its rise ends
NEAR_STOP = 0.02  # share of a range beside the room left in the cost


@kernel
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
    low = np.empty(4)
    high = np.empty(4)
    for i in range(4):
        low[i] = min(table[RATE, i], (d[i] - table[MIN, i]) / ahead, UNLIMITED)
        high[i] = min(table[RATE, i], (table[MAX, i] - d[i]) / ahead, UNLIMITED)
    if horizontal:
        low[1], high[1] = high[1], low[1]
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


@kernel
def pose_cost(horizontal: bool, table: Array, weights: Array, d: Array) -> float:
    """What a pose costs a second: little room, nearness of the singularity and of the end stops, distance from home."""
    s2 = math.sin(d[1])
    c3 = math.cos(d[2])
    clear = s2 * s2 + c3 * c3
    total = -float(weights[SINGULARITY]) * math.log((clear + CLEAR) / (2.0 + CLEAR))
    for i in range(4):
        half = 0.5 * (table[MAX, i] - table[MIN, i])
        if half > 0.0 and half < np.inf:
            u = (d[i] - table[MIN, i]) / half - 1.0
            u *= u
            total += weights[RANGES] * u * u / max(1.0 + NEAR_STOP - u, NEAR_STOP)
            off = d[i] - table[HOME, i]
            total += weights[HOMING] * off * off
    if weights[ROOM] > 0.0:
        share = weights[ROOM_RATE] / (room(horizontal, table, d, weights[ROOM_TIME]) + 0.1 * weights[ROOM_RATE])
        total += weights[ROOM] * share * share
    return total


@kernel
def cell_of(d: Array, along: float) -> int:
    """The cell of a pose with the rate `along` its self-motion [rad/s]."""
    c3 = math.cos(d[2])
    s2 = math.sin(d[1])
    if abs(c3) >= abs(s2):
        chart = 0 if c3 >= 0.0 else 1
        angle = d[0]
    else:
        chart = 2 if s2 >= 0.0 else 3
        angle = d[3]
    place = math.floor(angle * PLACES / TURN) % PLACES
    speed = math.floor((along / FASTEST + 1.0) * 0.5 * SPEEDS)
    return int((chart * PLACES + place) * SPEEDS + min(max(speed, 0), SPEEDS - 1))


@kernel
def search(
    horizontal: bool,
    table: Array,
    weights: Array,
    time: Array,
    attitude: Array,
    trust: Array,
    past: float,
    first: Array,
    first_rate: Array,
    slides: int,
    beam: int,
    poses: Array,
) -> tuple[float, int]:
    """poses (k, 4) <- the cheapest way found; returns (cost, first stage over a limit or k).

    time (k,) [s] and attitude (k, 3, 3) of the stages; trust (k,) weighs a stage's cost. The way starts at one of
    `first` (m, 4) [rad] with its rate (m, 4) [rad/s] over the interval `past` [s] just past (0: any rate may follow).
    """
    k = time.shape[0]
    m = first.shape[0]
    width = max(beam, m)
    d = np.empty((k, width, 4))
    parent = np.zeros((k, width), np.int32)
    excess_at = np.zeros((k, width), np.bool_)
    v = np.empty((width, 4))
    cost = np.empty(width)
    for b in range(m):
        for i in range(4):
            d[0, b, i] = first[b, i]
            v[b, i] = first_rate[b, i]
        cost[b] = 0.0
    count = m
    # A first rate that is free is chosen finely: inertia keeps it for a while.
    begin_slides = slides if past > 0.0 else FREE_SLIDES * slides
    space = max(width * (slides + 1), m * (begin_slides + 1))
    new_d = np.empty((space, 4))
    new_v = np.empty((space, 4))
    new_cost = np.empty(space)
    new_parent = np.empty(space, np.int32)
    new_over = np.empty(space, np.bool_)
    table_of = np.empty(4 * PLACES * SPEEDS, np.int32)
    box = empty_box()
    lo = box.lo
    hi = box.hi
    tolerance = np.empty(4)
    y = np.empty(4)
    x = np.empty(4)
    n = np.empty(4)
    side = 1.0 if horizontal else -1.0
    for stage in range(1, k):
        h = time[stage] - time[stage - 1]
        before = past if stage == 1 else time[stage - 1] - time[stage - 2]
        # The first interval past is a sample's, short; the rate it had changes over half of both.
        tolerances(table, before, h, tolerance)
        table_of[:] = -1
        filled = 0
        for b in range(count):
            here = d[stage - 1, b]
            limit_box(table, here, v[b], before, h, box)
            for i in range(4):
                x[i] = here[i] + v[b, i] * h
            project(horizontal, attitude[stage], x, y)
            s2 = math.sin(y[1])
            c2 = math.cos(y[1])
            s3 = math.sin(y[2])
            c3 = math.cos(y[2])
            n[0] = c3
            n[1] = -s2 * s3
            n[2] = -c2 * c3
            n[3] = side * s2
            size = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3])
            along = 0.0
            norm = 0.0
            for i in range(4):
                n[i] = n[i] / size if size > 0.0 else 0.0
                along += n[i] * table[WEIGHT, i] * (x[i] - y[i])
                norm += n[i] * n[i] * table[WEIGHT, i]
            z_min, z_max = null_interval(y, n, lo, hi, tolerance)
            coast = along / norm if norm > 0.0 else 0.0
            inside = z_min <= z_max
            if inside:
                coast = clamp(coast, z_min, z_max)
                z_min = max(z_min, coast - WIDEST)
                z_max = min(z_max, coast + WIDEST)
            else:
                coast = clamp(coast, z_min, z_max)
            most = begin_slides if stage == 1 else slides
            tries = most if inside else 0
            for t in range(-1, tries):
                z = coast if t < 0 else z_min + (z_max - z_min) * t / (most - 1)
                for i in range(4):
                    x[i] = y[i] + n[i] * z
                project(horizontal, attitude[stage], x, x)
                dear = 0.0
                over = 0.0
                speed = 0.0
                for i in range(4):
                    rate = (x[i] - here[i]) / h
                    new_v[filled, i] = rate
                    speed += rate * n[i]
                    share = rate / table[RATE, i]
                    dear += weights[RATES] * share * share
                    if before > 0.0:
                        change = (rate - v[b, i]) / (0.5 * (before + h) * table[ACCELERATION, i])
                        dear += weights[ACCELERATIONS] * change * change
                    out = max(lo[i] - x[i], x[i] - hi[i])
                    if out > 0.0:
                        out /= min(0.5 * table[ACCELERATION, i] * h * h, table[RATE, i] * h, 1.0)
                        over += max(0.0, out - 0.02)
                dear += pose_cost(horizontal, table, weights, x)
                total = cost[b] + trust[stage] * (h * dear + weights[EXCESS] * min(over, 10.0) * h)
                if over > 0.0:
                    total += trust[stage] * weights[EXCESS] * h
                cell = cell_of(x, speed)
                slot = table_of[cell]
                if slot < 0:
                    slot = filled
                    table_of[cell] = slot
                    filled += 1
                elif new_cost[slot] <= total:
                    continue
                else:
                    for i in range(4):
                        new_v[slot, i] = new_v[filled, i]
                for i in range(4):
                    new_d[slot, i] = x[i]
                new_cost[slot] = total
                new_parent[slot] = b
                new_over[slot] = over > 0.0
        order = np.argsort(new_cost[:filled])
        count = min(filled, beam)
        for b in range(count):
            slot = order[b]
            for i in range(4):
                d[stage, b, i] = new_d[slot, i]
                v[b, i] = new_v[slot, i]
            cost[b] = new_cost[slot]
            parent[stage, b] = new_parent[slot]
            excess_at[stage, b] = new_over[slot]
    best = 0
    least = np.inf
    for b in range(count):
        total = cost[b] + weights[AT_END] * trust[k - 1] * pose_cost(horizontal, table, weights, d[k - 1, b])
        if total < least:
            least = total
            best = b
    over_stage = k
    for stage in range(k - 1, -1, -1):
        for i in range(4):
            poses[stage, i] = d[stage, best, i]
        if excess_at[stage, best]:
            over_stage = stage
        best = parent[stage, best]
    return least, over_stage
