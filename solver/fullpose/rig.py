"""Rigs: the four geometries, their frames and limits (mathematics, section 2).

Arrays have one column a frame, from the outside in: base, outer, middle, inner. A three-axis rig has no base; its
base column is held at zero, so that every array in this package is (n, 4).
"""

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Integers
from fullpose.errors import RigError

X, Y, Z, ABSENT = 0, 1, 2, -1


class Frame(StrEnum):
    """The frames from the outside in: a frame's index is its column in every array."""

    BASE = "base"
    OUTER = "outer"
    MIDDLE = "middle"
    INNER = "inner"


class Limit(StrEnum):
    """The kinds of limits that a frame has, by the order of the derivative that is limited."""

    POSITION = "position"
    RATE = "rate"
    ACCELERATION = "acceleration"
    JERK = "jerk"


FRAMES = tuple(Frame)
LIMITS = tuple(Limit)


class Geometry(StrEnum):
    """The order of the axes, from the outside in."""

    VERTICAL_4 = "vertical-4"
    HORIZONTAL_4 = "horizontal-4"
    VERTICAL_3 = "vertical-3"
    HORIZONTAL_3 = "horizontal-3"

    @property
    def axes(self) -> tuple[int, int, int, int]:
        """Axis of d1..d4: X, Y, Z or ABSENT."""
        return _AXES[self]

    @property
    def redundant(self) -> bool:
        """Whether the rig has the fourth, redundant axis."""
        return _AXES[self][0] != ABSENT

    @property
    def horizontal(self) -> bool:
        """Whether the charts work on axes with y and z swapped."""
        return self in (Geometry.HORIZONTAL_4, Geometry.HORIZONTAL_3)

    @property
    def frames(self) -> tuple[int, ...]:
        """Columns that are real frames."""
        return (0, 1, 2, 3) if self.redundant else (1, 2, 3)


_AXES = {
    Geometry.VERTICAL_4: (Y, Z, Y, X),
    Geometry.HORIZONTAL_4: (Z, Y, Z, X),
    Geometry.VERTICAL_3: (ABSENT, Y, Z, X),
    Geometry.HORIZONTAL_3: (ABSENT, Z, Y, X),
}


@dataclass(frozen=True)
class FrameLimits:
    """One frame's limits [rad, rad/s, rad/s^2, rad/s^3]; infinity: no limit. Both positions infinite: continuous."""

    min: float = -math.inf
    max: float = math.inf
    max_rate: float = math.inf
    max_acceleration: float = math.inf
    weight: float = 1.0
    home: float = 0.0
    max_jerk: float = math.inf

    @property
    def continuous(self) -> bool:
        """Whether the frame turns without end."""
        return math.isinf(self.min) and math.isinf(self.max)


@dataclass(frozen=True)
class Rig:
    """A rig: geometry and the limits of its frames, base first.

    Raises `RigError` where a limit is not a number, not positive, or the range is empty or does not hold home.
    """

    name: str
    geometry: Geometry
    frames: tuple[FrameLimits, FrameLimits, FrameLimits, FrameLimits] = field(
        default=(FrameLimits(), FrameLimits(), FrameLimits(), FrameLimits())
    )

    def __post_init__(self) -> None:
        for name, frame in zip(FRAMES, self.frames, strict=True):
            if math.isnan(frame.min) or math.isnan(frame.max) or not frame.min <= frame.max:
                raise RigError(f"frames.{name}", (frame.min, frame.max), "min <= max")
            if math.isinf(frame.min) != math.isinf(frame.max):
                raise RigError(f"frames.{name}", (frame.min, frame.max), "both of min and max, or neither")
            if not frame.min <= frame.home <= frame.max:
                raise RigError(f"frames.{name}.home", frame.home, "a position inside the range")
            for key in ("max_rate", "max_acceleration", "max_jerk", "weight"):
                value = getattr(frame, key)
                if not value > 0.0:
                    raise RigError(f"frames.{name}.{key}", value, "a number above zero")
            if not math.isfinite(frame.weight):
                raise RigError(f"frames.{name}.weight", frame.weight, "a finite number above zero")

    @cached_property
    def axes(self) -> Integers:
        """Axis codes of d1..d4. (4,)"""
        return _readonly(np.array(self.geometry.axes, dtype=np.int64))

    @cached_property
    def position_min(self) -> NDArray[np.float64]:
        """(4,) [rad]; -inf for a continuous frame; 0 for a frame the rig has not."""
        return self._column("min", 0.0)

    @cached_property
    def position_max(self) -> NDArray[np.float64]:
        """(4,) [rad]; +inf for a continuous frame; 0 for a frame the rig has not."""
        return self._column("max", 0.0)

    @cached_property
    def max_rate(self) -> NDArray[np.float64]:
        """(4,) [rad/s]; inf for no limit."""
        return self._column("max_rate", math.inf)

    @cached_property
    def max_acceleration(self) -> NDArray[np.float64]:
        """(4,) [rad/s^2]; inf for no limit."""
        return self._column("max_acceleration", math.inf)

    @cached_property
    def max_jerk(self) -> NDArray[np.float64]:
        """(4,) [rad/s^3]; inf for no limit."""
        return self._column("max_jerk", math.inf)

    @property
    def jerk_limited(self) -> bool:
        """Whether any frame has a jerk limit."""
        return bool(np.isfinite(self.max_jerk).any())

    @cached_property
    def weight(self) -> NDArray[np.float64]:
        """Diagonal of W. (4,)"""
        return self._column("weight", 1.0)

    @cached_property
    def home(self) -> NDArray[np.float64]:
        """(4,) [rad]"""
        return self._column("home", 0.0)

    def _column(self, key: str, absent: float) -> NDArray[np.float64]:
        present = self.geometry.frames
        values = [getattr(frame, key) if i in present else absent for i, frame in enumerate(self.frames)]
        return _readonly(np.array(values, dtype=np.float64))


def _readonly(array: NDArray[Any]) -> NDArray[Any]:
    array.setflags(write=False)
    return array


def without_jerk_limits(rig: Rig) -> Rig:
    """The rig without its jerk limits; itself where it has none."""
    if not rig.jerk_limited:
        return rig
    base, outer, middle, inner = (replace(frame, max_jerk=math.inf) for frame in rig.frames)
    return replace(rig, frames=(base, outer, middle, inner))


def builtin_rigs() -> dict[str, Rig]:
    """The rigs that come with Fullpose, by name; `vertical-limited` has the inner frame within +-60 deg."""
    deg = math.pi / 180.0

    def frame(rate: float, acceleration: float, span: float = math.inf) -> FrameLimits:
        return FrameLimits(-span * deg, span * deg, rate * deg, acceleration * deg)

    # The limit set of mathematics, section 8: a realistic table of the class.
    open_frames = (frame(200, 500), frame(250, 800), frame(300, 1200), frame(600, 4000))
    limited = (*open_frames[:3], frame(600, 4000, 60))
    rigs = [Rig(g.value, g, open_frames) for g in Geometry]
    rigs.append(Rig("vertical-limited", Geometry.VERTICAL_4, limited))
    return {rig.name: rig for rig in rigs}
