"""How one rig is operated: its drive, the guard's tolerances, its motions, its silences, its process.

What a rig file's own tables say and what a rig process is told; not part of the rig that plans are made for.
"""

import math
from dataclasses import dataclass, field
from typing import Any

from fullpose_server.session.machine import SilencePolicy

OWNER_SILENCE = SilencePolicy()
SERVER_SILENCE = SilencePolicy(1.0, 5.0, 60.0)


class ConfigError(ValueError):
    """A value that cannot be: which field, which value, and what was expected."""

    def __init__(self, field: str, value: Any, expected: str) -> None:
        super().__init__(f"{field} = {value!r}: expected {expected}")
        self.field = field
        self.value = value
        self.expected = expected


def check_positive(config: Any, *names: str) -> None:
    """Raise `ConfigError` unless these fields of a dataclass are finite numbers above zero."""
    for name in names:
        value = getattr(config, name)
        if not 0.0 < value < math.inf:
            raise ConfigError(name, value, "a finite number above zero")


def check_not_negative(config: Any, *names: str) -> None:
    """Raise `ConfigError` unless these fields of a dataclass are finite numbers of zero or more."""
    for name in names:
        value = getattr(config, name)
        if not 0.0 <= value < math.inf:
            raise ConfigError(name, value, "a finite number of zero or more")


@dataclass(frozen=True)
class Tolerance:
    """Two levels of one check: warn raises an alarm, trip brakes. None: that level is off; zero is a real limit."""

    warn: float | None
    trip: float | None

    def __post_init__(self) -> None:
        for name in ("warn", "trip"):
            if getattr(self, name) is not None:
                check_not_negative(self, name)
        if self.warn is not None and self.trip is not None and self.warn > self.trip:
            raise ConfigError("warn", self.warn, f"at most trip, which is {self.trip!r}")


@dataclass(frozen=True)
class GuardConfig:
    """Tolerances of the guard. Position, rate and acceleration limits are the rig's own."""

    following_deg: Tolerance = Tolerance(1.0, 3.0)  # a frame against what it was commanded
    attitude_deg: Tolerance = Tolerance(1.0, 5.0)  # the payload against the flight, geodesic
    lateness_ms: Tolerance | None = None  # of one tick; None: as the loop's profile has it
    misses_per_s: Tolerance | None = None  # deadlines missed in the last second; None: likewise
    stale_ms: Tolerance = Tolerance(20.0, 100.0)  # age of the live source's newest sample
    max_step_deg: float = 5.0  # between two commands, whatever the rig's rates

    def __post_init__(self) -> None:
        check_not_negative(self, "max_step_deg")  # zero is a limit too: nothing may move


@dataclass(frozen=True)
class MotionConfig:
    """How the rig moves when it is not on a path. Fractions are of the rig's limits; the others cap or replace them."""

    move_rate_deg_s: float = 60.0
    move_acceleration_deg_s2: float = 120.0
    move_jerk_deg_s3: float = 1200.0
    stop_fraction: float = 0.8  # of the acceleration limit, for a stop; an E-stop takes all of it
    unlimited_brake_deg_s2: float = 2000.0  # where a frame has no acceleration limit
    hold_scale_rate: float = 2.0  # fastest change of the path's time scale [1/s]
    hold_scale_jerk: float = 20.0  # [1/s^2]

    def __post_init__(self) -> None:
        check_positive(self, *self.__dataclass_fields__)
        if self.stop_fraction > 1.0:
            raise ConfigError("stop_fraction", self.stop_fraction, "above zero, at most 1")


@dataclass(frozen=True, kw_only=True)
class OperatingConfig:
    """All of it. `drive_options` are the drive's own, as JSON can hold them; the drive checks them when it is made."""

    drive: str = "simulated"
    drive_options: dict[str, Any] = field(default_factory=dict)
    guard: GuardConfig = GuardConfig()
    motion: MotionConfig = MotionConfig()
    owner: SilencePolicy = OWNER_SILENCE  # of who holds the lease
    server: SilencePolicy = SERVER_SILENCE  # of the server, as the rig process sees it
    realtime_priority: int | None = 60  # None: ordinary scheduling
    cpu: int | None = None  # None: any
    min_free_mb: float = 200.0  # below it the session refuses to arm

    def __post_init__(self) -> None:
        if not self.drive:
            raise ConfigError("drive", self.drive, "a drive's name")
        for name in ("owner", "server"):
            policy: SilencePolicy = getattr(self, name)
            if policy.disarm_s == math.inf:  # they rise, so the others are finite where it is
                raise ConfigError(name, policy, "finite times")
        priority, cpu = self.realtime_priority, self.cpu
        if priority is not None and not 1 <= priority <= 99:
            raise ConfigError("realtime_priority", priority, "1 to 99, or none for ordinary scheduling")
        if cpu is not None and not cpu >= 0:
            raise ConfigError("cpu", cpu, "a processor's number from zero up, or none for any")
        check_not_negative(self, "min_free_mb")
