"""Drives by name: those that come with Fullpose, and those of other packages (entry points `fullpose.drives`)."""

from importlib.metadata import entry_points
from typing import Any

from fullpose.rig import Rig
from fullpose_server.drives.base import Drive, DriveError, DriveFactory

GROUP = "fullpose.drives"
_PARTS = ("name", *(part for part in vars(Drive) if not part.startswith("_")))
BUILTIN = {"simulated": "fullpose_server.drives.simulated:make", "udp": "fullpose_server.drives.udp:make"}


def names() -> list[str]:
    """Every drive that `make` knows."""
    return sorted({*BUILTIN, *(point.name for point in entry_points(group=GROUP))})


def make(name: str, rig: Rig, rate_hz: float, options: dict[str, Any]) -> Drive:
    """The drive `name`, unconnected. Raises `DriveError` where there is none, or it cannot be loaded or made."""
    factory = _factory(name)
    try:
        made = factory(rig, rate_hz, options)
    except DriveError:
        raise
    except (Exception, SystemExit) as cause:
        raise DriveError(f"drive {name!r} cannot be made: {type(cause).__name__}: {cause}") from cause
    missing = [part for part in _PARTS if not hasattr(made, part)]
    if missing:
        raise DriveError(f"drive {name!r} made {type(made).__name__}, which has no {', '.join(missing)}")
    return made


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
