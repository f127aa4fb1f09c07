"""The way ahead of a rig in motion: what `preview` is told to weigh, the job that finds a way, and the way found.

A job is frozen and picklable, and its `run` may be called in any thread or process. It searches (`fullpose.plan.
horizon`), which decides the way round, and then refines what was found (`fullpose.trajectory.sqp`), as `plan` does with
a whole flight: the search moves in coarse slides, and what it jerks the refinement smooths inside the same limits.

Source: mathematics, section 9.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.errors import MethodError
from fullpose.limits import limit_table
from fullpose.preview.prediction import attitudes_ahead
from fullpose.rig import Rig
from fullpose.trajectory.beam_search import search
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.sqp import refine

START_BEAM = 1000  # states kept a stage then: the way begins anywhere
HOME_COST = 1e-3  # [1/(rad^2 s)]: decides where nothing else does
ROOM_FOR = math.radians(60.0)  # [rad/s] body rate that room is measured against
# What a way may take at most, 150 MB and some seconds: live, the rig waits at rest for the first one.
MOST = {"beam": 4096, "slides": 64, "smoothing": 100}
MOST_STAGES = 1000
FIT_WINDOW = 0.1  # [s] of attitude that the present body rate is taken from


@dataclass(frozen=True)
class PreviewOptions:
    """How far ahead, how often and how thoroughly. Raises `MethodError` where an option is out of its range.

    preview_s: future that is known [s], of a flight from a file; live, the source sends it. horizon_s: how far the way
    goes [s] (where more is known, as far as that). replan_s: flight time between two ways [s]. delay_s: flight time
    until a way is there [s], to simulate a slow re-plan. settling_s: how long the body's acceleration is taken to last
    [s]; 0: the prediction is the present rate.
    """

    preview_s: float = 0.0
    horizon_s: float = 1.5
    replan_s: float = 0.05
    delay_s: float = 0.0
    settling_s: float = 0.3
    stage_s: float = 0.05
    beam: int = 192  # states kept a stage
    smoothing: int = 3  # iterations of the refinement; 0: the way as the search found it
    slides: int = 5  # tried from each
    reserve: float = 0.1  # share of the acceleration limits that a way leaves to what was not foreseen
    foresight_s: float = 1.0  # the weight of what is predicted falls by e over this
    singularity_cost: float = 0.3  # [1/s]; the next too
    range_cost: float = 1.0
    room_cost: float = 1.0  # [1/s] where there is room for a body rate of 54 deg/s in any direction, and no more
    room_s: float = 0.5  # [s] that the room must last
    rate_cost: float = 1.0
    acceleration_cost: float = 0.1
    excess_cost: float = 1e3
    end_cost: float = 1.0  # [s] of standing at the last stage
    following: float = 20.0  # [1/s] bandwidth with which the way is followed
    avoidance: float = 2.0  # as in `exact`, without a way
    centring: float = 2.0
    recovery: float = 0.5

    def __post_init__(self) -> None:
        for name in ("preview_s", "delay_s", "settling_s", "singularity_cost", "range_cost", "room_cost", "rate_cost",
                     "acceleration_cost", "excess_cost", "end_cost", "avoidance", "centring"):  # fmt: skip
            if not 0.0 <= getattr(self, name) < np.inf:
                raise MethodError(f"option {name} = {getattr(self, name)!r}: expected a number, 0 or more")
        for name in ("horizon_s", "replan_s", "stage_s", "foresight_s", "room_s", "following"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise MethodError(f"option {name} = {getattr(self, name)!r}: expected a number above 0")
        if not 0.0 <= self.reserve < 1.0:
            raise MethodError(f"option reserve = {self.reserve!r}: expected a number in [0, 1)")
        if not 0.0 < self.recovery <= 1.0:
            raise MethodError(f"option recovery = {self.recovery!r}: expected a number in (0, 1]")
        if self.beam < 1 or self.slides < 2 or self.smoothing < 0:
            found = f"beam = {self.beam}, slides = {self.slides}, smoothing = {self.smoothing}"
            raise MethodError(f"options {found}: expected 1, 2 and 0 or more")
        for name, most in MOST.items():
            if getattr(self, name) > most:
                raise MethodError(f"option {name} = {getattr(self, name)!r}: expected {most} at most")
        stages = max(self.horizon_s, self.preview_s) / self.stage_s
        if stages > MOST_STAGES:
            raise MethodError(
                f"options horizon_s = {self.horizon_s!r}, preview_s = {self.preview_s!r}, stage_s = {self.stage_s!r}: "
                f"expected {MOST_STAGES} stages at most, these are {stages:.3g}"
            )


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
        time, pose, known, over = self.stages()
        knots, position, rate = smooth_way(time, pose, self.rate[0] if self.past > 0.0 else None)
        if over == len(time) and self.past > 0.0 and self.options.smoothing:
            knots, position, rate = smooth_way(knots, self._refined(knots, position, rate[0]), rate[0])
        lost_at = float(time[over]) if over < len(time) else math.inf
        return Ahead(self.number, knots, position, rate, known, lost_at)

    def _refined(self, time: Array, pose: Array, rate: Array) -> Array:
        """The way smoothed on its knots (k, 4) [rad], from the same pose and rate to the same end."""
        o = self.options
        attitude = np.empty((len(time), 3, 3))
        attitudes_ahead(self.known_time, self.known_attitude, time, FIT_WINDOW, o.settling_s, 0.5 * o.stage_s, attitude)
        d = pose.copy()
        closest_all(self.tight.axes, self.tight.geometry.horizontal, attitude, d)
        return refine(
            time, attitude, d, self.tight, PlanOptions(knot=0.5 * o.stage_s), start=True, start_rate=rate,
            pinned=(False, True), iterations=o.smoothing,
        ).angles  # fmt: skip

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
        weights = np.array(
            [
                o.rate_cost, o.acceleration_cost, o.singularity_cost, o.range_cost, o.excess_cost, o.end_cost,
                HOME_COST, o.room_cost, o.room_s, ROOM_FOR,
            ]
        )  # fmt: skip
        table = limit_table(self.tight)
        pose = np.empty((count + 1, 4))
        beam = o.beam if len(self.pose) == 1 else START_BEAM
        _, over = search(
            self.tight.geometry.horizontal, table, weights, time, attitude, trust, self.past, self.pose, self.rate,
            o.slides, beam, pose,
        )  # fmt: skip
        return time, pose, known, over


def smooth_way(time: Array, pose: Array, rate: Array | None) -> tuple[Array, Array, Array]:
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
