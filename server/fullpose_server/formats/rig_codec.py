"""A rig as values that JSON can hold: for the configuration of its process and for the requests of jobs. Radians."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from fullpose.rig import FRAMES, FrameLimits, Geometry, Rig


def rig_values(rig: Rig) -> dict[str, Any]:
    """`rig` by its keys: a limit that is not there is left out."""
    frames = {
        name: {each.name: value for each in fields(frame) if math.isfinite(value := getattr(frame, each.name))}
        for name, frame in zip(FRAMES, rig.frames, strict=True)
    }
    return {"name": rig.name, "geometry": str(rig.geometry), "frames": frames}


def rig_from_values(values: Mapping[str, Any]) -> Rig:
    """The inverse of `rig_values`. Raises KeyError, ValueError or `RigError` on what is no rig.

    Earlier servers kept the frames as a list, infinities among their limits.
    """
    given = values["frames"]
    kept = [given[name] for name in FRAMES] if isinstance(given, Mapping) else given
    base, outer, middle, inner = (FrameLimits(**frame) for frame in kept)
    return Rig(values["name"], Geometry(values["geometry"]), (base, outer, middle, inner))
