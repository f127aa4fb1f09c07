"""What a rig process is told at its start: one JSON file, one frozen dataclass."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from server.session.machine import SilencePolicy
from solver.rig import FRAMES, FrameLimits, Geometry, Rig

OWNER_SILENCE = SilencePolicy()
SERVER_SILENCE = SilencePolicy(1.0, 5.0, 60.0)
_LIMIT_KEYS = ("min", "max", "max_rate", "max_acceleration", "weight", "home")


@dataclass(frozen=True)
class Tolerance:
    """Two levels of one check: warn raises an alarm, trip brakes. None: that level is off; zero is a real limit."""

    warn: float | None
    trip: float | None

    def __post_init__(self) -> None:
        for level in (self.warn, self.trip):
            if level is not None and not level >= 0.0:
                raise ValueError(f"tolerance {self}: expected levels of zero or more, or none")


@dataclass(frozen=True)
class GuardConfig:
    """Tolerances of the guard. Position, rate and acceleration limits are the rig's own."""

    following_deg: Tolerance = Tolerance(1.0, 3.0)  # a frame against what it was commanded
    attitude_deg: Tolerance = Tolerance(1.0, 5.0)  # the payload against the flight, geodesic
    lateness_ms: Tolerance = Tolerance(2.0, 50.0)  # of one tick
    misses_per_s: Tolerance = Tolerance(20.0, 200.0)  # deadlines missed in the last second
    stale_ms: Tolerance = Tolerance(20.0, 100.0)  # age of the live source's newest sample
    max_step_deg: float = 5.0  # between two commands, whatever the rig's rates


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


@dataclass(frozen=True)
class LiveConfig:
    """The live source: where its UDP port listens (None: no port), and how jitter is bridged."""

    udp_port: int | None = None
    udp_host: str = "127.0.0.1"
    delay_ms: float = 5.0  # the target is the source's attitude this long ago: jitter up to it is interpolated
    extrapolate_ms: float = 50.0


@dataclass(frozen=True)
class RigConfig:
    """Everything a rig process needs. Paths are absolute."""

    name: str
    rig: Rig
    directory: Path  # of this rig's socket, lock and notes
    runs: Path  # where records go
    rate_hz: float = 1000.0
    drive: str = "simulated"
    drive_options: dict[str, Any] = field(default_factory=dict)
    owner: SilencePolicy = OWNER_SILENCE
    server: SilencePolicy = SERVER_SILENCE
    exit_idle_s: float = 120.0  # without a server and at rest, the process ends by itself
    realtime_priority: int | None = 60  # None: ordinary scheduling
    cpu: int | None = None
    guard: GuardConfig = GuardConfig()
    motion: MotionConfig = MotionConfig()
    live: LiveConfig = LiveConfig()
    min_free_mb: float = 200.0  # below it the session refuses to arm
    after_loss: str | None = None  # why an earlier process of this rig died

    def __post_init__(self) -> None:
        if not 100.0 <= self.rate_hz <= 4000.0:
            raise ValueError(f"rate_hz = {self.rate_hz}: expected 100 to 4000")


def rig_to_dict(rig: Rig) -> dict[str, Any]:
    """`rig` as JSON can hold it [rad]: a limit that is not there is left out."""
    frames = {
        name: {key: value for key in _LIMIT_KEYS if math.isfinite(value := getattr(frame, key))}
        for name, frame in zip(FRAMES, rig.frames, strict=True)
    }
    return {"name": rig.name, "geometry": str(rig.geometry), "frames": frames}


def rig_from_dict(raw: dict[str, Any]) -> Rig:
    """The inverse of `rig_to_dict`. Raises KeyError, ValueError or `RigError` on what is no rig."""
    base, outer, middle, inner = (FrameLimits(**raw["frames"][name]) for name in FRAMES)
    return Rig(raw["name"], Geometry(raw["geometry"]), (base, outer, middle, inner))


def encode(config: RigConfig) -> bytes:
    """`config` as JSON."""

    def hook(value: Any) -> Any:
        if isinstance(value, Path):
            return str(value)
        raise NotImplementedError(type(value))

    raw = {name: getattr(config, name) for name in config.__dataclass_fields__}
    return msgspec.json.format(msgspec.json.encode(raw | {"rig": rig_to_dict(config.rig)}, enc_hook=hook))


def decode(data: bytes) -> RigConfig:
    """The inverse of `encode`. Raises ValueError with what is wrong."""
    raw = msgspec.json.decode(data)
    raw["rig"] = rig_from_dict(raw["rig"])

    def hook(kind: type, value: Any) -> Any:
        if kind is Path:
            return Path(value)
        raise NotImplementedError(kind)

    kept = raw.pop("rig")
    fields = {}
    for name, field_type in _types().items():
        if name in raw:
            fields[name] = msgspec.convert(raw[name], field_type, dec_hook=hook)
    return RigConfig(rig=kept, **fields)


def _types() -> dict[str, Any]:
    return {name: kind.type for name, kind in RigConfig.__dataclass_fields__.items() if name != "rig"}
