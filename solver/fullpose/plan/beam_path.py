"""Node paths that know the accelerations: the beam search over a whole flight, piece by piece.

The dynamic programme knows rates only. Where each frame needs most of its acceleration, its cheapest node path asks for
turns that the frames are too heavy for, and the refinement, which is local, stays caught between them. This search
decides the way and the inertia together; it is wide but not complete, so it proves nothing.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array, Progress
from fullpose.charts import TURN
from fullpose.limits import limit_table
from fullpose.rig import Rig
from fullpose.trajectory.beam_search import Stages, Start, search
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.nodes import NARROW, empty_nodes, fill_nodes, lattice
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.stage_cost import Costs

PIECE = 20.0  # [s] decided at once; bounds the memory, and the time until a cancel is heard
FORESIGHT = 5.0  # [s] looked at beyond a piece before it is decided
FIRST_GRID = math.radians(10.0)  # between the poses that a free start is tried from
NARROW_GRID = math.radians(1.0)  # the same for a range that the coarse grid may step over
TURNS_APART = 1.5  # turns from home within which a free start is tried, of frames that have several
SINGULARITY_COST, RANGE_COST, VIOLATION_COST = 0.3, 0.1, 1e3  # [1/s], as `preview` has them but for the range


@dataclass(frozen=True)
class Breadth:
    """How widely to search, and what accelerations cost beside rates."""

    beam: int  # states kept a stage
    slides: int  # tried from each
    acceleration_cost: float


# Measured (python -m bench.numerics.plan_known): what one of them misses the next ones mostly find.
BREADTHS = (Breadth(1000, 5, 1.0), Breadth(4000, 9, 0.1), Breadth(4000, 9, 1.0))


def beam_path(stages: Problem, breadth: Breadth, first: Start, progress: Progress | None = None) -> Array:
    """Poses (k, 4) [rad], continuous, at the k samples of `stages`; the limits exceeded least.

    progress(done, total) after each piece.
    """
    time, attitude, rig = stages.time, stages.attitude, stages.rig
    n = len(time)
    home = float(stages.options.home_cost)
    costs = Costs(1.0, breadth.acceleration_cost, SINGULARITY_COST, RANGE_COST, VIOLATION_COST, home)
    table = limit_table(rig)
    node_path = np.empty((n, 4))
    begin = 0
    while True:
        left = time[-1] - time[begin]
        end = n if left <= PIECE + 2.0 * FORESIGHT else int(np.searchsorted(time, time[begin] + PIECE + FORESIGHT))
        following = n - 1 if end == n else max(begin + 1, int(np.searchsorted(time, time[begin] + PIECE)))
        end = max(end, following + 1)
        piece = np.empty((end - begin, 4))
        part = Stages(time[begin:end], attitude[begin:end], np.ones(end - begin))
        search(
            rig.geometry.horizontal, table, costs, part, first, breadth.slides, breadth.beam, piece,
        )  # fmt: skip
        node_path[begin : following + 1] = piece[: following + 1 - begin]
        if progress is not None:
            progress(following + 1, n)
        if end == n:
            return node_path
        past = float(time[following] - time[following - 1])
        pose, before = node_path[following : following + 1], node_path[following - 1 : following]
        first = Start(pose.copy(), (pose - before) / past, past)
        begin = following


def first_poses(attitude: Array, rig: Rig) -> Array:
    """Exact poses (m, 4) [rad] for attitude (3, 3) inside the ranges, on a coarse grid, in the turns next to home."""
    span = (rig.position_max - rig.position_min)[list(rig.geometry.frames)]
    grid = lattice(rig, FIRST_GRID if span.min() > NARROW * FIRST_GRID else NARROW_GRID)
    nodes = empty_nodes(grid.size)
    fill_nodes(grid.horizontal, attitude, grid.nodes, nodes)
    poses = nodes.position[nodes.alive]
    wraps = grid.wraps
    poses[:, wraps] += TURN * np.rint((rig.home[wraps] - poses[:, wraps]) / TURN)
    for frame in np.flatnonzero(np.isfinite(rig.position_max) & (rig.position_max - rig.position_min >= TURN)).tolist():
        turned = [poses + TURN * turn * np.eye(4)[frame] for turn in (-2, -1, 0, 1, 2)]
        poses = np.concatenate([p[np.abs(p[:, frame] - rig.home[frame]) <= TURNS_APART * TURN] for p in turned])
        poses = poses[(poses[:, frame] >= rig.position_min[frame]) & (poses[:, frame] <= rig.position_max[frame])]
    return np.ascontiguousarray(poses)


def attainable_rates(attitude: Array, interval: float, rig: Rig, poses: Array, rate: Array) -> Array:
    """The rates (m, 4) [rad/s] over the first interval [s] that come closest to `rate` (4,) from exact `poses` (m, 4).

    attitude (3, 3) is the second sample's: what it asks of the frames is not free, only the component of the rate
    along the self-motion is.
    """
    moved = poses + interval * rate
    closest_all(rig.axes, rig.geometry.horizontal, np.repeat(attitude[None], len(poses), axis=0), moved)
    return np.asarray((moved - poses) / interval)
