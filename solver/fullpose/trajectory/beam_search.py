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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import inner, kernel
from fullpose._typing import Array, Counts
from fullpose.charts import TURN, project
from fullpose.kinematics import self_motion
from fullpose.limits import WEIGHT, Box, empty_box, limit_box, tolerances
from fullpose.step import clamp, null_interval
from fullpose.trajectory.beam import cheapest
from fullpose.trajectory.stage_cost import Costs, Stage, Task, pose_cost, step_cost

PLACES = 90  # cells a turn of the place along the curve
SPEEDS = 60  # cells of the rate along it, between -FASTEST and FASTEST: finer than one stage can change it
FASTEST = math.radians(480.0)  # [rad/s]; what is faster shares the last cell
WIDEST = math.radians(30.0)  # [rad] a slide in one stage where no limit bounds it
FREE_SLIDES = 8  # times as many slides where the first rate is free


class Stages(NamedTuple):
    """What the way must meet."""

    time: Array  # (k,) [s]
    attitude: Array  # (k, 3, 3)
    trust: Array  # (k,) weighs a stage's cost


class Start(NamedTuple):
    """Where the way may begin."""

    pose: Array  # (m, 4) [rad]
    rate: Array  # (m, 4) [rad/s] over the interval `past`
    past: float  # [s] just past; 0: any rate may follow


class Kept(NamedTuple):
    """The states kept: of each stage where they are and came from, of the last one their rates and costs."""

    pose: Array  # (k, width, 4) [rad]
    parent: Counts  # (k, width) the state of the stage before
    violated: NDArray[np.bool_]  # (k, width) whether a limit is exceeded on the way there
    rate: Array  # (width, 4) [rad/s]
    cost: Array  # (width,)


class Found(NamedTuple):
    """The states found for a stage, one a cell at most."""

    pose: Array  # (space, 4) [rad]
    rate: Array  # (space, 4) [rad/s]
    cost: Array  # (space,)
    parent: Counts  # (space,)
    violated: NDArray[np.bool_]  # (space,)
    slot: Counts  # (cells,) where a cell's state is; -1: it has none


class Scratch(NamedTuple):
    """Room for one state's slides."""

    box: Box
    tolerance: Array  # (4,) [rad]
    coast: Array  # (4,) [rad] the pose that keeps the rate, put on the curve
    null: Array  # (4,) the curve's direction there
    x: Array  # (4,) [rad] a slide's end


@inner
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
    slot = math.floor(angle * PLACES / TURN) % PLACES
    speed = math.floor((along / FASTEST + 1.0) * 0.5 * SPEEDS)
    return int((chart * PLACES + slot) * SPEEDS + min(max(speed, 0), SPEEDS - 1))


@inner
def slide_range(task: Task, stage: Stage, here: Array, rate: Array, room_for: Scratch) -> tuple[float, float, float]:
    """box, coast, null <- of the state; returns (the slide that coasts, the least and the most one inside the box).

    The least is above the most where none is inside; the one that coasts then shares the excess.
    """
    table = task.table
    y = room_for.coast
    n = room_for.null
    x = room_for.x
    limit_box(table, here, rate, stage.past, stage.ahead, room_for.box)
    for i in range(4):
        x[i] = here[i] + rate[i] * stage.ahead
    project(task.horizontal, stage.attitude, x, y)
    self_motion(task.horizontal, y, n)
    along = 0.0
    norm = 0.0
    for i in range(4):
        n[i] = -n[i]
        along += n[i] * table[WEIGHT, i] * (x[i] - y[i])
        norm += n[i] * n[i] * table[WEIGHT, i]
    z_min, z_max = null_interval(y, n, room_for.box.lo, room_for.box.hi, room_for.tolerance)
    coast = clamp(along / norm if norm > 0.0 else 0.0, z_min, z_max)
    if z_min <= z_max:
        return coast, max(z_min, coast - WIDEST), min(z_max, coast + WIDEST)
    return coast, z_min, z_max


@inner
def offer(found: Found, count: int, cell: int, x: Array, cost: float, parent: int, violated: bool) -> int:
    """Keep the state x, whose rate is in row `count`, if it is the cheapest of its cell; returns the new count."""
    slot = found.slot[cell]
    following = count
    if slot < 0:
        slot = count
        found.slot[cell] = slot
        following = count + 1
    elif found.cost[slot] <= cost:
        return count
    else:
        for i in range(4):
            found.rate[slot, i] = found.rate[count, i]
    for i in range(4):
        found.pose[slot, i] = x[i]
    found.cost[slot] = cost
    found.parent[slot] = parent
    found.violated[slot] = violated
    return following


@inner
def expand(task: Task, stage: Stage, kept: Kept, state: int, room_for: Scratch, found: Found, count: int) -> int:
    """found <- the slides from one state of the stage before; returns how many states were found by now."""
    here = kept.pose[stage.number - 1, state]
    rate = kept.rate[state]
    x = room_for.x
    h = stage.ahead
    coast, z_min, z_max = slide_range(task, stage, here, rate, room_for)
    inside = z_min <= z_max
    for t in range(-1, stage.slides if inside else 0):
        z = coast if t < 0 else z_min + (z_max - z_min) * t / (stage.slides - 1)
        for i in range(4):
            x[i] = room_for.coast[i] + room_for.null[i] * z
        project(task.horizontal, stage.attitude, x, x)
        new_rate = found.rate[count]
        along = 0.0
        for i in range(4):
            new_rate[i] = (x[i] - here[i]) / h
            along += new_rate[i] * room_for.null[i]
        cost, violation = step_cost(task, stage, rate, new_rate, x, room_for.box)
        violation_cost = task.costs.violation_cost
        total = kept.cost[state] + stage.trust * (h * cost + violation_cost * min(violation, 10.0) * h)
        if violation > 0.0:
            total += stage.trust * violation_cost * h
        count = offer(found, count, cell_of(x, along), x, total, state, violation > 0.0)
    return count


@kernel
def keep_cheapest(found: Found, count: int, beam: int, stage: int, kept: Kept) -> int:
    """kept <- the cheapest `beam` of the states found for a stage; returns how many."""
    slots = cheapest(found, count, beam, stage, kept)
    for b in range(slots.size):
        kept.violated[stage, b] = found.violated[slots[b]]
    return int(slots.size)


@kernel
def room_to_keep(start: Start, stages: int, width: int) -> Kept:
    """The states of the start, and room for `width` a stage."""
    kept = Kept(
        np.empty((stages, width, 4)), np.zeros((stages, width), np.int32), np.zeros((stages, width), np.bool_),
        np.empty((width, 4)), np.empty(width),
    )  # fmt: skip
    for b in range(start.pose.shape[0]):
        for i in range(4):
            kept.pose[0, b, i] = start.pose[b, i]
            kept.rate[b, i] = start.rate[b, i]
        kept.cost[b] = 0.0
    return kept


@inner
def trace(kept: Kept, state: int, poses: Array) -> int:
    """poses (k, 4) <- the way to a state of the last stage; returns the first stage over a limit, or k."""
    first = poses.shape[0]
    for stage in range(poses.shape[0] - 1, -1, -1):
        for i in range(4):
            poses[stage, i] = kept.pose[stage, state, i]
        if kept.violated[stage, state]:
            first = stage
        state = int(kept.parent[stage, state])
    return int(first)


@kernel
def search(
    horizontal: bool, table: Array, costs: Costs, stages: Stages, start: Start, slides: int, beam: int, poses: Array
) -> tuple[float, int]:
    """poses (k, 4) <- the cheapest way found; returns (cost, first stage over a limit or k).

    table (6, 4): `limits.limit_table`; slides: tried from each state; beam: states kept a stage.
    """
    time = stages.time
    k = time.shape[0]
    m = start.pose.shape[0]
    width = max(beam, m)
    task = Task(horizontal, table, costs)
    kept = room_to_keep(start, k, width)
    # A first rate that is free is chosen finely: inertia keeps it for a while.
    begin_slides = slides if start.past > 0.0 else FREE_SLIDES * slides
    space = max(width * (slides + 1), m * (begin_slides + 1))
    found = Found(
        np.empty((space, 4)), np.empty((space, 4)), np.empty(space), np.empty(space, np.int32),
        np.empty(space, np.bool_), np.empty(4 * PLACES * SPEEDS, np.int32),
    )  # fmt: skip
    room_for = Scratch(empty_box(), np.empty(4), np.empty(4), np.empty(4), np.empty(4))
    count = m
    for number in range(1, k):
        # The first interval past is a sample's, short; the rate it had changes over half of both.
        past = start.past if number == 1 else time[number - 1] - time[number - 2]
        stage = Stage(
            number, stages.attitude[number], stages.trust[number], time[number] - time[number - 1], past,
            begin_slides if number == 1 else slides,
        )  # fmt: skip
        tolerances(table, past, stage.ahead, room_for.tolerance)
        found.slot[:] = -1
        filled = 0
        for b in range(count):
            filled = expand(task, stage, kept, b, room_for, found, filled)
        count = keep_cheapest(found, filled, beam, number, kept)
    best = 0
    least = np.inf
    for b in range(count):
        total = kept.cost[b] + costs.at_end * stages.trust[k - 1] * pose_cost(task, kept.pose[k - 1, b])
        if total < least:
            least = total
            best = b
    return least, trace(kept, best, poses)
