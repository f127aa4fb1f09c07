"""Paths for a reference of the least tolerance: dense dynamic programming over all frames, their rates kept.

Every frame has its own grid, all poses are nodes (up to `NODES`), and from stage to stage a node follows any in the box
of the rate limits, so that the cheapest is a minimum filter (SciPy's, frame by frame). A stage costs its error to the
sixth. Accelerations are not known here: it gives starts in the classes of paths that the rates allow, no random choice.
"""

import math

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import minimum_filter1d

from bench.numerics.infeasible_flights import Case
from bench.numerics.shooting import limits
from fullpose._typing import Array

STAGE = 0.125  # [s]
FINEST, COARSEST = math.radians(4.0), math.radians(15.0)
NODES = 1_500_000
POWER = 3.0  # of 1 - cos(error): the sixth of the error
FAR = math.pi  # [rad] from the middle that a frame without a range is looked at
APART = 0.6  # [rad] between two paths in some frame


def grid_paths(case: Case, count: int) -> list[Array]:
    """Up to `count` paths (n, 4) [rad] that differ, the cheapest first."""
    n = len(case.time)
    every = max(1, round(STAGE / (case.time[1] - case.time[0])))
    at = np.unique(np.r_[np.arange(0, n, every), n - 1])
    levels, boxes, wrapped = _grid(case)
    shape = tuple(len(each) for each in levels)
    A = np.einsum("bij,ajk->abik", _turns(case, 1, levels), _turns(case, 0, levels)).reshape(-1, 3, 3)
    B = np.einsum("dij,cjk->cdik", _turns(case, 3, levels), _turns(case, 2, levels)).reshape(-1, 9)
    costs = []
    total = None
    for k in at:
        chord = 0.5 * (3.0 - np.einsum("aij,kj->aik", A, case.attitude[k]).transpose(0, 2, 1).reshape(-1, 9) @ B.T)
        stage = (np.maximum(chord, 0.0) ** POWER).astype(np.float32).reshape(shape)
        if total is None:
            total = stage
            if case.start is not None:
                total = np.full(shape, np.inf, np.float32)
                total[tuple(int(np.argmin(np.abs(a - s))) for a, s in zip(levels, case.start, strict=True))] = 0.0
        else:
            for i in range(4):
                if shape[i] > 1:
                    total = minimum_filter1d(total, 2 * boxes[i] + 1, axis=i, mode="wrap" if wrapped[i] else "nearest")
            total = total + stage
        costs.append(total)
    return _traced(case, at, levels, boxes, wrapped, costs, count)


def _grid(case: Case) -> tuple[list[Array], list[int], list[bool]]:
    """(the angles of each frame's grid, how many cells it moves in a stage, whether it goes round)."""
    rig = case.rig
    low, high, rate, _ = limits(rig)
    scale = 1.0
    while True:
        levels, boxes, wrapped = [], [], []
        for i in range(4):
            if rig.axes[i] < 0 or high[i] - low[i] < 1e-3:
                levels.append(np.full(1, 0.0 if rig.axes[i] < 0 else 0.5 * (low[i] + high[i])))
                boxes.append(0)
                wrapped.append(False)
                continue
            round_and_round = not math.isfinite(rig.position_max[i])
            begin, end = (-FAR, FAR) if round_and_round else (max(low[i], -2 * FAR), min(high[i], 2 * FAR))
            step = scale * min(max(rate[i] * STAGE, FINEST), COARSEST)
            cells = max(2, math.ceil((end - begin) / step))
            width = (end - begin) / cells
            levels.append(begin + width * (np.arange(cells) + 0.5))
            boxes.append(min(max(1, int(rate[i] * STAGE / width)), cells // 2))
            wrapped.append(round_and_round)
        if math.prod(len(each) for each in levels) <= NODES:
            return levels, boxes, wrapped
        scale *= 1.1


def _turns(case: Case, frame: int, levels: list[Array]) -> Array:
    """Passive turns (m, 3, 3) of a frame at its angles (m,)."""
    angles, axis = levels[frame], case.rig.axes[frame]
    T = np.tile(np.eye(3), (len(angles), 1, 1))
    if axis >= 0:
        a, b = (axis + 1) % 3, (axis + 2) % 3
        T[:, a, a] = T[:, b, b] = np.cos(angles)
        T[:, a, b], T[:, b, a] = np.sin(angles), -np.sin(angles)
    return T


def _traced(
    case: Case, at: Array, levels: list[Array], boxes: list[int], wrapped: list[bool], costs: list[Array], count: int
) -> list[Array]:  # fmt: skip
    paths: list[Array] = []
    last = costs[-1]
    order = np.argsort(last, axis=None)[: 200 * count]
    for flat in order:
        if len(paths) == count:
            break
        node = np.array(np.unravel_index(flat, last.shape))
        nodes = [node]
        for cost in costs[-2::-1]:
            around = [
                np.arange(node[i] - boxes[i], node[i] + boxes[i] + 1) % len(levels[i])
                if wrapped[i]
                else np.arange(max(0, node[i] - boxes[i]), min(len(levels[i]), node[i] + boxes[i] + 1))
                for i in range(4)
            ]
            part = cost[np.ix_(*around)]
            best = np.unravel_index(int(np.argmin(part)), part.shape)
            node = np.array([each[k] for each, k in zip(around, best, strict=True)])
            nodes.append(node)
        poses = np.stack([[level[k] for level, k in zip(levels, node, strict=True)] for node in nodes[::-1]])
        for i in range(4):
            if wrapped[i]:
                poses[:, i] = np.unwrap(poses[:, i])
        path = np.asarray(CubicSpline(case.time[at], poses)(case.time))
        if all(np.abs(path - other).max() > APART for other in paths):
            paths.append(path)
    return paths
