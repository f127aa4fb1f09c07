"""Kernels of the dynamic programme: one stage of it, the costs of nodes, the frontier, and one node alone."""

import math

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.charts import TURN
from fullpose.trajectory.nodes import fill_nodes


@kernel
def advance(
    position0: Array,
    cost0: Array,
    position1: Array,
    alive1: NDArray[np.bool_],
    node_cost: Array,
    reach: Array,
    stretch: float,
    excess: float,
    weight: Array,
    high: Array,
    wraps: NDArray[np.bool_],
    copies: Integers,
    cost1: Array,
    back: Counts,
) -> int:
    """One stage of the programme: cost1, back <- the best predecessor of every state; returns how many were reached.

    States are node * prod(copies) + copy. reach (4,) [rad] is what the rate limits allow in the stage; up to
    `stretch` times as much is taken at the price of `excess` per (overrun as a share)^2. weight (4,) [1/rad^2].
    """
    N = position1.shape[0]
    G = N // 4
    step = TURN / G
    W = cost1.shape[0] // N
    stride3 = 1
    stride2 = copies[3]
    stride1 = stride2 * copies[2]
    stride0 = stride1 * copies[1]
    half = G // 2
    radius = np.empty(2, np.int64)
    window = np.empty(4)
    for k in range(4):
        window[k] = reach[k] * stretch
    for chart in range(2):
        span = window[0] if chart == 0 else window[3]
        radius[chart] = half if span >= math.pi else min(half, math.ceil(span / step) + 1)
    open0 = np.empty(N, np.bool_)
    for i in range(N):
        open0[i] = False
        for w in range(W):
            if cost0[i * W + w] < np.inf:
                open0[i] = True
                break
    shift = np.empty(4, np.int64)
    reached = 0
    for j in range(N):
        for w in range(W):
            cost1[j * W + w] = np.inf
            back[j * W + w] = -1
        if not alive1[j]:
            continue
        for chart in range(2):
            angle = position1[j, 0] if chart == 0 else position1[j, 3]
            centre = int(np.rint((angle + math.pi) / step))
            last = radius[chart]
            if 2 * last + 1 > G:
                last = G - 1 - radius[chart]
            for offset in range(-radius[chart], last + 1):
                g = (centre + offset) % G
                for branch in range(2):
                    i = (2 * chart + branch) * G + g
                    if not open0[i]:
                        continue
                    edge = node_cost[j]
                    near = True
                    for k in range(4):
                        gap = position1[j, k] - position0[i, k]
                        turns = 0.0
                        if gap > math.pi or gap < -math.pi:
                            turns = np.rint(gap / TURN)
                            gap -= TURN * turns
                        size = abs(gap)
                        if size > window[k]:
                            near = False
                            break
                        shift[k] = 0 if wraps[k] else int(turns)
                        edge += weight[k] * size * size
                        if size > reach[k]:
                            over = size / reach[k] - 1.0
                            edge += excess * over * over
                    if not near:
                        continue
                    if W == 1:
                        if shift[0] == 0 and shift[1] == 0 and shift[2] == 0 and shift[3] == 0:
                            total = cost0[i] + edge
                            if total < cost1[j]:
                                cost1[j] = total
                                back[j] = i
                        continue
                    for w in range(W):
                        c0 = w // stride0 + shift[0]
                        c1 = (w // stride1) % copies[1] + shift[1]
                        c2 = (w // stride2) % copies[2] + shift[2]
                        c3 = w % copies[3] + shift[3]
                        if c0 < 0 or c1 < 0 or c2 < 0 or c3 < 0:
                            continue
                        if c0 >= copies[0] or c1 >= copies[1] or c2 >= copies[2] or c3 >= copies[3]:
                            continue
                        v = i * W + c0 * stride0 + c1 * stride1 + c2 * stride2 + c3 * stride3
                        total = cost0[v] + edge
                        if total < cost1[j * W + w]:
                            cost1[j * W + w] = total
                            back[j * W + w] = v
        for w in range(W):
            if cost1[j * W + w] < np.inf:
                if W > 1:
                    rest = w
                    for k in range(4):
                        stride = stride0 if k == 0 else stride1 if k == 1 else stride2 if k == 2 else stride3
                        turn = rest // stride
                        rest -= turn * stride
                        if position1[j, k] + TURN * turn > high[k]:
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
            short = 1.0 - measure[i] / margin
            total += rise * short * short
        out[i] = total


@kernel
def nearest_crossing(
    position0: Array, cost0: Array, position1: Array, alive1: NDArray[np.bool_], wraps: NDArray[np.bool_], reach: Array
) -> tuple[int, float]:
    """(frame, ratio): of all edges between open and living nodes, the one least over its reach, and its worst frame."""
    N = position1.shape[0]
    W = cost0.shape[0] // N
    best = np.inf
    which = -1
    for i in range(N):
        is_open = False
        for w in range(W):
            if cost0[i * W + w] < np.inf:
                is_open = True
        if not is_open:
            continue
        for j in range(N):
            if not alive1[j]:
                continue
            worst = 0.0
            frame = -1
            for k in range(4):
                gap = position1[j, k] - position0[i, k]
                if wraps[k]:
                    gap -= TURN * np.rint(gap / TURN)
                ratio = abs(gap) / reach[k]
                if ratio > worst:
                    worst = ratio
                    frame = k
                if worst >= best:
                    break
            if worst < best:
                best = worst
                which = frame
    return which, best


@kernel
def single(
    horizontal: bool, C: Array, chart_branch: int, cosine: float, sine: float, g: int, G: int, low: Array, d: Array
) -> None:
    """d <- the one node of index (chart_branch, g); as `fill_nodes` has it."""
    position = np.empty((4, 4))
    measure = np.empty(4)
    alive = np.empty(4, np.bool_)
    cosines = np.empty(1)
    sines = np.empty(1)
    cosines[0] = cosine
    sines[0] = sine
    high = np.full(4, np.inf)
    fill_nodes(horizontal, C, cosines, sines, low, high, position, measure, alive)
    # A grid of one point is labelled -pi: put the chart's own angle back.
    frame = 0 if chart_branch < 2 else 3
    angle = -math.pi + TURN / G * g
    for k in range(4):
        d[k] = position[chart_branch, k]
    gap = angle - low[frame]
    d[frame] = low[frame] + gap - TURN * math.floor(gap / TURN)
