"""Playing a plan: time along the path may run slower than the clock, never faster, down to a hold on the path.

At full speed the plan's own samples are played, bit for bit. While the time scale changes, and until the phase has
slipped back onto a whole sample, angles between samples are interpolated and put back on the exact solution by the
closed-form charts, so that the attitude stays exact throughout.
"""

import math
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.charts import project
from fullpose.kinematics import payload_attitude, rotation_error
from fullpose.rig import Rig
from fullpose_server.formats.plan_folder import PlanFolder

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


class Path(NamedTuple):
    """A plan's rows: the flight is `first`..`last` of them, the rest are leads."""

    angles: Array  # (n, 4) [rad]
    target: Array  # (n, 4) w, x, y, z
    error: Array  # (n,) [rad]
    first: int
    last: int
    chart: int  # 0 for a rig without the redundant frame, 1 for the vertical, 2 for the horizontal one


@kernel
def evaluate(path: Path, s: float, x: Array, q: Array) -> bool:
    """x, q (4,) <- angles [rad] and attitude at place s [samples]; returns whether s lies in the flight.

    Outside the flight q is nan.
    """
    n = path.angles.shape[0]
    i = min(math.floor(s), n - 1)
    f = s - i
    flight = path.first <= s <= path.last
    if f < _SNAP or i == n - 1:
        for k in range(4):
            x[k] = path.angles[i, k]
            q[k] = path.target[i, k] if flight else math.nan
        return flight
    _cubic(path.angles, i, f, 0, n - 1, x)
    if not flight:
        for k in range(4):
            q[k] = math.nan
        return False
    _cubic(path.target, i, f, path.first, path.last, q)
    norm = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    for k in range(4):
        q[k] /= norm
    if path.chart > 0 and path.error[i] <= _EXACT and path.error[i + 1] <= _EXACT:
        C = np.empty((3, 3))
        attitude_of(q, C)
        project(path.chart == 2, C, x, x)
    return True


class Player(Protocol):
    """A path being played, as `PLAYER` lays it out."""

    first: int  # of the path: see `Path`
    last: int
    chart: int
    dt: float  # [s] of a tick
    per_tick: float  # samples of the path, at full scale
    max_rate: Array  # (4,) [rad/s]
    max_acceleration: Array  # (4,) [rad/s^2]
    scale_rate_limit: float  # [1/s]
    scale_jerk: float  # [1/s^2]
    wanted: float  # the time scale to go to: 0 hold, 1 run
    offset: Array  # (4,) [rad] whole turns
    # Where it is
    phase: float  # [samples] on the path
    scale: float  # of time
    scale_rate: float  # [1/s]


PLAYER = np.dtype(
    (
        np.record,
        np.dtype(
            [
                ("first", "i8"), ("last", "i8"), ("chart", "i8"), ("dt", "f8"), ("per_tick", "f8"),
                ("max_rate", "f8", 4), ("max_acceleration", "f8", 4), ("scale_rate_limit", "f8"), ("scale_jerk", "f8"),
                ("wanted", "f8"), ("offset", "f8", 4), ("phase", "f8"), ("scale", "f8"), ("scale_rate", "f8"),
            ],
            align=True,
        ),
    )
)  # fmt: skip


@kernel
def _limit_share(player: Player, x: Array, x1: Array, v1: Array) -> float:
    """The worst share of a rate or acceleration limit that the step x1 -> x takes; 1 is the limit."""
    largest = 0.0
    for i in range(4):
        v = (x[i] - x1[i]) / player.dt
        a = (v - v1[i]) / player.dt
        largest = max(largest, abs(v) / player.max_rate[i], abs(a) / player.max_acceleration[i])
    return largest


@kernel
def _wanted_rate(player: Player) -> float:
    """The rate of change of the time scale that would be taken, but for the frames' limits [1/s]."""
    wanted = player.wanted
    if player.per_tick == 1.0 and wanted == 1.0 and abs(player.phase - np.rint(player.phase)) >= _SNAP:
        wanted = 1.0 - _SLIP * player.dt * (player.phase - math.floor(player.phase))
    gap = wanted - player.scale
    rate = min(player.scale_rate_limit, math.sqrt(2.0 * player.scale_jerk * abs(gap)))
    # Speeding up the change is jerk-limited; slowing it down follows the square root above.
    rate = min(rate, abs(player.scale_rate) + player.scale_jerk * player.dt)
    return math.copysign(min(rate, abs(gap) / player.dt), gap)


@kernel
def _turned(path: Path, phase: float, offset: Array, x: Array, q: Array) -> bool:
    """`evaluate`, x in the turns that the rig is in."""
    flight = evaluate(path, phase, x, q)
    for i in range(4):
        x[i] += offset[i]
    return flight


@kernel
def advance(angles: Array, target: Array, error: Array, players: Any, x1: Array, v1: Array, x: Array, q: Array) -> int:
    """One tick along the path: x, q (4,) <- the next command and attitude; 1 in the flight, 0 in a lead, -1 at the end.

    angles, target (n, 4), error (n,): see `Path`; players (1,) `PLAYER`; x1, v1 (4,) the last command and its rate. The
    scale moves as fast as it may without any frame leaving its rate or acceleration limit.
    """
    player = players[0]
    path = Path(angles, target, error, player.first, player.last, player.chart)
    end = angles.shape[0] - 1.0
    phase = player.phase
    scale = player.scale
    rate = _wanted_rate(player)
    best = math.inf
    best_phase = phase
    best_rate = 0.0
    for attempt in range(8):
        # Less and less of the wanted change, then the other way: 0 is as safe as the plan itself.
        share = 1.0 - 0.25 * attempt if attempt < 5 else -0.25 * (attempt - 4)
        change = rate * share
        to = phase + min(1.0, max(0.0, scale + change * player.dt)) * player.per_tick
        nearest = np.rint(to)
        if abs(to - nearest) < _SNAP:
            to = nearest
        to = min(to, end)
        flight = _turned(path, to, player.offset, x, q)
        taken = _limit_share(player, x, x1, v1)
        if taken < best:
            best = taken
            best_phase = to
            best_rate = change
        if taken <= 1.0 + _SLACK or rate == 0.0:
            best_phase = to
            best_rate = change
            break
    else:
        flight = _turned(path, best_phase, player.offset, x, q)
    player.scale = min(1.0, max(0.0, scale + best_rate * player.dt))
    player.scale_rate = best_rate
    player.phase = best_phase
    if best_phase >= end:
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
        self._rate_hz, self._start_s = info.rate_hz, info.start_s
        self._turns = np.isinf(rig.position_min) & np.isinf(rig.position_max)
        self._players = np.zeros(1, PLAYER)
        player: Player = self._players[0]
        player.first = self._first = info.lead_in_samples
        player.last = info.samples - 1 - info.lead_out_samples
        player.chart = 0 if not rig.geometry.redundant else 2 if rig.geometry.horizontal else 1
        player.dt = 1.0 / rate_hz
        ratio = info.rate_hz / rate_hz
        player.per_tick = 1.0 if abs(ratio - 1.0) < 1e-12 else ratio
        player.max_rate[:], player.max_acceleration[:] = rig.max_rate, rig.max_acceleration
        player.scale_rate_limit, player.scale_jerk = scale_rate, scale_jerk
        # Views, for the loop: to read a record's attribute takes microseconds.
        self._wanted, self._phase, self._scale = (self._players[name] for name in ("wanted", "phase", "scale"))
        self._scale_rate, self._offset = self._players["scale_rate"], self._players["offset"][0]
        self.scale_to(1.0)

    def scale_to(self, scale: float) -> None:
        """The time scale to go to: 0 hold, 1 run."""
        self._wanted[0] = scale

    def start_pose(self, near: Array) -> Array:
        """Where the path begins (4,) [rad]; frames that turn without end take the turn nearest to `near` (4,)."""
        turns = np.round((near - self._angles[0]) / (2.0 * math.pi))
        self._offset[:] = np.where(self._turns, turns * 2.0 * math.pi, 0.0)
        return np.asarray(self._angles[0] + self._offset)

    def rewind(self) -> None:
        """To the start, at full scale: the path begins at rest."""
        self._phase[0], self._scale[0], self._scale_rate[0] = 0.0, 1.0, 0.0
        self.scale_to(1.0)

    def tick(self, x1: Array, v1: Array, x: Array, q: Array) -> int:
        """One tick: fills x and q; 1 in the flight, 0 in a lead, -1 at the end (see `advance`)."""
        return int(advance(self._angles, self._target, self._error, self._players, x1, v1, x, q))

    @property
    def time_s(self) -> float:
        """The flight's own time; before its start in the lead-in [s]."""
        return float((self._phase[0] - self._first) / self._rate_hz + self._start_s)

    @property
    def scale(self) -> float:
        """1 at full speed, 0 held."""
        return float(self._scale[0])
