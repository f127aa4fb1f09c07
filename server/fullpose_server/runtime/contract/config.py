"""What a rig process is told at its start: one JSON file, one frozen dataclass."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from fullpose.rig import Rig
from fullpose_server.formats.rig_codec import rig_from_values, rig_values
from fullpose_server.operating import (
    ConfigError,
    GuardConfig,
    MotionConfig,
    OperatingConfig,
    Tolerance,
    check_not_negative,
    check_positive,
)
from fullpose_server.session.alarms import Shelf

# What rig files say too is in `fullpose_server.operating`, below the store; the loop finds all it needs here.
__all__ = [
    "GuardConfig",
    "LiveConfig",
    "MotionConfig",
    "OperatingConfig",
    "RigConfig",
    "Tolerance",
    "decode",
    "encode",
]


UNLIMITED_RATE_DEG_S = 3600.0  # ten turns a second


@dataclass(frozen=True)
class LiveConfig:
    """The live source: where its UDP port listens (None: no port), and how jitter is bridged."""

    udp_port: int | None = None
    udp_host: str = "127.0.0.1"
    delay_ms: float = 5.0  # the target is the source's attitude this long ago: jitter up to it is interpolated
    extrapolate_ms: float = 50.0
    max_rate_deg_s: float | None = None  # of the body: a sample beyond it is refused; None: see `plausible_rate`

    def __post_init__(self) -> None:
        if self.udp_port is not None and not 1 <= self.udp_port <= 65535:
            raise ConfigError("udp_port", self.udp_port, "1 to 65535, or none for no port")
        if not self.udp_host:
            raise ConfigError("udp_host", self.udp_host, "an address of this machine")
        check_not_negative(self, "delay_ms")
        check_positive(self, "extrapolate_ms")
        if self.max_rate_deg_s is not None:
            check_positive(self, "max_rate_deg_s")

    def plausible_rate(self, rig: Rig) -> float:
        """The greatest body rate of a sample that is used [rad/s].

        As said; otherwise what the frames could ever turn the payload at, all of them together at their rate limits;
        `UNLIMITED_RATE_DEG_S` for a rig with a frame that has none.
        """
        if self.max_rate_deg_s is not None:
            return math.radians(self.max_rate_deg_s)
        together = float(rig.max_rate[list(rig.geometry.frames)].sum())
        return together if math.isfinite(together) else math.radians(UNLIMITED_RATE_DEG_S)


@dataclass(frozen=True)
class RigConfig(OperatingConfig):
    """Everything a rig process needs: how the rig is operated (see `OperatingConfig`), and this. Paths are absolute."""

    name: str
    rig: Rig
    directory: Path  # of this rig's socket, lock and notes
    runs: Path  # where records go
    rate_hz: float = 1000.0
    exit_idle_s: float = 120.0  # without a server and at rest, the process ends by itself
    live: LiveConfig = LiveConfig()
    after_loss: str | None = None  # why an earlier process of this rig died
    shelves: tuple[Shelf, ...] = ()  # that were put up in it

    def __post_init__(self) -> None:
        if not self.name:
            raise ConfigError("name", self.name, "the rig's name")
        if not 100.0 <= self.rate_hz <= 4000.0:
            raise ConfigError("rate_hz", self.rate_hz, "100 to 4000")
        check_positive(self, "exit_idle_s")
        super().__post_init__()


def encode(config: RigConfig) -> bytes:
    """`config` as JSON."""

    def hook(value: Any) -> Any:
        if isinstance(value, Path):
            return str(value)
        raise NotImplementedError(type(value))

    raw = {name: getattr(config, name) for name in config.__dataclass_fields__}
    return msgspec.json.format(msgspec.json.encode(raw | {"rig": rig_values(config.rig)}, enc_hook=hook))


def decode(data: bytes) -> RigConfig:
    """The inverse of `encode`. Raises ValueError with what is wrong."""
    raw = msgspec.json.decode(data)
    raw["rig"] = rig_from_values(raw["rig"])

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
