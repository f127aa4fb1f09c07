"""A beam search in the plane of time and base angle (mathematics, section 14).

A state is the base angle, its rate and the branch (the sign of cos d3); the base chart gives the other frames. From
each, constant accelerations of the base are tried for a stage, and, where the stage holds a needle, cubics that run
exactly through it and so change the branch. Of the states that reach one cell of angle, rate, branch and turns the
cheapest is kept, and of the cells the cheapest `breadth`. The frames' rates and accelerations are differenced at the
fine samples of the stage.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import inlined, inner, kernel
from fullpose._typing import Array, Integers
from fullpose.charts import TURN, base_chart, turn_to
from fullpose.limits import ACCELERATION, MAX, MIN, RATE
from fullpose.trajectory.plane_motion import NO_NEEDLE, SOFT, Controls, Plane, Stage, base_at, count_of, rate_at, tried

VIOLATION_COST = 30.0  # [1/s] of a limit exceeded e times
EFFORT_COST = 1.0  # [1/s] of accelerations as shares of their limits, squared
RANGE_UNIT = math.radians(0.3)  # outside a range by which costs as much as a limit exceeded twice
CELL = math.radians(4.0)  # [rad] of base angle
CELLS = 1 << 16  # of the table
FULL = CELLS // 2  # states that it takes, more than are ever found
PROBES = 64
AIMS = 67  # a prime above the numbers that tell apart what is aimed at
EMPTY = -(1 << 62)  # the key of a slot that holds nothing


class States(NamedTuple):
    """States at the end of a stage."""

    base: Array  # (w, 3): angle [rad], rate [rad/s], branch
    pose: Array  # (w, 2, 4) [rad] at the last fine sample and at the one before
    past: Array  # (w,) [s] between those two; 0: the one before is not known
    cost: Array  # (w,)
    parent: Integers  # (w,)
    motion: (
        Array  # (w, 3): that led to it: second and third derivative of the base where it begins, and the needle's time
    )


def empty_states(width: int) -> States:
    """Room for `width` states."""
    return States(
        np.empty((width, 3)), np.empty((width, 2, 4)), np.zeros(width), np.empty(width), np.zeros(width, np.int64),
        np.zeros((width, 3)),
    )  # fmt: skip


@inlined
def limit_cost(share: float) -> float:
    """The cost of a share of a limit."""
    return VIOLATION_COST * math.log(share / SOFT) if share > SOFT else 0.0


@inner
def sample_cost(table: Array, before: Array, here: Array, there: Array, past: float, ahead: float) -> float:
    """The cost of going from here to there (4,) [rad] in `ahead` [s], from `before` in `past` (0: not known)."""
    cost = 0.0
    for i in range(4):
        rate = (there[i] - here[i]) / ahead
        cost += limit_cost(abs(rate) / table[RATE, i])
        if past > 0.0:
            share = abs(rate - (here[i] - before[i]) / past) / (0.5 * (past + ahead) * table[ACCELERATION, i])
            cost += limit_cost(share) + EFFORT_COST * min(share * share, 1.0)
        outside = max(table[MIN, i] - there[i], there[i] - table[MAX, i])
        if outside > 0.0:
            cost += VIOLATION_COST * math.log1p(outside / RANGE_UNIT)
    return cost


@inner
def roll(plane: Plane, stage: Stage, base: Array, motion: Array, past: float, poses: Array, most: float) -> float:
    """poses[2:] <- the frames at the stage's fine samples; poses[:2] (4,) are where they come from.

    base (3,) of the state, motion (3,), past [s] between poses[0] and poses[1]. Returns the cost, of which no more is
    reckoned than to find that it is above `most`.
    """
    cost = 0.0
    come = past
    last = 0.0
    for k in range(stage.at.shape[0]):
        at = stage.at[k]
        here = poses[k + 1]
        there = poses[k + 2]
        branch = -base[2] if at > motion[2] else base[2]
        base_chart(
            plane.horizontal, stage.attitude[k], base_at(base[0], base[1], motion[0], motion[1], at), branch, there
        )
        turn_to(there, there[0], here[1], here[2], here[3])
        ahead = at - last
        cost += ahead * sample_cost(plane.table, poses[k], here, there, come, ahead)
        if cost > most:
            return float(cost)
        come = ahead
        last = at
    return float(cost)


@inner
def cell(plane: Plane, rate: float, branch: float, before: Array, pose: Array, past: float) -> int:
    """The number of a state's cell: pose (4,) [rad], the one `past` [s] before, and the base's rate [rad/s]."""
    angle = pose[0]
    number = math.floor(angle / CELL)
    if plane.base_wraps:
        number = number % round(TURN / CELL)
    key = int(number) * 4099 + math.floor(rate / plane.rate_cell[0] + 0.5)
    key = key * 2 + (1 if branch > 0.0 else 0)
    for i in range(1, 4):
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
        states.base[:count].copy(), states.pose[:count].copy(), states.past[:count].copy(), states.cost[:count].copy(),
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
    dearest = states.cost.max() + 2.0 * VIOLATION_COST
    end = stage.at[k - 1]
    last_step = end - (stage.at[k - 2] if k > 1 else 0.0)
    for s in range(states.cost.shape[0]):
        rate, branch = states.base[s, 1], states.base[s, 2]
        for c in range(count_of(stage, controls)):
            aim = tried(plane, stage, controls, c, states.base[s], states.pose[s], states.past[s], motion)
            if aim < 0:
                continue
            poses[0] = states.pose[s, 1]
            poses[1] = states.pose[s, 0]
            most = dearest - states.cost[s]
            cost = states.cost[s] + roll(plane, stage, states.base[s], motion, states.past[s], poses, most)
            if not cost <= dearest:
                continue
            rate_there = rate_at(rate, motion[0], motion[1], end)
            sign = -branch if motion[2] < NO_NEEDLE else branch
            key = cell(plane, rate_there, sign, poses[k], poses[k + 1], last_step) * AIMS + aim
            at = row_for(table, key, cost, filled)
            if at < 0:
                continue
            filled = max(filled, at + 1)
            found.base[at, 0], found.base[at, 1], found.base[at, 2] = poses[k + 1, 0], rate_there, sign
            found.pose[at, 0] = poses[k + 1]
            found.pose[at, 1] = poses[k]
            found.cost[at] = cost
            found.parent[at] = s
            found.motion[at] = motion
    order = np.argsort(found.cost[:filled])[: out.cost.shape[0]]
    for j in range(order.shape[0]):
        at = order[j]
        out.base[j] = found.base[at]
        out.pose[j] = found.pose[at]
        out.past[j] = last_step
        out.cost[j] = found.cost[at]
        out.parent[j] = found.parent[at]
        out.motion[j] = found.motion[at]
    return int(order.shape[0])


def empty_table() -> Table:
    """A table for `expand` to use again and again."""
    return Table(np.empty(CELLS, np.int64), np.empty(CELLS, np.int64), empty_states(FULL))
