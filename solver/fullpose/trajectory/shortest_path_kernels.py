"""Kernels of the dynamic programme: one stage of it, the costs of nodes, the edge that is least over its reach."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import inlined, kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.charts import TURN


class Stage(NamedTuple):
    """The nodes of one instant, and what each of them costs."""

    position: Array  # (4G, 4) [rad]
    cost: Array  # (4G,)
    alive: NDArray[np.bool_]  # (4G,)


class Edges(NamedTuple):
    """What an edge between two stages may span, and its price."""

    reach: Array  # (4,) [rad] what the rate limits allow
    window: Array  # (4,) [rad] what is taken, `excess` paid for each (overrun as a share of the reach)^2
    violation_cost: float
    weight: Array  # (4,) [1/rad^2] of the way squared


class Copies(NamedTuple):
    """Which frames' turns are told apart. States are node * prod(copies) + copy."""

    high: Array  # (4,) [rad]
    wraps: NDArray[np.bool_]  # (4,) frames whose turns are not counted
    each: Integers  # (4,)
    total: int  # copies, of all frames together


@inlined
def edge_cost(
    edges: Edges, copies: Copies, before: Array, i: int, after: Array, j: int, cost: float, shift: Integers
) -> float:
    """`cost` plus that of the edge from position before[i] to after[j], infinite where it is too long.

    before, after (4G, 4) [rad]; shift (4,) <- the turns it goes up.
    """
    for k in range(4):
        gap = after[j, k] - before[i, k]
        turned = 0.0
        if gap > math.pi or gap < -math.pi:
            turned = np.rint(gap / TURN)
            gap -= TURN * turned
        size = abs(gap)
        if size > edges.window[k]:
            return np.inf
        shift[k] = 0 if copies.wraps[k] else int(turned)
        cost += edges.weight[k] * size * size
        if size > edges.reach[k]:
            violation = size / edges.reach[k] - 1.0
            cost += edges.violation_cost * violation * violation
    return cost


@inlined
def shifted(copy: int, shift: Integers, copies: Integers) -> int:
    """The copy that lies `shift` (4,) turns from `copy`; -1 where there is none."""
    c3 = copy % copies[3] + shift[3]
    rest = copy // copies[3]
    c2 = rest % copies[2] + shift[2]
    rest //= copies[2]
    c1 = rest % copies[1] + shift[1]
    c0 = rest // copies[1] + shift[0]
    if c0 < 0 or c1 < 0 or c2 < 0 or c3 < 0:
        return -1
    if c0 >= copies[0] or c1 >= copies[1] or c2 >= copies[2] or c3 >= copies[3]:
        return -1
    return int(((c0 * copies[1] + c1) * copies[2] + c2) * copies[3] + c3)


@inlined
def in_range(position: Array, j: int, copy: int, copies: Copies) -> bool:
    """Whether node j is inside its ranges in that copy; position (4G, 4) [rad] is the lowest one's."""
    inside = True
    for k in range(3, -1, -1):
        if position[j, k] + TURN * (copy % copies.each[k]) > copies.high[k]:
            inside = False
        copy //= copies.each[k]
    return inside


@inlined
def relax(
    cost0: Array, i: int, cost1: Array, j: int, back: Counts, edge: float, shift: Integers, copies: Copies
) -> None:
    """cost1, back <- for the states of node j that the edge from node i, `shift` turns up, makes cheaper."""
    W = copies.total
    if W == 1:
        if shift[0] == 0 and shift[1] == 0 and shift[2] == 0 and shift[3] == 0:
            total = cost0[i] + edge
            if total < cost1[j]:
                cost1[j] = total
                back[j] = i
        return
    for w in range(W):
        copy = shifted(w, shift, copies.each)
        if copy < 0:
            continue
        total = cost0[i * W + copy] + edge
        if total < cost1[j * W + w]:
            cost1[j * W + w] = total
            back[j * W + w] = i * W + copy


@kernel
def open_nodes(cost: Array, count: int) -> NDArray[np.bool_]:
    """(count,) the nodes that have a state which was reached; cost (states,)."""
    W = cost.shape[0] // count
    found = np.zeros(count, np.bool_)
    for i in range(count):
        for w in range(W):
            if cost[i * W + w] < np.inf:
                found[i] = True
                break
    return found


@inlined
def points_within(span: float, G: int) -> int:
    """Grid points to either side that lie within `span` [rad] of an angle."""
    half = G // 2
    return half if span >= math.pi else min(half, math.ceil(span / (TURN / G)) + 1)


@kernel
def advance(
    position0: Array, cost0: Array, stage: Stage, edges: Edges, copies: Copies, cost1: Array, back: Counts
) -> int:
    """One stage of the programme: cost1, back <- the best predecessor of every state; returns how many were reached.

    position0 (4G, 4) [rad] and cost0 (states,) are of the stage before.
    """
    # Out of the loops: to take an array from a tuple counts its owners.
    position1 = stage.position
    node_cost = stage.cost
    alive1 = stage.alive
    window = edges.window
    N = position1.shape[0]
    W = copies.total
    G = N // 4
    step = TURN / G
    open0 = open_nodes(cost0, N)
    shift = np.empty(4, np.int64)
    reached = 0
    for j in range(N):
        for w in range(W):
            cost1[j * W + w] = np.inf
            back[j * W + w] = -1
        if not alive1[j]:
            continue
        for chart in range(2):
            kept = 0 if chart == 0 else 3
            radius = points_within(window[kept], G)
            centre = int(np.rint((position1[j, kept] + math.pi) / step))
            last = radius if 2 * radius + 1 <= G else G - 1 - radius
            for offset in range(-radius, last + 1):
                g = (centre + offset) % G
                for branch in range(2):
                    i = (2 * chart + branch) * G + g
                    if not open0[i]:
                        continue
                    edge = edge_cost(edges, copies, position0, i, position1, j, node_cost[j], shift)
                    if edge < np.inf:
                        relax(cost0, i, cost1, j, back, edge, shift, copies)
        for w in range(W):
            if W > 1 and not in_range(position1, j, w, copies):
                cost1[j * W + w] = np.inf
            if cost1[j * W + w] < np.inf:
                reached += 1
    return reached


@kernel
def node_costs(
    position: Array, measure: Array, home: Array, free: Array, home_cost: float, margin: float, rise: float, out: Array
) -> None:
    """out (4G,) <- what a second on a node costs: far from home (4,), and below `margin` of the measure, up to `rise`.

    free (4,): above 0 for a frame whose turns do not count.
    """
    for i in range(position.shape[0]):
        total = 0.0
        for k in range(4):
            gap = position[i, k] - home[k]
            if free[k] > 0.0:
                gap -= TURN * np.rint(gap / TURN)
            total += home_cost * gap * gap
        if measure[i] < margin:
            deficit = 1.0 - measure[i] / margin
            total += rise * deficit * deficit
        out[i] = total


@kernel
def nearest_crossing(
    position0: Array, cost0: Array, stage: Stage, wraps: NDArray[np.bool_], reach: Array
) -> tuple[int, float]:
    """(frame, ratio): of all edges between open and living nodes, the one least over its reach, and its worst frame."""
    N = stage.position.shape[0]
    open0 = open_nodes(cost0, N)
    best = np.inf
    which = -1
    for i in range(N):
        if not open0[i]:
            continue
        for j in range(N):
            if not stage.alive[j]:
                continue
            largest = 0.0
            frame = -1
            for k in range(4):
                gap = stage.position[j, k] - position0[i, k]
                if wraps[k]:
                    gap -= TURN * np.rint(gap / TURN)
                ratio = abs(gap) / reach[k]
                if ratio > largest:
                    largest = ratio
                    frame = k
                if largest >= best:
                    break
            if largest < best:
                best = largest
                which = frame
    return which, best
