"""The way ahead of a rig in motion: what `preview` is told to weigh, the job that finds a way, and the way found.

A job is frozen and picklable, and its `run` may be called in any thread or process. It searches
(`fullpose.trajectory.beam_search`), which decides the way round, and then refines what was found
(`fullpose.trajectory.sqp`), as `plan` does with a whole flight: the search moves in coarse slides, and what it jerks
the refinement smooths inside the same limits.

Source: mathematics, section 9.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.limits import limit_table
from fullpose.preview.options import PreviewOptions
from fullpose.preview.prediction import attitudes_ahead
from fullpose.rig import Rig
from fullpose.trajectory.beam_search import Stages, Start, search
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.sqp import Boundary, refine
from fullpose.trajectory.stage_cost import Costs

START_BEAM = 1000  # states kept a stage then: the way begins anywhere
HOME_COST = 1e-3  # [1/(rad^2 s)]: decides where nothing else does
ROOM_FOR = math.radians(60.0)  # [rad/s] body rate that room is measured against
FIT_WINDOW = 0.1  # [s] of attitude that the present body rate is taken from


@dataclass(frozen=True)
class Ahead:
    """A way over the horizon: time (k,) [s], pose (k, 4) [rad], rate (k, 4) [rad/s]."""

    number: int
    time: Array
    pose: Array
    rate: Array
    known: int  # stages whose attitude was known and not predicted
    lost_at: float  # [s] when it foresees a limit in the way of the attitude; inf: not within the horizon

    def __post_init__(self) -> None:
        # One type of array for the kernels whether it was made here or came through a pickle.
        for name in ("time", "pose", "rate"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.float64, order="C"))


@dataclass(frozen=True)
class Replan:
    """A job: the motion now and what is known of the attitude. Picklable; `run` touches nothing else."""

    number: int
    tight: Rig  # the rig, less the reserve of its accelerations
    options: PreviewOptions
    clock: float  # [s]
    pose: Array  # (m, 4) [rad] now; several where the start is free
    rate: Array  # (m, 4) [rad/s]
    past: float  # [s] the interval of that rate; 0: any rate may follow
    known_time: Array
    known_attitude: Array

    def run(self) -> Ahead:
        """Find the way."""
        time, pose, known, first_violation = self.stages()
        knots, position, rate = smooth_reference(time, pose, self.rate[0] if self.past > 0.0 else None)
        if first_violation == len(time) and self.past > 0.0 and self.options.smoothing:
            knots, position, rate = smooth_reference(knots, self._refined(knots, position, rate[0]), rate[0])
        lost_at = float(time[first_violation]) if first_violation < len(time) else math.inf
        return Ahead(self.number, knots, position, rate, known, lost_at)

    def _refined(self, time: Array, pose: Array, rate: Array) -> Array:
        """The way smoothed on its knots (k, 4) [rad], from the same pose and rate to the same end."""
        o = self.options
        attitude = np.empty((len(time), 3, 3))
        attitudes_ahead(self.known_time, self.known_attitude, time, FIT_WINDOW, o.settling_s, 0.5 * o.stage_s, attitude)
        d = pose.copy()
        closest_all(self.tight.axes, self.tight.geometry.horizontal, attitude, d)
        problem = Problem(time, attitude, self.tight, PlanOptions(knot=0.5 * o.stage_s, iterations=o.smoothing))
        return refine(problem, d, Boundary(pinned=(False, True), start=True, start_rate=rate)).angles

    def stages(self) -> tuple[Array, Array, int, int]:
        """(time (k,) [s], exact pose (k, 4) [rad], stages whose attitude is known, the first one over a limit or k)."""
        o = self.options
        horizon = max(o.horizon_s, float(self.known_time[-1]) - self.clock)
        count = max(1, math.ceil(horizon / o.stage_s - 1e-9))
        time = np.array(self.clock + o.stage_s * np.arange(count + 1), dtype=np.float64)
        attitude = np.empty((count + 1, 3, 3))
        known = attitudes_ahead(
            self.known_time, self.known_attitude, time, FIT_WINDOW, o.settling_s, 0.5 * o.stage_s, attitude
        )
        trust: Array = np.exp(-np.maximum(0.0, time - time[known - 1]) / o.foresight_s)
        costs = Costs(
            float(o.rate_cost), float(o.acceleration_cost), float(o.singularity_cost), float(o.range_cost),
            float(o.excess_cost), HOME_COST, float(o.end_cost), float(o.room_cost), float(o.room_s), ROOM_FOR,
        )  # fmt: skip
        pose = np.empty((count + 1, 4))
        beam = o.beam if len(self.pose) == 1 else START_BEAM
        _, first_violation = search(
            self.tight.geometry.horizontal, limit_table(self.tight), costs, Stages(time, attitude, trust),
            Start(self.pose, self.rate, float(self.past)), o.slides, beam, pose,
        )  # fmt: skip
        return time, pose, known, first_violation


def smooth_reference(time: Array, pose: Array, rate: Array | None) -> tuple[Array, Array, Array]:
    """(time, pose, rate) twice as dense, with the accelerations that the search reckoned with.

    time (k,) [s] evenly spaced, pose (k, 4) [rad]; rate (4,) [rad/s] at the first, None: as over the first stage. A
    stage's mean rate is the rate at its middle; between the middles the rate runs straight, which makes the curve pass
    the poses within an eighth of a stage's change of acceleration times its square.
    """
    h = 0.5 * float(time[1] - time[0])
    mean = np.diff(pose, axis=0) / (2.0 * h)
    v = np.empty((2 * len(mean) + 1, 4))
    v[1::2] = mean
    v[2:-1:2] = 0.5 * (mean[1:] + mean[:-1])
    v[0] = mean[0] if rate is None else rate
    v[-1] = mean[-1]
    x = np.empty_like(v)
    x[0] = pose[0]
    x[1:] = pose[0] + np.cumsum(0.5 * h * (v[1:] + v[:-1]), axis=0)
    return time[0] + h * np.arange(len(v)), x, v
