"""A start pose as people give it, in degrees, against a rig: what is wrong is said in degrees, too."""

import math
from collections.abc import Sequence

from fullpose.errors import InputError
from fullpose.rig import FRAMES, Rig

# Beyond, an angle is a slip of the pen, and its last digit in double precision is more than 1e-9 deg.
LARGEST_DEG = 1e6


def start_pose(start_deg: Sequence[float], rig: Rig, name: str) -> tuple[float, float, float, float]:
    """The pose [rad] of four angles, base first; `name` is what they are called in messages.

    Raises `InputError` where one is no number, too large, or outside the rig's range.
    """
    if len(start_deg) != len(FRAMES):
        raise InputError(name, None, len(start_deg), "four angles in degrees, base first")
    for i, angle in enumerate(start_deg):
        if not abs(angle) <= LARGEST_DEG:
            raise _wrong(name, i, angle, f"a number within +-{LARGEST_DEG:g} deg")
    base, outer, middle, inner = map(math.radians, start_deg)
    pose = (base, outer, middle, inner)
    check_range(pose, rig, name)
    return pose


def check_range(pose: Sequence[float], rig: Rig, name: str) -> None:
    """Raise `InputError` where a pose (4,) [rad] is outside the rig's range."""
    for i in rig.geometry.frames:
        low, high = rig.frames[i].min, rig.frames[i].max
        if not low <= pose[i] <= high:
            allowed = f"{math.degrees(low):.10g} to {math.degrees(high):.10g} deg, the range of {rig.name}"
            raise _wrong(name, i, math.degrees(pose[i]), allowed)


def _wrong(name: str, frame: int, angle: float, expected: str) -> InputError:
    return InputError(f"{name}[{frame}] ({FRAMES[frame]})", None, float(f"{angle:.10g}"), expected)
