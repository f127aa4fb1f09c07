"""A simulated table: a second-order servo per frame, with an encoder, noise, backlash and faults on a script."""

import math
from collections import deque
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.drives import servo
from fullpose_server.drives.base import Drive, DriveError, Status
from fullpose_server.drives.options import options_of

# A real motor has limits where the rig's description gives none.
_MOST_RATE = math.radians(2000.0)
_MOST_ACCELERATION = math.radians(20000.0)
_NOISE_ROWS = 8192


@dataclass(frozen=True)
class ScriptedFault:
    """A fault that begins `at_s` after the drive was enabled and lasts `duration_s` (None: for good)."""

    kind: str  # stuck, runaway, encoder, latency, link
    at_s: float
    frame: str | None = None  # for stuck, runaway, encoder
    duration_s: float | None = None
    ticks: int = 0  # of latency

    def __post_init__(self) -> None:
        if self.kind not in ("stuck", "runaway", "encoder", "latency", "link"):
            raise DriveError(f"fault {self.kind!r}: expected stuck, runaway, encoder, latency or link")
        if self.kind in ("stuck", "runaway", "encoder") and self.frame not in FRAMES:
            raise DriveError(f"fault {self.kind} of frame {self.frame!r}: expected one of {', '.join(FRAMES)}")

    def active(self, elapsed: float) -> bool:
        """Whether it stands `elapsed` seconds after enabling."""
        return elapsed >= self.at_s and (self.duration_s is None or elapsed < self.at_s + self.duration_s)


@dataclass(frozen=True)
class SimulatedOptions:
    """The table that is simulated; defaults are those of a good one."""

    bandwidth_hz: float = 40.0
    damping: float = 0.8
    rate_margin: float = 1.2  # the motors' limits over the rig's
    acceleration_margin: float = 1.5
    feed_forward: float = 0.98  # of the acceleration: the model of the inertia is never perfect
    encoder_bits: int = 24
    noise_deg: float = 2e-5
    backlash_deg: float = 0.0
    seed: int = 0
    watchdog_s: float = 0.05
    start_deg: list[float] | None = None  # None: at home
    faults: list[ScriptedFault] = field(default_factory=list)


class SimulatedDrive:
    """See `Drive`. Deterministic for a seed and a sequence of calls."""

    name = "simulated"

    def __init__(self, rig: Rig, rate_hz: float, options: SimulatedOptions) -> None:
        self._options = options
        self._tables = np.zeros(1, servo.TABLE)
        table: servo.Table = self._tables[0]
        table.dt = self._dt = 1.0 / rate_hz
        table.mode = servo.DISABLED
        table.watchdog = self._watchdog = max(2, round(options.watchdog_s * rate_hz))
        table.present[list(rig.geometry.frames)] = 1
        table.motor[:] = table.load[:] = rig.home if options.start_deg is None else np.radians(options.start_deg)
        table.due[:] = table.load
        table.omega[:] = 2.0 * math.pi * options.bandwidth_hz
        table.damping[:] = options.damping
        table.max_rate[:] = np.minimum(rig.max_rate * options.rate_margin, _MOST_RATE)
        most = np.minimum(rig.max_acceleration * options.acceleration_margin, _MOST_ACCELERATION)
        table.max_acceleration[:] = most
        table.backlash[:] = math.radians(options.backlash_deg)
        table.feed_forward[:] = options.feed_forward
        # Views, for the loop: to read a record's attribute takes microseconds.
        self._mode, self._quiet = self._tables["mode"], self._tables["quiet"]
        self._motor, self._rate, self._load = (self._tables[name][0] for name in ("motor", "rate", "load"))
        self._due, self._demand = self._tables["due"][0], self._tables["demand"][0]
        self._stuck, self._runaway = self._tables["stuck"][0], self._tables["runaway"][0]
        self._resolution = 2.0 * math.pi / 2**options.encoder_bits
        generator = np.random.default_rng(options.seed)
        self._noise = generator.normal(0.0, math.radians(options.noise_deg), (_NOISE_ROWS, 4))
        self._noise[:, table.present == 0] = 0.0
        self._late: deque[Array] = deque()  # demands on their way, under a latency fault
        self._status = Status.OK
        self._row = 0
        self._read_at = self._enabled_at = math.nan
        self._epoch = self._sequence = -1
        self._linked = False
        servo.advance(self._tables, 0)  # compiles the kernel now, not in the first tick

    def connect(self, now: float) -> None:
        """Always succeeds."""
        self._linked = True
        self._read_at = now

    def enable(self) -> None:
        """Follow writes from where the table stands."""
        if not self._linked:
            raise DriveError("the simulated table is not connected")
        if math.isnan(self._enabled_at):
            self._enabled_at = self._read_at
        self._demand[0] = self._due[:] = self._motor
        self._demand[1:] = 0.0
        self._late.clear()
        self._quiet[0] = 0
        self._epoch = self._sequence = -1  # a new series: the controller may be a new process
        self._mode[0] = servo.ENABLED
        self._status = Status.OK

    def read(self, now: float, position: Array, rate: Array) -> int:
        """Advance the table to `now` and measure it."""
        elapsed = now - self._read_at
        # The loop's jitter is not the table's: a whole number of ticks passes, several after a stall.
        ticks = max(1, round(elapsed / self._dt))
        self._read_at = now
        latency, broken, link = self._faults(now)
        if link:
            self._linked = False
        if not self._linked:
            self._quiet[0] = self._watchdog + 1
        if latency == 0 and self._late:
            self._demand[:] = self._late[-1]
            self._late.clear()
        while len(self._late) > latency:
            self._demand[:] = self._late.popleft()
        before = self._mode[0]
        servo.advance(self._tables, ticks)
        self._quiet[0] += ticks
        self._due[:] = self._demand[0]
        if before == servo.ENABLED and self._mode[0] == servo.BRAKING:
            self._status |= Status.WATCHDOG
        if not self._linked:
            return int(self._status | Status.LINK_LOST)
        self._row = (self._row + 1) % _NOISE_ROWS
        position[:] = np.round(self._load / self._resolution) * self._resolution + self._noise[self._row]
        rate[:] = self._rate
        status = self._status
        if broken >= 0:
            position[broken] = math.nan
            status |= Status.ENCODER
        if self._mode[0] == servo.ENABLED:
            status |= Status.ENABLED
        elif self._mode[0] == servo.BRAKING:
            status |= Status.BRAKING
        self._status &= ~Status.STALE_WRITE
        return int(status)

    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        """Take the demand for the next tick, unless it is an old one."""
        if not self._linked or epoch < self._epoch or sequence <= self._sequence:
            self._status |= Status.STALE_WRITE
            return
        self._epoch, self._sequence = epoch, sequence
        self._quiet[0] = 0
        if self._late or self._latency_now:
            self._late.append(np.array([position, rate, acceleration]))
            return
        self._demand[0] = position
        self._demand[1] = rate
        self._demand[2] = acceleration

    def brake(self) -> None:
        """Brake with all the motors have."""
        self._mode[0] = servo.BRAKING

    def emergency_brake(self) -> None:
        """The same: one number is written, whoever reads it meanwhile."""
        self._mode[0] = servo.BRAKING

    def disable(self) -> None:
        """Power off; the brakes stop what moves."""
        self._mode[0] = servo.DISABLED

    def close(self) -> None:
        """Let the link go."""
        self._mode[0] = servo.BRAKING
        self._linked = False

    _latency_now = 0

    def _faults(self, now: float) -> tuple[int, int, bool]:
        """(latency in ticks, frame whose encoder is lost or -1, whether the link is cut) by the script at `now`."""
        latency, broken, link = 0, -1, False
        if self._options.faults and not math.isnan(self._enabled_at):
            self._stuck[:] = self._runaway[:] = 0
            for fault in self._options.faults:
                if not fault.active(now - self._enabled_at):
                    continue
                if fault.kind == "latency":
                    latency = fault.ticks
                elif fault.kind == "link":
                    link = True
                elif fault.kind == "encoder":
                    broken = FRAMES.index(fault.frame or "")
                else:
                    disturbed = self._stuck if fault.kind == "stuck" else self._runaway
                    disturbed[FRAMES.index(fault.frame or "")] = 1
        self._latency_now = latency
        return latency, broken, link


def make(rig: Rig, rate_hz: float, options: dict[str, Any]) -> Drive:
    """The simulated drive (see `DriveFactory`); `options` are `SimulatedOptions`."""
    return SimulatedDrive(rig, rate_hz, options_of("simulated", SimulatedOptions, options))
