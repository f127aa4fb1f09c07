"""Playing a plan: time along the path may run slower than the clock, never faster, down to a hold on the path.

At full speed the plan's own samples are played, bit for bit. While the time scale changes, and until the phase has
slipped back onto a whole sample, angles between samples are interpolated and put back on the exact solution by the
closed-form charts, so that the attitude stays exact throughout.
"""

import math

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.charts import project
from fullpose.kinematics import payload_attitude, rotation_error
from fullpose.rig import Rig
from fullpose_server.formats.plan_folder import PlanFolder

# Rows of the player's state: place on the path [samples], time scale, its rate of change [1/s].
PLACE, SCALE, SCALE_RATE = 0, 1, 2
_EXACT = 1e-9  # [rad] a sample solved better than this lies on the solution curve
_SNAP = 1e-7  # [samples] closer than this to a whole sample is that sample
_SLIP = 10.0  # [1/s] how fast the phase slips back onto whole samples
_SLACK = 1e-7  # relative, under the guard's own tolerance


@kernel
def attitude_of(q: Array, C: Array) -> None:
    """C <- body from reference of the unit quaternion q (w, x, y, z). (4,), (3, 3)"""
    w, x, y, z = q[0], q[1], q[2], q[3]
    C[0, 0] = 1 - 2 * (y * y + z * z)
    C[0, 1] = 2 * (x * y + w * z)
    C[0, 2] = 2 * (x * z - w * y)
    C[1, 0] = 2 * (x * y - w * z)
    C[1, 1] = 1 - 2 * (x * x + z * z)
    C[1, 2] = 2 * (y * z + w * x)
    C[2, 0] = 2 * (x * z + w * y)
    C[2, 1] = 2 * (y * z - w * x)
    C[2, 2] = 1 - 2 * (x * x + y * y)


@kernel
def attitude_error(axes: NDArray[np.int64], d: Array, q: Array) -> float:
    """Geodesic error [rad] of the payload at angles d (4,) against the quaternion q (4,)."""
    F = np.empty((3, 3))
    C = np.empty((3, 3))
    e = np.empty(3)
    payload_attitude(axes, d, F)
    attitude_of(q, C)
    return rotation_error(F, C, e)


@kernel
def _cubic(rows: Array, i: int, f: float, first: int, last: int, out: Array) -> None:
    """out <- Catmull-Rom between rows i and i + 1 at share f, of the rows first..last alone."""
    for k in range(rows.shape[1]):
        p1 = rows[i, k]
        p2 = rows[i + 1, k]
        p0 = rows[i - 1, k] if i > first else 2.0 * p1 - p2
        p3 = rows[i + 2, k] if i + 1 < last else 2.0 * p2 - p1
        a = 0.5 * (p3 - p0) + 1.5 * (p1 - p2)
        b = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3
        out[k] = p1 + f * (0.5 * (p2 - p0) + f * (b + f * a))


@kernel
def evaluate(
    angles: Array,
    target: Array,
    error: Array,
    first: int,
    last: int,
    chart: int,
    s: float,
    x: Array,
    q: Array,
) -> bool:
    """x, q <- angles [rad] and attitude at place s [samples]; returns whether s lies in the flight.

    angles, target (n, 4), error (n,); the flight is rows first..last; chart is 0 for a rig without the redundant
    frame, 1 for the vertical, 2 for the horizontal one. Outside the flight q is nan.
    """
    n = angles.shape[0]
    i = min(math.floor(s), n - 1)
    f = s - i
    flight = first <= s <= last
    if f < _SNAP or i == n - 1:
        for k in range(4):
            x[k] = angles[i, k]
            q[k] = target[i, k] if flight else math.nan
        return flight
    _cubic(angles, i, f, 0, n - 1, x)
    if not flight:
        for k in range(4):
            q[k] = math.nan
        return False
    _cubic(target, i, f, first, last, q)
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    for k in range(4):
        q[k] /= norm
    if chart > 0 and error[i] <= _EXACT and error[i + 1] <= _EXACT:
        C = np.empty((3, 3))
        attitude_of(q, C)
        project(chart == 2, C, x, x)
    return True


@kernel
def _excess(dt: float, x: Array, x1: Array, v1: Array, max_rate: Array, max_acceleration: Array) -> float:
    """The worst share of a rate or acceleration limit that the step x1 -> x takes; 1 is the limit."""
    worst = 0.0
    for i in range(4):
        v = (x[i] - x1[i]) / dt
        a = (v - v1[i]) / dt
        worst = max(worst, abs(v) / max_rate[i], abs(a) / max_acceleration[i])
    return worst


@kernel
def advance(
    angles: Array,
    target: Array,
    error: Array,
    first: int,
    last: int,
    chart: int,
    per_tick: float,
    dt: float,
    wanted: float,
    limits: Array,
    offset: Array,
    state: Array,
    x1: Array,
    v1: Array,
    x: Array,
    q: Array,
) -> int:
    """One tick along the path: state, x, q <- the next ones; returns 1 in the flight, 0 in a lead, -1 at the end.

    wanted is the time scale to go to (0 hold, 1 run); limits (3, 4) holds rates, accelerations and, in row 2, the
    fastest rate and jerk of the scale; offset (4,) whole turns [rad]; x1, v1 (4,) the last command and its rate. The
    scale moves as fast as it may without any frame leaving its rate or acceleration limit.
    """
    end = angles.shape[0] - 1.0
    place = state[PLACE]
    scale = state[SCALE]
    whole = abs(place - np.rint(place)) < _SNAP
    if per_tick == 1.0 and wanted == 1.0 and not whole:
        wanted = 1.0 - _SLIP * dt * (place - math.floor(place))
    gap = wanted - scale
    rate = min(limits[2, 0], math.sqrt(2.0 * limits[2, 1] * abs(gap)))
    # Speeding up the change is jerk-limited; slowing it down follows the square root above.
    rate = min(rate, abs(state[SCALE_RATE]) + limits[2, 1] * dt)
    rate = math.copysign(min(rate, abs(gap) / dt), gap)
    best = math.inf
    best_place = place
    best_rate = 0.0
    for attempt in range(8):
        # Less and less of the wanted change, then the other way: 0 is as safe as the plan itself.
        share = 1.0 - 0.25 * attempt if attempt < 5 else -0.25 * (attempt - 4)
        change = rate * share
        trial = min(1.0, max(0.0, scale + change * dt))
        to = place + trial * per_tick
        nearest = np.rint(to)
        if abs(to - nearest) < _SNAP:
            to = nearest
        to = min(to, end)
        flight = evaluate(angles, target, error, first, last, chart, to, x, q)
        for i in range(4):
            x[i] += offset[i]
        excess = _excess(dt, x, x1, v1, limits[0], limits[1])
        if excess < best:
            best = excess
            best_place = to
            best_rate = change
        if excess <= 1.0 + _SLACK or rate == 0.0:
            best_place = to
            best_rate = change
            break
    else:
        flight = evaluate(angles, target, error, first, last, chart, best_place, x, q)
        for i in range(4):
            x[i] += offset[i]
    state[SCALE] = min(1.0, max(0.0, scale + best_rate * dt))
    state[SCALE_RATE] = best_rate
    state[PLACE] = best_place
    if best_place >= end:
        return -1
    return 1 if flight else 0


class PathPlayer:
    """Plays one plan on one rig, tick by tick."""

    def __init__(self, plan: PlanFolder, rig: Rig, rate_hz: float, scale_rate: float, scale_jerk: float) -> None:
        info = plan.info
        # Copies: a page fault on a mapped file would stall the loop.
        self._angles = np.array(plan.angles)
        self._target = np.array(plan.target)
        self._error = np.array(plan.error)
        self._first = info.lead_in_samples
        self._last = info.samples - 1 - info.lead_out_samples
        self._chart = 0 if not rig.geometry.redundant else 2 if rig.geometry.horizontal else 1
        self._dt = 1.0 / rate_hz
        self._rate_hz = info.rate_hz
        ratio = info.rate_hz / rate_hz
        self._per_tick = 1.0 if abs(ratio - 1.0) < 1e-12 else ratio
        self._limits = np.zeros((3, 4))
        self._limits[0] = rig.max_rate
        self._limits[1] = rig.max_acceleration
        self._limits[2, :2] = scale_rate, scale_jerk
        self._turns = np.array([np.isinf(low) and np.isinf(high) for low, high in _ranges(rig)])
        self._offset = np.zeros(4)
        self._state = np.zeros(3)
        self._start_s = info.start_s
        self.wanted = 1.0

    def start_pose(self, near: Array) -> Array:
        """Where the path begins (4,) [rad]; frames that turn without end take the turn nearest to `near` (4,)."""
        turns = np.round((near - self._angles[0]) / (2.0 * math.pi))
        self._offset[:] = np.where(self._turns, turns * 2.0 * math.pi, 0.0)
        return np.asarray(self._angles[0] + self._offset)

    def rewind(self) -> None:
        """To the start, at full scale: the path begins at rest."""
        self._state[:] = 0.0, 1.0, 0.0
        self.wanted = 1.0

    def tick(self, x1: Array, v1: Array, x: Array, q: Array) -> int:
        """One tick: fills x and q; 1 in the flight, 0 in a lead, -1 at the end (see `advance`)."""
        return int(
            advance(
                self._angles,
                self._target,
                self._error,
                self._first,
                self._last,
                self._chart,
                self._per_tick,
                self._dt,
                self.wanted,
                self._limits,
                self._offset,
                self._state,
                x1,
                v1,
                x,
                q,
            )
        )

    @property
    def time_s(self) -> float:
        """The flight's own time; before its start in the lead-in [s]."""
        return float((self._state[PLACE] - self._first) / self._rate_hz + self._start_s)

    @property
    def scale(self) -> float:
        """1 at full speed, 0 held."""
        return float(self._state[SCALE])


def _ranges(rig: Rig) -> list[tuple[float, float]]:
    return list(zip(rig.position_min.tolist(), rig.position_max.tolist(), strict=True))
