"""A beam search in the plane of time and one frame's angle, the base's or another's (mathematics, section 14).

A state is the angle of the plane's own frame, its rate and the branch; that gives the other frames. From each, constant
accelerations are tried for a stage, cubics to what may be aimed at ahead, and, where the stage holds a needle, those
that run exactly through it and so change the branch. Of the states that reach one cell of angle, rate, branch and turns
the cheapest is kept, and of the cells the cheapest `breadth`. The frames' rates and accelerations are differenced at
the fine samples of the stage.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, inner, kernel
from fullpose._typing import Array, Integers
from fullpose.charts import TURN, turn_to
from fullpose.limits import ACCELERATION, MAX, MIN, RATE
from fullpose.trajectory.frame_chart import BASE, INNER, branch_of, pose_of
from fullpose.trajectory.plane_motion import NO_NEEDLE, SOFT, Controls, Plane, Stage, angle_at, count_of, rate_at, tried

DEAREST = 20.0  # of those costs: a stage that adds more than a second of so much is not gone on from
EFFORT_COST = 1.0  # [1/s] of accelerations as shares of their limits, squared
RANGE_UNIT = math.radians(0.3)  # outside a range by which costs as much as a limit exceeded twice
CELLS = 1 << 16  # of the table
FULL = CELLS // 2  # states that it takes, more than are ever found
PROBES = 64
AIMS = 257  # a prime above the numbers that tell apart what is aimed at
EMPTY = -(1 << 62)  # the key of a slot that holds nothing


class States(NamedTuple):
    """States at the end of a stage."""

    own: Array  # (w, 3): angle [rad] of the own frame, its rate [rad/s], branch
    pose: Array  # (w, 2, 4) [rad] at the last fine sample and at the one before
    past: Array  # (w,) [s] between those two; 0: the one before is not known
    cost: Array  # (w,)
    parent: Integers  # (w,)
    motion: (
        Array  # (w, 3): that led to it: second and third derivative of the angle where it begins, and the needle's time
    )


def empty_states(width: int) -> States:
    """Room for `width` states."""
    return States(
        np.empty((width, 3)), np.empty((width, 2, 4)), np.zeros(width), np.empty(width), np.zeros(width, np.int64),
        np.zeros((width, 3)),
    )  # fmt: skip


@inlined
def dearness(share: float) -> float:
    """How dear a share of a limit is."""
    return math.log(share / SOFT) if share > SOFT else 0.0


@inner
def sample_cost(plane: Plane, before: Array, here: Array, there: Array, past: float, ahead: float) -> float:
    """The cost of going from here to there (4,) [rad] in `ahead` [s], from `before` in `past` (0: not known)."""
    table = plane.table
    beyond = 0.0
    effort = 0.0
    for i in range(4):
        rate = (there[i] - here[i]) / ahead
        beyond += dearness(abs(rate) / table[RATE, i])
        if past > 0.0:
            share = abs(rate - (here[i] - before[i]) / past) / (0.5 * (past + ahead) * table[ACCELERATION, i])
            beyond += dearness(share)
            effort += min(share * share, 1.0)
        outside = max(table[MIN, i] - there[i], there[i] - table[MAX, i])
        if outside > 0.0:
            beyond += math.log1p(outside / RANGE_UNIT)
    return float(plane.violation_cost * beyond + EFFORT_COST * effort)


@inner
def roll(plane: Plane, stage: Stage, own: Array, motion: Array, past: float, poses: Array, most: float) -> float:
    """poses[2:] <- the frames at the stage's fine samples; poses[:2] (4,) are where they come from.

    own (3,) of the state, motion (3,), past [s] between poses[0] and poses[1]. Returns the cost, of which no more is
    reckoned than to find that it is above `most`.
    """
    cost = 0.0
    come = past
    last = 0.0
    for k in range(stage.at.shape[0]):
        at = stage.at[k]
        here = poses[k + 1]
        there = poses[k + 2]
        branch = -own[2] if at > motion[2] else own[2]
        ahead = at - last
        coast = here[0] + ((here[0] - poses[k, 0]) / come * ahead if come > 0.0 else 0.0)
        angle = angle_at(own[0], own[1], motion[0], motion[1], at)
        pose_of(plane.horizontal, stage.attitude[k], plane.frame, angle, branch, coast, there)
        angle = there[plane.frame]
        turn_to(there, here[0], here[1], here[2], here[3])
        if plane.frame == BASE:
            there[0] = angle
        cost += ahead * sample_cost(plane, poses[k], here, there, come, ahead)
        if cost > most:
            return float(cost)
        come = ahead
        last = at
    return float(cost)


@inner
def cell(plane: Plane, rate: float, branch: float, before: Array, pose: Array, past: float) -> int:
    """The number of a state's cell: pose (4,) [rad], the one `past` [s] before, and the own frame's rate [rad/s]."""
    number = math.floor(pose[plane.frame] / plane.cell)
    if plane.wraps:
        number = number % round(TURN / plane.cell)
    key = int(number) * 4099 + math.floor(rate / plane.rate_cell[plane.frame] + 0.5)
    key = key * 2 + (1 if branch > 0.0 else 0)
    for i in range(4):
        if i == plane.frame:
            continue
        if plane.counted[i] > 0.0:
            key = key * 31 + math.floor(pose[i] / TURN + 0.5)
        if plane.rate_cell[i] < math.inf:
            key = key * 509 + math.floor((pose[i] - before[i]) / past / plane.rate_cell[i] + 0.5)
    return int(key)


@inlined
def slot_of(key: int, keys: Integers) -> int:
    """Where `key` is in an open table, or is to be; -1: the table is full."""
    slot = (key * 40503 + 12345) % CELLS
    for _ in range(PROBES):
        if keys[slot] == key or keys[slot] == EMPTY:
            return int(slot)
        slot = (slot + 1) % CELLS
    return -1


def first_of(states: States, count: int) -> States:
    """The first `count` of them."""
    return States(
        states.own[:count].copy(), states.pose[:count].copy(), states.past[:count].copy(), states.cost[:count].copy(),
        states.parent[:count].copy(), states.motion[:count].copy(),
    )  # fmt: skip


class Table(NamedTuple):
    """The states found for a stage, by their cells."""

    keys: Integers  # (CELLS,)
    row: Integers  # (CELLS,) of the state in `found`
    found: States


@inner
def row_for(table: Table, key: int, cost: float, filled: int) -> int:
    """Where a state of a cell may be put; -1 where a cheaper one is there, or no room."""
    slot = slot_of(key, table.keys)
    if slot < 0:
        return -1
    if table.keys[slot] == key:
        at = table.row[slot]
        return int(at) if cost < table.found.cost[at] else -1
    if filled >= FULL:
        return -1
    table.keys[slot] = key
    table.row[slot] = filled
    return filled


@kernel
def expand(plane: Plane, stage: Stage, states: States, controls: Controls, table: Table, out: States) -> int:
    """out <- the states kept at the end of a stage, as many as it has room for; returns how many."""
    table.keys[:] = EMPTY
    found = table.found
    filled = 0
    k = stage.at.shape[0]
    poses = np.empty((k + 2, 4))
    motion = np.empty(3)
    room = out.cost.shape[0]
    dearest = states.cost.max() + DEAREST * plane.violation_cost
    judged = room  # how many were found when `dearest` was last reckoned
    end = stage.at[k - 1]
    last_step = end - (stage.at[k - 2] if k > 1 else 0.0)
    for s in range(states.cost.shape[0]):
        if states.cost[s] > dearest:
            continue
        rate, branch = states.own[s, 1], states.own[s, 2]
        for c in range(count_of(stage, controls)):
            aim = tried(plane, stage, controls, c, states.own[s], states.pose[s], states.past[s], motion)
            if aim < 0:
                continue
            poses[0] = states.pose[s, 1]
            poses[1] = states.pose[s, 0]
            most = dearest - states.cost[s]
            cost = states.cost[s] + roll(plane, stage, states.own[s], motion, states.past[s], poses, most)
            if not cost <= dearest:
                continue
            rate_there = rate_at(rate, motion[0], motion[1], end)
            if plane.frame == BASE or plane.frame == INNER:
                sign = -branch if motion[2] < NO_NEEDLE else branch
            else:
                sign = branch_of(plane.horizontal, plane.frame, poses[k + 1])
            key = cell(plane, rate_there, sign, poses[k], poses[k + 1], last_step) * AIMS + aim
            at = row_for(table, key, cost, filled)
            if at < 0:
                continue
            filled = max(filled, at + 1)
            found.own[at, 0], found.own[at, 1], found.own[at, 2] = poses[k + 1, plane.frame], rate_there, sign
            found.pose[at, 0] = poses[k + 1]
            found.pose[at, 1] = poses[k]
            found.cost[at] = cost
            found.parent[at] = s
            found.motion[at] = motion
            if filled >= judged + room // 4:  # what is dearer than as many as there is room for is never kept
                dearest = min(dearest, np.partition(found.cost[:filled], room - 1)[room - 1])
                judged = filled
    order = np.argsort(found.cost[:filled])[: out.cost.shape[0]]
    for j in range(order.shape[0]):
        at = order[j]
        out.own[j] = found.own[at]
        out.pose[j] = found.pose[at]
        out.past[j] = last_step
        out.cost[j] = found.cost[at]
        out.parent[j] = found.parent[at]
        out.motion[j] = found.motion[at]
    return int(order.shape[0])


def empty_table() -> Table:
    """A table for `expand` to use again and again."""
    return Table(np.empty(CELLS, np.int64), np.empty(CELLS, np.int64), empty_states(FULL))
