"""The path of a rig that cannot hold the attitude: a beam search over all frames and their rates.

A state is a pose with its rates, not tied to the attitude; its cost is the attitude error, at a high power, so that the
largest error decides. Each stage a state is carried on by a few steps inside the box that position, rate, acceleration
and braking distance leave (`fullpose.limits.limit_box`): the step that meets attitude and body rate best, and those
where one frame is pushed as far as it goes, brakes or coasts while the others make up for it. Of the states that reach
one cell of places and rates the cheapest is kept, of the cells the cheapest `beam`. It is wide, not complete: it gives
starts for an optimisation that is local.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inner, kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.charts import TURN
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.limits import ACCELERATION, MAX, RATE, Box, empty_box, limit_box
from fullpose.trajectory.beam import cheapest

CELLS = 1 << 16
POSE_CELL = math.radians(12.0)  # [rad] width of a cell
RATE_CELLS = 8.0  # of a rate limit, or of what a stage's acceleration changes twice over
PUSHES = 4  # of each frame: to either end of its box, brake, coast
SWEEPS = 4  # over the frames
DIFFERENT = 0.5  # [rad] between two paths, at least, in some frame at some stage
RATE_GAIN = 0.5  # of the body rate's error over a stage beside the attitude's
EASE = 1e-3  # of a step beside the errors: what they leave free stays small


class AttitudeStages(NamedTuple):
    """What the path should meet."""

    time: Array  # (k,) [s]
    attitude: Array  # (k, 3, 3)
    rate: Array  # (k, 3) [rad/s] of the body over the interval before


class Search(NamedTuple):
    """What holds for all stages."""

    axes: Integers
    table: Array  # (6, 4) `limits.limit_table`
    power: float  # of the attitude error that a stage costs


class Stage(NamedTuple):
    """The stage that is stepped to."""

    number: int
    attitude: Array  # (3, 3)
    rate: Array  # (3,) [rad/s]
    ahead: float  # [s] the interval to it
    past: float  # [s] the interval before that


class Tree(NamedTuple):
    """The states kept: of each stage where they are and came from, of the last one their rates and costs."""

    pose: Array  # (k, width, 4) [rad]
    parent: Counts  # (k, width)
    rate: Array  # (width, 4) [rad/s]
    cost: Array  # (width,)


class Reached(NamedTuple):
    """The states found for a stage, one a cell at most."""

    pose: Array
    rate: Array
    cost: Array
    parent: Counts
    slot: Counts  # (CELLS,)


class Room(NamedTuple):
    """Room for one state's steps."""

    box: Box
    coast: Array  # (4,)
    F: Array
    J: Array
    e: Array
    step: Array  # (4,)
    gram: Array  # (4, 4)
    pull: Array  # (4,)


@inner
def cell(table: Array, h: float, x: Array, rate: Array) -> int:
    """The cell of a pose and its rates."""
    key = 1469598103
    for i in range(4):
        angle = x[i]
        if math.isinf(table[MAX, i]):
            angle -= TURN * math.floor(angle / TURN)
        key = (key ^ int(math.floor(angle / POSE_CELL) + 1000)) * 16777619 & 0x7FFFFFFFFFFF
        width = max(min(2.0 * table[ACCELERATION, i] * h, table[RATE, i] / RATE_CELLS), 1e-3)
        if width < np.inf:
            key = (key ^ int(math.floor(rate[i] / width) + 100000)) * 16777619 & 0x7FFFFFFFFFFF
    return int((key ^ (key >> 17)) & (CELLS - 1))


@inner
def relax(axes: Integers, room: Room, held: int) -> None:
    """room.step <- the least squares inside the box by sweeps over the frames; frame `held` stays as it is."""
    step = room.step
    for _ in range(SWEEPS):
        for i in range(4):
            if i == held or axes[i] < 0:
                continue
            slope = room.pull[i]
            for j in range(4):
                slope += room.gram[i, j] * step[j]
            s = step[i] - slope / room.gram[i, i]
            step[i] = min(max(s, room.box.lo[i] - room.coast[i]), room.box.hi[i] - room.coast[i])


@inner
def keep(table: Array, h: float, reached: Reached, count: int, cost: float, parent: int) -> int:
    """Keep the state in row `count` if it is the cheapest of its cell; returns the new count."""
    at = cell(table, h, reached.pose[count], reached.rate[count])
    slot = reached.slot[at]
    if slot < 0:
        reached.slot[at] = count
        reached.cost[count] = cost
        reached.parent[count] = parent
        return count + 1
    if reached.cost[slot] > cost:
        for i in range(4):
            reached.pose[slot, i] = reached.pose[count, i]
            reached.rate[slot, i] = reached.rate[count, i]
        reached.cost[slot] = cost
        reached.parent[slot] = parent
    return count


@inner
def model(search: Search, stage: Stage, here: Array, rate: Array, room: Room) -> None:
    """box, coast, gram, pull <- of a state: what a step from the pose that keeps its rates does to the errors."""
    h = stage.ahead
    limit_box(search.table, here, rate, stage.past, h, room.box)
    for i in range(4):
        room.coast[i] = here[i] + rate[i] * h
    payload_attitude(search.axes, room.coast, room.F)
    rotation_error(room.F, stage.attitude, room.e)
    J = room.J
    jacobian(search.axes, room.coast, J)
    for i in range(4):
        pull = 0.0
        for r in range(3):
            body = -stage.rate[r]
            for j in range(4):
                body += J[r, j] * rate[j]
            pull += J[r, i] * (room.e[r] + RATE_GAIN * h * body)
        room.pull[i] = pull
        for j in range(4):
            dot = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
            room.gram[i, j] = (1.0 + RATE_GAIN) * dot
        room.gram[i, i] += EASE


@inner
def pushed(room: Room, rate: Array, h: float, held: int, push: int) -> None:
    """room.step <- coasting, as near as the box allows, and frame `held` (-1: none) to an end of it, or braking."""
    for i in range(4):
        low = room.box.lo[i] - room.coast[i]
        high = room.box.hi[i] - room.coast[i]
        step = 0.0
        if i == held:
            if push == 0:
                step = low
            elif push == 1:
                step = high
            elif push == 2:
                step = -rate[i] * h
        room.step[i] = min(max(step, low), high)


@inner
def branch(search: Search, stage: Stage, tree: Tree, state: int, room: Room, reached: Reached, count: int) -> int:
    """reached <- the steps from one state of the stage before; returns how many states were found by now."""
    here = tree.pose[stage.number - 1, state]
    rate = tree.rate[state]
    h = stage.ahead
    model(search, stage, here, rate, room)
    for trial in range(-1, 4 * PUSHES):
        held = trial // PUSHES
        if held >= 0 and search.axes[held] < 0:
            continue
        pushed(room, rate, h, held, trial % PUSHES)
        relax(search.axes, room, held)
        x = reached.pose[count]
        for i in range(4):
            x[i] = min(max(room.coast[i] + room.step[i], room.box.lo[i]), room.box.hi[i])
            reached.rate[count, i] = (x[i] - here[i]) / h
        payload_attitude(search.axes, x, room.F)
        error = rotation_error(room.F, stage.attitude, room.e)
        count = keep(search.table, h, reached, count, tree.cost[state] + h * error**search.power, state)
    return count


@kernel
def rooted(search: Search, stages: AttitudeStages, poses: Array, rates: Array, width: int) -> Tree:
    """The states that the search begins from, and room for `width` a stage."""
    k = stages.time.shape[0]
    tree = Tree(np.empty((k, width, 4)), np.zeros((k, width), np.int32), np.empty((width, 4)), np.empty(width))
    F = np.empty((3, 3))
    e = np.empty(3)
    for b in range(poses.shape[0]):
        for i in range(4):
            tree.pose[0, b, i] = poses[b, i]
            tree.rate[b, i] = rates[b, i]
        payload_attitude(search.axes, poses[b], F)
        error = rotation_error(F, stages.attitude[0], e)
        tree.cost[b] = (stages.time[1] - stages.time[0]) * error**search.power
    return tree


@kernel
def attitude_search(
    search: Search, stages: AttitudeStages, poses: Array, rates: Array, beam: int, paths: Array
) -> int:  # fmt: skip
    """paths (w, k, 4) [rad] <- the cheapest paths found that differ; returns how many.

    poses, rates (m, 4) [rad, rad/s]: where it may begin; beam: states kept a stage.
    """
    m = poses.shape[0]
    width = max(beam, m)
    tree = rooted(search, stages, poses, rates, width)
    space = width * (4 * PUSHES + 1) + 1
    reached = Reached(
        np.empty((space, 4)), np.empty((space, 4)), np.empty(space), np.empty(space, np.int32),
        np.empty(CELLS, np.int32),
    )  # fmt: skip
    room = Room(
        empty_box(), np.empty(4), np.empty((3, 3)), np.empty((3, 4)), np.empty(3), np.empty(4), np.empty((4, 4)),
        np.empty(4),
    )  # fmt: skip
    count = m
    for number in range(1, stages.time.shape[0]):
        ahead = stages.time[number] - stages.time[number - 1]
        past = stages.time[number - 1] - stages.time[number - 2] if number > 1 else ahead
        stage = Stage(number, stages.attitude[number], stages.rate[number], ahead, past)
        reached.slot[:] = -1
        filled = 0
        for b in range(count):
            filled = branch(search, stage, tree, b, room, reached, filled)
        count = cheapest(reached, filled, beam, number, tree).size
    return different(tree, count, paths)


@kernel
def different(tree: Tree, count: int, paths: Array) -> int:
    """paths (w, k, 4) <- to the states of the last stage, cheapest first, those that are `DIFFERENT` somewhere."""
    k = tree.pose.shape[0]
    found = 0
    for b in range(count):
        if found == paths.shape[0]:
            break
        state = b
        for stage in range(k - 1, -1, -1):
            for i in range(4):
                paths[found, stage, i] = tree.pose[stage, state, i]
            state = tree.parent[stage, state]
        new = True
        for w in range(found):
            apart = 0.0
            for stage in range(k):
                for i in range(4):
                    apart = max(apart, abs(paths[found, stage, i] - paths[w, stage, i]))
            if apart < DIFFERENT:
                new = False
        if new:
            found += 1
    return found
