"""Drives by name: those that come with Fullpose, and those of other packages (entry points `fullpose.drives`)."""

from importlib.metadata import entry_points
from typing import Any

from fullpose.rig import Rig
from fullpose_server.drives.base import Drive, DriveError, DriveFactory

GROUP = "fullpose.drives"
BUILTIN = {"simulated": "fullpose_server.drives.simulated:make", "udp": "fullpose_server.drives.udp:make"}


def names() -> list[str]:
    """Every drive that `make` knows."""
    return sorted({*BUILTIN, *(point.name for point in entry_points(group=GROUP))})


def make(name: str, rig: Rig, rate_hz: float, options: dict[str, Any]) -> Drive:
    """The drive `name`, unconnected. Raises `DriveError` where there is none, or it cannot be loaded."""
    return _factory(name)(rig, rate_hz, options)


def _factory(name: str) -> DriveFactory:
    from importlib import import_module  # a driver's own imports stay out of processes that do not use it

    if name in BUILTIN:
        module, _, attribute = BUILTIN[name].partition(":")
        found: DriveFactory = getattr(import_module(module), attribute)
        return found
    for point in entry_points(group=GROUP, name=name):
        try:
            loaded: DriveFactory = point.load()
        except Exception as cause:
            raise DriveError(f"drive {name!r} of {point.value} cannot be loaded: {cause}") from cause
        return loaded
    raise DriveError(f"no drive {name!r}: there are {', '.join(names())}")
