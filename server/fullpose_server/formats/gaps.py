"""Where a flight has no samples. A gap is not flown through unless a person says so."""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fullpose._typing import Array

HALF_WINDOW = 5  # steps on either side that a step is measured by
FACTORS = (1.75, 5.0, 25.0, 125.0)  # of the steps around: the least of these that is seldom exceeded makes a gap
SPREADS = 6.0  # ... and so many times what the steps usually differ by
UNEVEN = 2.0  # a spread from which on a record has steps of every length
SELDOM = 0.05
NEAR = 0.1  # of the median step: a stamp that is there twice, all but
LONG = 5.0  # steps: what is shorter is a lost sample or a few, and told; what is longer is refused


@dataclass(frozen=True)
class Hole:
    """A step with no samples in it."""

    row: int  # the last sample before it
    start_s: float
    end_s: float
    steps: float  # its length in median steps of its neighbours

    def __str__(self) -> str:
        return f"{self.start_s:.6g} s to {self.end_s:.6g} s ({self.steps:.4g} median steps)"


def holes(time: Array) -> list[Hole]:
    """The gaps of time (n,) [s], as `fullpose.recorded.steps` measures them, without its kernels."""
    steps = np.diff(time)
    if steps.size < 2:
        return []
    usual = float(np.median(steps))
    spread = SPREADS * float(np.median(np.abs(steps / usual - 1.0)))
    wide = np.flatnonzero(steps > max(FACTORS[0], 1.0 + spread) * usual)
    if not wide.size:
        return []
    near = steps < NEAR * usual  # a stamp beside its neighbour leaves the room of a step behind it or before it
    behind = np.concatenate([[False], near[:-1]]) | np.concatenate([near[1:], [False]])
    wide = wide[~(behind[wide] & (steps[wide] < (1.0 + FACTORS[0]) * usual))]
    if not wide.size:
        return []
    padded = np.pad(steps, HALF_WINDOW, constant_values=np.nan)
    ratio = steps[wide] / np.nanmedian(sliding_window_view(padded, 2 * HALF_WINDOW + 1)[wide], axis=-1)
    for factor in FACTORS if spread < UNEVEN else FACTORS[2:]:
        found = ratio > max(factor, 1.0 + spread)
        if found.sum() <= max(1.0, SELDOM * steps.size):
            break
    return [
        Hole(int(row), float(time[row]), float(time[row + 1]), float(length))
        for row, length in zip(wide[found], ratio[found], strict=True)
    ]
