"""The search for one flight's path: node paths, the smooth curve along one, its refinement, others where it failed."""

import math

import numpy as np

from fullpose._typing import Array, Progress
from fullpose.plan.beam_path import BREADTHS, attainable_rates, beam_path, first_poses
from fullpose.plan.fallback import EXACT_ERROR, Fallback
from fullpose.plan.three_axis import turns_into_range
from fullpose.rig import Rig
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.shortest_path import Avoid, NodePath, Programme
from fullpose.trajectory.sqp import MET, locked, missed_rate
from fullpose.trajectory.windows import Path, overrun, refine_path, smooth_curve, stage_samples
from fullpose.verify import attitude_errors, payload_attitudes

AVOID_RADIUS = math.radians(30.0)
AVOID_COST = 5.0  # [1/s], beside rates squared as shares of their limits
AVOID_TIME = 0.4  # [s] before and after
WIDE_SECONDS = 600.0  # of a flight that is searched widely: up to a tenth of its length each time


class Search:
    """One flight's search for a path; keeps what the attempts share."""

    def __init__(
        self, time: Array, attitude: Array, rig: Rig, start: Array | None, start_rate: Array | None,
        options: PlanOptions, progress: Progress | None,
    ) -> None:  # fmt: skip
        self.time, self.attitude, self.rig, self.options, self.progress = time, attitude, rig, options, progress
        self.start = start
        self.start_rate = start_rate
        if start is not None and start_rate is not None:  # what the attitude leaves of it
            interval = float(time[1] - time[0])
            self.start_rate = attainable_rates(attitude[1], interval, rig, start[None], start_rate)[0]
        self.counted = np.zeros(4, np.bool_)
        self.avoid: list[Avoid] = []
        self.margin_gain = 1.0
        self.node_paths = 0
        self.samples = stage_samples(time, options.stage)
        self.fallback = Fallback(time, attitude, rig, start)

    def node_path(self, grid: float, slack: float = 0.0, stretch: float = 1.0, excess: float = 0.0) -> NodePath:
        """The cheapest node path on a grid [rad]; turns of wide frames counted only as far as their ranges need it."""
        low, high = self.rig.position_min, self.rig.position_max
        while True:
            programme = Programme(
                self.time[self.samples], self.attitude[self.samples], self.rig,
                lattice(self.rig, grid, self.counted, slack), self.options, slack,
            )  # fmt: skip
            programme.avoid = self.avoid
            programme.margin_gain = self.margin_gain
            if self.start is not None and self.start_rate is not None:
                programme.motion = self.start, self.start_rate
            programme.stretch, programme.excess = stretch, excess
            node_path = programme.run(self.start, self._report(0.0, 0.5))
            if not node_path.found and programme.bounded:  # the verdict rests on all that the limits allow
                programme.everywhere = True
                node_path = programme.run(self.start, self._report(0.0, 0.5))
            if not node_path.found:
                return node_path
            angles = node_path.angles
            free = np.isfinite(high) & (high - low >= 2.0 * math.pi) & ~self.counted
            if self.start is None and free.any():
                shift = np.zeros(4)
                shift[free] = turns_into_range(angles[:, free], low[free], high[free])
                angles += shift
            outside = free & ((angles.min(axis=0) < low - slack) | (angles.max(axis=0) > high + slack))
            if not outside.any():
                return node_path
            self.counted |= outside

    def curve(self, node_path: NodePath) -> Array:
        """The smooth exact path along a node path (n, 4) [rad]."""
        return smooth_curve(self.time, self.attitude, self.rig, self.samples, node_path, self.start)

    def refine(self, node_path: NodePath) -> Path:
        """A path along a node path."""
        self.node_paths += 1
        return self._refined(self.curve(node_path))

    def refine_step(self, way: Array) -> Path | None:
        """A path next to one of `fallback`, or that itself; None where it is not exact, or a start rate is asked for.

        No flight is refused that a method flies which looks at less of it.
        """
        error, _ = attitude_errors(payload_attitudes(self.rig, way), self.attitude)
        if self.start_rate is not None or error.max() > EXACT_ERROR or overrun(self.time, way, self.rig)[0] > MET:
            return None
        path = self._refined(way.copy())
        if overrun(self.time, path.angles, self.rig)[0] <= MET:
            return path
        return Path(way.copy(), (), np.zeros(len(way), np.int32))

    def _refined(self, angles: Array) -> Path:
        return refine_path(
            self.time, self.attitude, angles, self.rig, self.options, start=self.start is not None,
            start_rate=self.start_rate, progress=self._report(0.5, 0.5),
        )  # fmt: skip

    def missed(self, path: Path) -> float:
        """How far a path is from the start rate asked for: `missed_rate`; 0 where none was."""
        if self.start_rate is None:
            return 0.0
        return missed_rate(self.time, path.angles, self.rig, self.start_rate)

    def steer_away(self, path: Path) -> None:
        """Make the places where a path failed dear to the node paths to come."""
        for failure in path.failures:
            reach = max(AVOID_TIME, self.options.stage)
            first = float(self.time[failure.sample]) - reach
            part = slice(*np.searchsorted(self.time, (first, first + 2.0 * reach)))
            self.avoid.append(Avoid(self.time[part], path.angles[part].copy(), AVOID_RADIUS, AVOID_COST))

    def alternative(self, attempt: int, grid: float, slack: float) -> NodePath:
        """Another node path, after some have failed; attempt from 1 on.

        First without a price on the singularity: a flight that must pass through it is better off going straight.
        Then those that know the accelerations, ever wider. Then away from the places that failed; then on a grid twice
        as fine with stages half as far apart; then with four times the price on the singularity; then ever farther
        away from the places that failed.
        """
        if 2 <= attempt < 2 + len(BREADTHS):
            return self._beam_path(attempt - 2)
        avoid = self.avoid
        number = attempt if attempt == 1 else attempt - len(BREADTHS)
        self.margin_gain = 0.0 if number == 1 else 4.0 if number == 4 else 1.0
        if number in (1, 4):
            self.avoid = []
        if number == 3 and grid > self.options.fine_grid:
            self.samples = stage_samples(self.time, 0.5 * self.options.stage)
            self.avoid = []
            grid = 0.5 * grid
        node_path = self.node_path(grid, slack)
        self.avoid = avoid
        return node_path

    def _beam_path(self, number: int) -> NodePath:
        """The node path of one of `BREADTHS`; none where there is no freedom, or the flight too long for a wide one."""
        none = NodePath(np.empty((0, 4)), math.inf, 0)
        time, attitude = self.time[self.samples], np.ascontiguousarray(self.attitude[self.samples])
        if len(time) < 2 or locked(self.rig) or (number > 0 and time[-1] - time[0] > WIDE_SECONDS):
            return none
        first = first_poses(attitude[0], self.rig) if self.start is None else self.start[None].copy()
        if not len(first):
            return none
        first_rate, past = np.zeros_like(first), 0.0
        if self.start_rate is not None:
            past = float(self.time[1] - self.time[0])
            first_rate = attainable_rates(self.attitude[1], past, self.rig, first, self.start_rate)
        poses = beam_path(
            time, attitude, self.rig, self.options, BREADTHS[number], first, first_rate, past, self._report(0.0, 0.5)
        )
        return NodePath(poses, math.nan, len(time))

    def _report(self, begin: float, share: float) -> Progress | None:
        if self.progress is None:
            return None
        n, tell = len(self.time), self.progress

        def report(done: int, total: int) -> None:
            tell(min(n - 1, int(n * (begin + share * done / total))), n)

        return report
