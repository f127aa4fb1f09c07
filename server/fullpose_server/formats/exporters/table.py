"""What every exporter writes: named columns of one clock, what is known of them, and the motion that a table plays."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.rig import FRAMES
from fullpose.verify import differences

# Of a column's name by its end, longest first; a name without one has no unit.
_UNITS = (("_deg_s2", "deg/s^2"), ("_deg_s", "deg/s"), ("_deg", "deg"), ("_us", "us"), ("_ns", "ns"), ("_s", "s"))
Values = NDArray[np.generic]


@dataclass(frozen=True)
class Motion:
    """What the frames do: time (n,) [s], the rest (n, 4) [deg, deg/s, deg/s^2]."""

    time: Array
    position: Array
    rate: Array
    acceleration: Array


@dataclass(frozen=True)
class ExportTable:
    """A plan, a solution or a run. The first column is `time_s`; nan is a value that there is none of."""

    name: str  # plan, solution, run
    columns: Mapping[str, Values]  # (n,) each: doubles, whole numbers or text
    facts: Mapping[str, str]  # what it is of
    motion: Callable[[], Motion]  # raises `FileError` where a table could not play it

    @property
    def rows(self) -> int:
        """How many."""
        return len(self.columns["time_s"])


def unit_of(name: str) -> str:
    """The unit that a column's name ends in: `deg/s` of `base_rate_deg_s`; empty where there is none."""
    return next((unit for end, unit in _UNITS if name.endswith(end)), "")


def by_frame(stem: str, unit: str, values: Array) -> dict[str, Values]:
    """A column a frame of values (n, 4): `base_rate_deg_s` of stem `rate` and unit `deg_s`."""
    return {
        "_".join(filter(None, (frame, stem, unit))): np.ascontiguousarray(values[:, k])
        for k, frame in enumerate(FRAMES)
    }


def motion_of(time: Array, position: Array) -> Motion:
    """The motion of positions (n, 4) [deg] at time (n,) [s], by the differences that limits are checked by.

    The rate of row k is from row k - 1 to it, the acceleration of row k is between its rates on both sides
    (`fullpose.verify`). The ends, which have none, repeat their neighbour's; where rows are too few
    for any, it is zero.
    """
    rate, acceleration = np.zeros(position.shape), np.zeros(position.shape)
    if len(time) > 1:
        first, second = differences(time, position)
        rate[1:], rate[0] = first, first[0]
        if len(second):
            acceleration[1:-1], acceleration[0], acceleration[-1] = second, second[0], second[-1]
    return Motion(time, position, rate, acceleration)
