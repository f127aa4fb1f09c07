"""Method `preview`: attitude one sample at a time, with 0 to 2 s of known or predicted future.

The step is the exact one inside a box that always can brake (`solver.step`, `solver.limits`,
`solver.tracking`). What is free, the place on the self-motion, follows a way found over the horizon
(`solver.planner.horizon`): the announced future, then the attitude predicted at the present body rate
(`solver.planner.predict`). The way is made again every few tens of milliseconds: `replan` returns a frozen, picklable
job, whose `run` may be called in any thread or process, and `adopt` takes its result, late or not. So exactness is
decided by foresight, and the limits by the step alone: a bad, stale or missing way costs room, never a limit.

Source: METHODS section 9.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver._jit import kernel
from solver.errors import MethodError
from solver.kinematics import jacobian, null_vector
from solver.limits import ACCELERATION, MAX, MIN, WEIGHT, limit_table
from solver.methods.base import Block
from solver.planner.horizon import search
from solver.planner.nodes import fill_nodes, grid_circle
from solver.planner.predict import Track, attitudes_ahead
from solver.rig import Rig
from solver.solution import EXACT
from solver.start import start_pose
from solver.step import quadratic_step
from solver.tracking import (
    CLOCK,
    CODE,
    FRESH,
    GUESS,
    HI,
    LO,
    MOVING,
    NULL,
    PAST,
    PHASE,
    POSE,
    ROWS,
    TOLERANCE,
    WISH,
    advance,
    finish,
    goal,
    new_state,
    prepare,
    stand,
    wish,
)

Array = NDArray[np.float64]

START_GRID = 60  # nodes a turn among which a free start is chosen
START_BEAM = 1000  # states kept a stage then: the way begins anywhere
HOME_COST = 1e-3  # [1/(rad^2 s)]: decides where nothing else does
ROOM_FOR = math.radians(60.0)  # [rad/s] body rate that room is measured against
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
    beam: int = 96  # states kept a stage
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
        if self.beam < 1 or self.slides < 2:
            raise MethodError(f"options beam = {self.beam}, slides = {self.slides}: expected 1 and 2 or more")


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
    horizontal: bool
    table: Array  # limits less the reserve
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
        lost_at = float(time[over]) if over < len(time) else math.inf
        return Ahead(self.number, knots, position, rate, known, lost_at)

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
        pose = np.empty((count + 1, 4))
        beam = o.beam if len(self.pose) == 1 else START_BEAM
        _, over = search(
            self.horizontal, self.table, weights, time, attitude, trust, self.past, self.pose, self.rate,
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


@kernel
def follow(way_time: Array, way_pose: Array, way_rate: Array, state: Array, h: float, omega: float, out: Array) -> bool:
    """out <- the increment (4,) [rad] over `h` [s] that follows the way; false where it does not reach so far.

    Critically damped, bandwidth omega [1/s], by the implicit Euler step, which is stable for any h.
    """
    t = state[CLOCK] + h
    last = way_time.shape[0] - 1
    if last < 1 or t > way_time[last] or state[CLOCK] < way_time[0] - 1e-9:
        return False
    j = min(int((t - way_time[0]) / (way_time[1] - way_time[0])), last - 1)
    span = way_time[j + 1] - way_time[j]
    s = (t - way_time[j]) / span
    a = 1.0 - s
    moving = state[PHASE] == MOVING
    stiffness = h * omega * omega
    damping = 2.0 * omega
    for i in range(4):
        p0 = way_pose[j, i]
        rise = way_pose[j + 1, i] - p0
        bend0 = way_rate[j, i] * span - rise
        bend1 = rise - way_rate[j + 1, i] * span
        p = p0 + s * rise + s * a * (a * bend0 + s * bend1)
        v = (rise + (1.0 - 2.0 * s) * (a * bend0 + s * bend1) + s * a * (bend1 - bend0)) / span
        v_2 = (2.0 * (1.0 - 2.0 * s) * (bend1 - bend0) - 2.0 * (a * bend0 + s * bend1)) / (span * span)
        if moving:
            rate = state[4 + i] + h * (v_2 + omega * omega * (p - state[i]) + damping * v)
            out[i] = h * rate / (1.0 + h * damping + h * stiffness)
        else:
            out[i] = p - state[i]
    return True


@kernel
def preview_block(
    horizontal: bool,
    axes: NDArray[np.int64],
    table: Array,
    gains: Array,
    way_time: Array,
    way_pose: Array,
    way_rate: Array,
    time: Array,
    attitude: Array,
    state: Array,
    target: Array,
    angles: Array,
    limited: NDArray[np.int16],
    iterations: NDArray[np.int32],
) -> None:
    """Advance `state` over m samples: time (m,), attitude (m, 3, 3) in; angles (m, 4), limited, iterations (m,) out.

    gains: avoidance, centring, homing (without a way), recovery, following. `exact_block`, but for the wish.
    """
    work = np.empty((ROWS, 4))
    J = np.empty((3, 4))
    F = np.empty((3, 3))
    G = np.empty((3, 3))
    A = np.empty((4, 5))
    e = np.empty(3)
    lo_code = np.empty(4, np.int16)
    hi_code = np.empty(4, np.int16)
    d = state[0:4]
    for k in range(time.shape[0]):
        C = attitude[k]
        if state[PHASE] == FRESH:
            code = int(state[CODE])
            iterations[k] = 0
            for i in range(4):
                work[POSE, i] = d[i]
        else:
            h = time[k] - state[CLOCK]
            prepare(table, state, h, work, lo_code, hi_code)
            if not follow(way_time, way_pose, way_rate, state, h, gains[4], work[WISH]):
                wish(table, d, h, gains, work[WISH])
            on_target = goal(table, axes, state, target, C, h, gains[3], F, G, e)
            jacobian(axes, d, J)
            volume = null_vector(J, work[NULL])
            quadratic_step(
                J, work[NULL], volume, table[WEIGHT], d, work[WISH], e, work[LO], work[HI], work[TOLERANCE], work[GUESS]
            )
            iterations[k], code = finish(
                horizontal, axes, table, state, on_target, G, J, e, F, work, A, lo_code, hi_code
            )
        for i in range(4):
            angles[k, i] = work[POSE, i]
        limited[k] = code
        advance(state, target, time[k], work[POSE], code, C)


class PreviewStepper:
    """One flight in progress with `preview`; a `solver.methods.base.Stepper` with a look-ahead."""

    def __init__(self, rig: Rig, options: PreviewOptions, start: Array | None, attitude: Array) -> None:
        """start (4,) [rad]: the pose to start near; None: where there is most room on the way that is known by then."""
        if not rig.geometry.redundant:
            raise MethodError(f"preview needs the fourth axis; {rig.name} is {rig.geometry.value}: use three_axis")
        self._rig, self._options = rig, options
        self._table = limit_table(rig)
        self._tight = limit_table(rig)
        self._tight[ACCELERATION] *= 1.0 - options.reserve
        self._gains = np.array([options.avoidance, options.centring, 0.0, options.recovery, options.following])
        self._free = start is None
        self._state = new_state(*start_pose(rig, attitude, start))
        self._target = np.array(attitude, order="C")
        self._track = Track(2.0 * FIT_WINDOW)
        self._asked = 0
        self.asked_at = -math.inf  # [s] when the last job was asked for
        self.way = Ahead(0, np.empty(0), np.empty((0, 4)), np.empty((0, 4)), 0, math.inf)

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        stand(self._state, dt)
        self._free = False

    def void(self) -> None:
        """What the source said of the future does not come."""
        self._track.void(float(self._state[CLOCK]))

    def offer(self, time: Array, attitude: Array) -> None:
        """The source's preview: time (m,) [s] increasing, attitude (m, 3, 3); what it said of those times is void.

        Raises `InputError` where the times do not increase.
        """
        if len(time):
            self._track.tell(time, attitude)

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        if self._free and self._state[PHASE] == FRESH:
            self._choose_start(float(time[0]), attitude[0])
        way = self.way
        preview_block(
            self._rig.geometry.horizontal, self._rig.axes, self._table, self._gains, way.time, way.pose, way.rate,
            time, attitude, self._state, self._target, out.angles, out.limited, out.iterations,
        )  # fmt: skip
        for k in range(m):
            self._track.flown(float(time[k]), attitude[k])
        self._track.forget(float(time[-1]))
        return out

    @property
    def due(self) -> bool:
        """Whether `replan_s` of flight have passed since the last job was asked for."""
        return bool(self._state[PHASE] != FRESH and self._state[CLOCK] >= self.asked_at + self._options.replan_s - 1e-9)

    def replan(self) -> Replan:
        """The job that finds the way from here. Raises `MethodError` before the first sample."""
        if self._state[PHASE] == FRESH:
            raise MethodError("preview: no sample has been flown, there is nothing to plan from")
        moving = self._state[PHASE] == MOVING
        self.asked_at = float(self._state[CLOCK])
        return self._job(
            self.asked_at, self._state[None, :4].copy(), self._state[None, 4:8].copy(),
            float(self._state[PAST]) if moving else 0.0,
        )  # fmt: skip

    def adopt(self, way: Ahead) -> bool:
        """Follow a way from now on; false, and nothing changes, where it is older than the one in use or run out."""
        if way.number <= self.way.number or way.time[-1] <= self._state[CLOCK]:
            return False
        self.way = way
        return True

    def _job(self, clock: float, pose: Array, rate: Array, past: float) -> Replan:
        self._asked += 1
        return Replan(
            self._asked, self._rig.geometry.horizontal, self._tight, self._options, clock, pose, rate, past,
            *self._track.copy(),
        )  # fmt: skip

    def _choose_start(self, time: float, attitude: Array) -> None:
        """The start with the cheapest way over what is known, of all nodes inside the ranges; else the nearest pose."""
        self._free = False
        poses = start_nodes(self._rig, self._table, attitude)
        if not len(poses) or self._state[CODE] != EXACT:
            return
        self._track.flown(time, attitude)
        way = self._job(time, poses, np.zeros_like(poses), 0.0).run()
        pose, code = start_pose(self._rig, attitude, way.pose[0])
        if code == EXACT:
            self._state = new_state(pose, code)
            self.way = way


def start_nodes(rig: Rig, table: Array, attitude: Array) -> Array:
    """Exact poses (m, 4) [rad] for one attitude, inside the position limits, all round both charts, near home."""
    low = np.where(np.isfinite(table[MIN]) & (table[MAX] - table[MIN] < 2.0 * math.pi), table[MIN], rig.home - math.pi)
    n = 4 * START_GRID
    position, measure, alive = np.zeros((n, 4)), np.ones(n), np.zeros(n, np.bool_)
    cosines, sines = grid_circle(START_GRID)
    fill_nodes(
        rig.geometry.horizontal, np.ascontiguousarray(attitude), cosines, sines, low, table[MAX].copy(),
        position, measure, alive,
    )  # fmt: skip
    return np.ascontiguousarray(position[alive & (position >= table[MIN]).all(axis=1)])
