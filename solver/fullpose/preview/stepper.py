"""Method `preview`: attitude one sample at a time, with 0 to 2 s of known or predicted future.

The step is the exact one inside a box that always can brake (`fullpose.step`, `fullpose.limits`,
`fullpose.methods.limited`). What is free, the place on the self-motion, follows a way found over the horizon
(`fullpose.trajectory.beam_search`): the announced future, then the attitude predicted at the present body rate
(`fullpose.preview.prediction`). The way is made again every few tens of milliseconds: `replan` returns a frozen
job, whose `run` may be called in any thread or process, and `adopt` takes its result, late or not. So exactness is
decided by foresight, and the limits by the step alone: a bad, stale or missing way costs room, never a limit.

Source: mathematics, section 9.
"""

import math
from dataclasses import replace

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.bounds import EXACT
from fullpose.errors import MethodError
from fullpose.kinematics import jacobian, null_vector
from fullpose.limits import MAX, MIN, limit_table
from fullpose.methods.base import Block
from fullpose.methods.block import block_kernel
from fullpose.methods.limited import (
    Gains,
    LimitedStepper,
    closed_form_step,
    finish,
    flight_from,
    goal,
    null_space_increment,
)
from fullpose.methods.start_pose import start_pose
from fullpose.methods.state import FRESH, MOVING, Flight, box_ahead
from fullpose.preview.options import PreviewOptions
from fullpose.preview.prediction import Track
from fullpose.preview.replan import FIT_WINDOW, Ahead, Replan
from fullpose.rig import Rig
from fullpose.trajectory.curve import hermite
from fullpose.trajectory.nodes import empty_nodes, fill_nodes, node_grid

START_GRID = 60  # nodes a turn among which a free start is chosen


@inner
def follow(flight: Flight, reference_time: Array, reference_pose: Array, reference_rate: Array, omega: float) -> bool:
    """increment <- the one that follows the way over the interval ahead; false where it does not reach so far.

    Critically damped, bandwidth omega [1/s], by the implicit Euler step, which is stable for any interval. way_time
    (k,) [s] evenly spaced, way_pose, way_rate (k, 4) [rad], [rad/s].
    """
    h = flight.ahead
    t = flight.clock + h
    last = reference_time.shape[0] - 1
    if last < 1 or t > reference_time[last] or flight.clock < reference_time[0] - 1e-9:
        return False
    j = min(int((t - reference_time[0]) / (reference_time[1] - reference_time[0])), last - 1)
    span = reference_time[j + 1] - reference_time[j]
    s = (t - reference_time[j]) / span
    stiffness = h * omega * omega
    damping = 2.0 * omega
    for i in range(4):
        rise = reference_pose[j + 1, i] - reference_pose[j, i]
        off_chord, v, v_2 = hermite(rise, reference_rate[j, i], reference_rate[j + 1, i], span, s)
        p = reference_pose[j, i] + s * rise + off_chord
        if flight.phase == MOVING:
            rate = flight.rate[i] + h * (v_2 + omega * omega * (p - flight.pose[i]) + damping * v)
            flight.increment[i] = h * rate / (1.0 + h * damping + h * stiffness)
        else:
            flight.increment[i] = p - flight.pose[i]
    return True


@inner
def preview_step(flight: Flight, reference: tuple[Array, Array, Array, float], C: Array) -> tuple[int, int]:
    """See `block.propose`: the exact step, but for the null-space increment.

    way: times (k,) [s], poses and rates (k, 4) there, bandwidth [1/s]; k = 0: there is none.
    """
    box_ahead(flight)
    if not follow(flight, reference[0], reference[1], reference[2], reference[3]):
        null_space_increment(flight)
    goal(flight, C)
    jacobian(flight.axes, flight.pose, flight.J)
    manipulability = null_vector(flight.J, flight.null)
    closed_form_step(flight, manipulability, flight.pose, flight.guess)
    return finish(flight)


preview_block = block_kernel("preview_block", preview_step)


class PreviewStepper(LimitedStepper):
    """One flight in progress with `preview`; a `fullpose.methods.base.Stepper` with a look-ahead."""

    def __init__(self, rig: Rig, options: PreviewOptions, start: Array | None, attitude: Array) -> None:
        """start (4,) [rad]: the pose to start near; None: where there is most room on the way that is known by then."""
        gains = Gains(options.avoidance, options.centring, 0.0, options.recovery)
        super().__init__(preview_block, (), gains, flight_from("preview", rig, start, attitude))
        self._rig, self._options = rig, options
        self._table = limit_table(rig)
        share = 1.0 - options.reserve
        frames = [replace(frame, max_acceleration=share * frame.max_acceleration) for frame in rig.frames]
        self._tight = replace(rig, frames=(frames[0], frames[1], frames[2], frames[3]))
        self._free = start is None
        self._track = Track(2.0 * FIT_WINDOW)
        self._asked = 0
        self.asked_at = -math.inf  # [s] when the last job was asked for
        self.reference = Ahead(0, np.empty(0), np.empty((0, 4)), np.empty((0, 4)), 0, math.inf)

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        super().begin_at_rest(dt)
        self._free = False

    def void(self) -> None:
        """What the source said of the future does not come."""
        self._track.void(self._flight.clock)

    def offer(self, time: Array, attitude: Array) -> None:
        """The source's preview: time (m,) [s] increasing, attitude (m, 3, 3); what it said of those times is void.

        Raises `InputError` where the times do not increase.
        """
        if len(time):
            self._track.tell(time, attitude)

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        if self._free and self._flight.phase == FRESH:
            self._choose_start(float(time[0]), attitude[0])
        reference = self.reference
        self._parameters = reference.time, reference.pose, reference.rate, self._options.following
        out = super().block(time, attitude)
        for k in range(len(time)):
            self._track.flown(float(time[k]), attitude[k])
        self._track.forget(float(time[-1]))
        return out

    @property
    def due(self) -> bool:
        """Whether `replan_s` of flight have passed since the last job was asked for."""
        return bool(self._flight.phase != FRESH and self._flight.clock >= self.asked_at + self._options.replan_s - 1e-9)

    def replan(self) -> Replan:
        """The job that finds the way from here. Raises `MethodError` before the first sample."""
        if self._flight.phase == FRESH:
            raise MethodError("preview: no sample has been flown, there is nothing to plan from")
        moving = self._flight.phase == MOVING
        self.asked_at = self._flight.clock
        return self._job(
            self.asked_at, self._flight.pose[None].copy(), self._flight.rate[None].copy(),
            self._flight.past if moving else 0.0,
        )  # fmt: skip

    def adopt(self, reference: Ahead) -> bool:
        """Follow a way from now on; false, and nothing changes, where it is older than the one in use or run out."""
        if reference.number <= self.reference.number or reference.time[-1] <= self._flight.clock:
            return False
        self.reference = reference
        return True

    def _job(self, clock: float, pose: Array, rate: Array, past: float) -> Replan:
        self._asked += 1
        return Replan(
            self._asked, self._tight, self._options, clock, pose, rate, past, *self._track.copy(),
        )  # fmt: skip

    def _choose_start(self, time: float, attitude: Array) -> None:
        """The start with the cheapest way over what is known, of all nodes inside the ranges; else the nearest pose."""
        self._free = False
        poses = start_nodes(self._rig, self._table, attitude)
        if not len(poses) or self._flight.code != EXACT:
            return
        self._track.flown(time, attitude)
        reference = self._job(time, poses, np.zeros_like(poses), 0.0).run()
        pose, code = start_pose(self._rig, attitude, reference.pose[0])
        if code == EXACT:
            self._flight.pose[:] = pose
            self.reference = reference


def start_nodes(rig: Rig, table: Array, attitude: Array) -> Array:
    """Exact poses (m, 4) [rad] for one attitude, inside the position limits, all round both charts, near home."""
    low = np.where(np.isfinite(table[MIN]) & (table[MAX] - table[MIN] < 2.0 * math.pi), table[MIN], rig.home - math.pi)
    nodes = empty_nodes(START_GRID)
    grid = node_grid(START_GRID, low, table[MAX].copy())
    fill_nodes(rig.geometry.horizontal, np.ascontiguousarray(attitude), grid, nodes)
    inside = nodes.alive & (nodes.position >= table[MIN]).all(axis=1)
    return np.ascontiguousarray(nodes.position[inside])
