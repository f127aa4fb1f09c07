"""Dynamic programming: the cheapest path of nodes under the rate limits (mathematics, section 8, steps 1 and 2).

Stages lie some 50 ms apart; an edge joins two nodes of neighbouring stages whose angles differ, frame by frame, by no
more than the rate limit allows. The cost is the integral of the rates squared, each as a share of its limit, plus a
rise near the singularity. Windows on the grid keep the work at nodes times neighbours a stage; back-pointers are kept
for a block of stages and the costs at its beginning, so memory does not grow with the flight.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array, Counts, Integers, Progress
from fullpose.charts import TURN
from fullpose.rig import Rig
from fullpose.trajectory.nodes import Lattice, empty_nodes, fill_node, fill_nodes
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.shortest_path_kernels import Copies, Edges, Stage, advance, nearest_crossing, node_costs

REFERENCE_RATE = math.pi  # [rad/s] stands in for the limit, in costs only, where no frame has one
BACK_BYTES = 128 << 20  # of back-pointers held at once
# How far an edge is looked for where no rate limit bounds it: times the body's own rotation, and cells on top.
LOOK, LOOK_CELLS = 10.0, 4.0


@dataclass(frozen=True)
class Avoid:
    """What a node path should stay away from: within `radius` [rad] of `angles` (k, 4) [rad] at `time` (k,) [s]."""

    time: Array
    angles: Array
    radius: float
    cost: float  # [1/s] at the centre


@dataclass(frozen=True)
class NodePath:
    """A way through the stages, or how far one came.

    `angles` (k, 4) [rad] unwrapped, one row a stage; empty where there is none. `reached` stages could be reached;
    `frame`, `limit` (indices of `FRAMES`, `LIMITS`) closed the next one.
    """

    angles: Array
    cost: float
    reached: int
    frame: int = -1
    limit: int = -1

    @property
    def found(self) -> bool:
        """Whether a node path reaches the end."""
        return len(self.angles) > 0


def reference_rates(rig: Rig) -> Array:
    """The rates that costs are measured in: the limits, or the largest of the others where there is none. (4,)"""
    rate = rig.max_rate.copy()
    finite = np.isfinite(rate) & (rig.axes >= 0)
    rate[~finite] = rate[finite].max() if finite.any() else REFERENCE_RATE
    return rate


@dataclass(frozen=True)
class Terms:
    """What counts on a node path beside the options' own costs, and how strictly the limits are taken."""

    slack: float = 0.0  # [rad] that every range and edge is widened by
    avoid: tuple[Avoid, ...] = ()
    margin_gain: float = 1.0  # times the price on the singularity
    stretch: float = 1.0  # times the rate limits that an edge may take,
    violation_cost: float = 0.0  # at this cost of going over one by its whole
    motion: tuple[Array, Array] | None = None  # pose and rates (4,) at the first stage: what inertia allows
    everywhere: bool = False  # whether a frame that no rate limit bounds is looked for all the way round


PLAIN = Terms()


class Programme:
    """The dynamic programme of one flight on one grid; `run` finds the node path."""

    def __init__(
        self, time: Array, attitude: Array, rig: Rig, grid: Lattice, options: PlanOptions, terms: Terms = PLAIN
    ) -> None:
        """time (k,) [s] and attitude (k, 3, 3) of the stages."""
        self.time, self.attitude, self.rig, self.grid = time, attitude, rig, grid
        self.options, self._terms = options, terms
        self._nodes = grid.nodes
        self._copies = Copies(grid.high, grid.wraps, grid.copies, int(np.prod(grid.copies)))
        self._rates = reference_rates(rig)
        longest = float(np.diff(time).max(initial=0.0))
        self._unlimited = longest > 0.0 and bool((rig.max_rate * longest >= math.pi).any())

    def nodes(self, stage: int) -> Stage:
        """The nodes of a stage, those that inertia keeps out of reach marked as dead."""
        nodes = self._all_nodes(stage)
        if self._terms.motion is None:
            return nodes
        gap, reach = self._inertia(stage, nodes.position, self._terms.motion)
        return nodes._replace(alive=nodes.alive & (gap <= reach).all(axis=1))

    def _all_nodes(self, stage: int) -> Stage:
        """The nodes of a stage, whatever inertia allows."""
        nodes = empty_nodes(self.grid.size)
        fill_nodes(self.grid.horizontal, self.attitude[stage], self._nodes, nodes)
        position, alive = nodes.position, nodes.alive
        o = self.options
        cost = np.empty(len(position))
        node_costs(
            position, nodes.measure, self.rig.home, self.grid.wraps.astype(float), o.home_cost,
            o.singularity_margin * self._terms.margin_gain, o.singularity_cost * self._terms.margin_gain, cost,
        )  # fmt: skip
        for avoided in self._terms.avoid:
            if avoided.time[0] <= self.time[stage] <= avoided.time[-1]:
                gap = position - avoided.angles[int(np.searchsorted(avoided.time, self.time[stage]))]
                gap -= TURN * np.rint(gap / TURN)
                near = np.maximum(0.0, 1.0 - np.abs(gap).max(axis=1) / avoided.radius)
                cost += avoided.cost * near
        dt = self.time[min(stage + 1, len(self.time) - 1)] - self.time[max(stage - 1, 0)]
        cost *= 0.5 * dt if len(self.time) > 1 else 1.0
        return Stage(position, cost, alive)

    def _inertia(self, stage: int, position: Array, motion: tuple[Array, Array]) -> tuple[Array, Array]:
        """(gap (m, 4), reach (4,)) [rad]: how far from coasting at the first stage's rates, and how far it may be."""
        pose, rate = motion
        t = self.time[stage] - self.time[0]
        gap = position - (pose + rate * t)
        gap -= np.where(self.grid.wraps, TURN * np.rint(gap / TURN), 0.0)
        reach = 0.5 * np.minimum(self.rig.max_acceleration, 1e6) * t * t + 1.5 * self.grid.step + self._terms.slack
        return np.abs(gap), np.asarray(reach)

    def run(self, start: Array | None = None, progress: Progress | None = None) -> NodePath:
        """The cheapest node path from the nodes next to `start` (4,) [rad], or from any."""
        grid, n = self.grid, len(self.time)
        block = max(64, BACK_BYTES // (4 * grid.states))
        position, cost, alive = self.nodes(0)
        costs = self._first(position, cost, alive, start)
        if not np.isfinite(costs).any():
            return NodePath(np.empty((0, 4)), math.inf, 0, *self._closed_by_position(0))
        checkpoints = [(0, costs, position)]
        back = np.empty((min(block, max(1, n - 1)), grid.states), np.int32)
        for stage in range(1, n):
            if (stage - 1) % block == 0 and stage > 1:
                checkpoints.append((stage - 1, costs, position))
            ahead = self._step(stage, position, costs, back[(stage - 1) % block])
            if ahead is None:
                return NodePath(np.empty((0, 4)), math.inf, stage, *self._closed_by(stage, position, costs))
            position, costs = ahead
            if progress is not None and stage % 64 == 0:
                progress(stage, n)
        final = int(np.argmin(costs))
        path = np.empty(n, np.int64)
        path[-1] = final
        for number in range(len(checkpoints) - 1, -1, -1):
            first, at, where = checkpoints[number]
            last = checkpoints[number + 1][0] if number + 1 < len(checkpoints) else n - 1
            if number + 1 < len(checkpoints):  # these pointers were overwritten: compute them again
                for stage in range(first + 1, last + 1):
                    again = self._step(stage, where, at, back[(stage - 1) % block])
                    if again is None:
                        raise AssertionError("a stage reached before is out of reach now")
                    where, at = again
            for stage in range(last, first, -1):
                path[stage - 1] = back[(stage - 1) % block][path[stage]]
        return NodePath(self._unwrapped(path, start), float(costs[final]), n)

    def _first(self, position: Array, cost: Array, alive: NDArray[np.bool_], start: Array | None) -> Array:
        W = self._copies.total
        costs = np.full((len(position), W), math.inf)
        turns = np.array(np.unravel_index(np.arange(W), self.grid.copies)).T  # (W, 4)
        lifted = position[:, None, :] + TURN * turns[None]
        inside = (lifted <= self.grid.high).all(axis=2) & alive[:, None]
        costs[inside] = np.broadcast_to(cost[:, None], costs.shape)[inside]
        if start is not None:
            gap = lifted - start
            gap -= np.where(self.grid.wraps, TURN * np.rint(gap / TURN), 0.0)
            far = np.abs(gap).max(axis=2)
            near = inside & (far <= 1.5 * self.grid.step + self._terms.slack)
            costs[~near] = math.inf
            costs[near] += far[near]
        return costs.ravel()

    def _reach(self, stage: int) -> Array:
        """How far each frame may be after a stage (4,) [rad]; `bounded` says when less than the limits allow."""
        reach = self.rig.max_rate * (self.time[stage] - self.time[stage - 1])
        if self.bounded:
            turned = self.attitude[stage] @ self.attitude[stage - 1].T
            body = math.acos(min(1.0, max(-1.0, 0.5 * (float(np.trace(turned)) - 1.0))))
            reach = np.where(reach >= math.pi, min(LOOK * body + LOOK_CELLS * self.grid.step, math.pi), reach)
        return np.asarray(np.minimum(reach, 1e3) + self._terms.slack)

    @property
    def bounded(self) -> bool:
        """Whether edges are kept short that the limits do not bound: a node path that is missing then may exist."""
        return self._unlimited and not self._terms.everywhere

    def _step(self, stage: int, position: Array, costs: Array, back: Counts) -> tuple[Array, Array] | None:
        dt = self.time[stage] - self.time[stage - 1]
        ahead, reach = self.nodes(stage), self._reach(stage)
        stretch, cost = self._terms.stretch, float(self._terms.violation_cost)
        edges = Edges(reach, reach * stretch, cost, self.rig.weight / (self._rates**2 * dt))
        after = np.empty_like(costs)
        reached = advance(position, costs, ahead, edges, self._copies, after, back)
        return (ahead.position, after) if reached else None

    def _closed_by_position(self, stage: int) -> tuple[int, int]:
        """(frame, 0): the frame whose range lies farthest from the nearest node of a stage that has none."""
        nodes = empty_nodes(self.grid.size)
        wide = self._nodes._replace(high=np.full(4, math.inf))
        fill_nodes(self.grid.horizontal, self.attitude[stage], wide, nodes)
        outside = nodes.position - self.grid.high
        outside = np.minimum(outside, self.grid.low + TURN - nodes.position)[
            nodes.alive
        ]  # to the nearer end of the range
        best = outside[np.argmin(outside.max(axis=1))]
        return int(np.argmax(best)), 0

    def _closed_by_inertia(self, stage: int) -> tuple[int, int] | None:
        """(frame, 2): whose acceleration keeps it from the nearest node of a stage that has some, but for inertia."""
        if self._terms.motion is None:
            return None
        position, _, alive = self._all_nodes(stage)
        if not alive.any():
            return None
        gap, reach = self._inertia(stage, position[alive], self._terms.motion)
        ratio = gap / reach
        return int(np.argmax(ratio[np.argmin(ratio.max(axis=1))])), 2

    def _closed_by(self, stage: int, position: Array, costs: Array) -> tuple[int, int]:
        ahead = self.nodes(stage)
        if not ahead.alive.any():
            return self._closed_by_inertia(stage) or self._closed_by_position(stage)
        frame, ratio = nearest_crossing(position, costs, ahead, self.grid.wraps, self._reach(stage))
        if ratio <= 1.0:  # only the count of turns kept the edge away: the range, then
            finite = np.isfinite(self.grid.high)
            return int(np.argmax(finite)), 0
        return frame, 1

    def _unwrapped(self, path: Integers, start: Array | None) -> Array:
        """The angles of a path of states (k, 4), continuous, in their counted turns, else the turn nearest home."""
        n, W = len(path), self._copies.total
        angles = np.empty((n, 4))
        turns = np.array(np.unravel_index(path % W, self.grid.copies)).T
        for stage in range(n):
            fill_node(self.grid.horizontal, self.attitude[stage], self._nodes, path[stage] // W, angles[stage])
        angles += TURN * turns
        wraps = self.grid.wraps
        if n > 1:
            steps = np.diff(angles[:, wraps], axis=0)
            steps -= TURN * np.rint(steps / TURN)
            angles[1:, wraps] = angles[0, wraps] + np.cumsum(steps, axis=0)
        if wraps.any():
            target = self.rig.home[wraps] if start is None else start[wraps]
            at = angles[0, wraps]
            angles[:, wraps] += TURN * np.rint((target - at) / TURN)
        return angles
