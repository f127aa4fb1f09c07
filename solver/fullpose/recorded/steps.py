"""Steps of a record against their neighbours: what is a gap, and what a stamp that nearly repeats its neighbour."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Integers

HALF_WINDOW = 5  # steps on either side that a step is measured by
NEAR = 0.1  # of its neighbours: a step so small has the stamp of one sample twice
GAP = (1.75, 5.0, 25.0, 125.0)  # of its neighbours: the least of these that is seldom exceeded makes a gap
SPREADS = 6.0  # ... and so many times what the steps usually differ by
SELDOM = 0.05  # of the steps: more of them are no gaps, the record is uneven


@kernel
def _local_medians(steps: Array, out: Array) -> None:
    n = steps.size
    near = np.empty(2 * HALF_WINDOW + 1)
    for k in range(n):
        low = max(0, k - HALF_WINDOW)
        high = min(n, k + HALF_WINDOW + 1)
        even = True
        for i in range(low, high):
            if abs(steps[i] - steps[k]) > 0.01 * steps[k]:
                even = False
                break
        if even:
            out[k] = steps[k]
            continue
        count = 0
        for i in range(low, high):  # insertion sort
            j = count
            while j > 0 and near[j - 1] > steps[i]:
                near[j] = near[j - 1]
                j -= 1
            near[j] = steps[i]
            count += 1
        out[k] = near[count // 2]


def local_medians(steps: Array) -> Array:
    """The median of each step and its five neighbours on either side, so that a change of rate is no gap. (n,) [s]"""
    out = np.empty(steps.size)
    _local_medians(steps, out)
    return out


@dataclass(frozen=True)
class Gap:
    """A part of the record without samples."""

    start_s: float  # the last sample before
    end_s: float  # the first one after
    steps: float  # its length in median steps of its neighbours
    sample: int  # of its last sample before


@dataclass(frozen=True)
class Steps:
    """What the steps of a record say."""

    gaps: tuple[Gap, ...]
    near_duplicates: Integers  # (m,) samples whose stamp all but repeats the one before
    smallest_s: float  # 0 where there is one sample
    largest_s: float


def uneven_steps(time: Array, on_clock: Array | None) -> Steps:
    """Gaps and near-duplicates of time (n,) [s]. on_clock: the regular clock that explains the stamps, if one does."""
    if time.size < 2:
        return Steps((), np.empty(0, np.int64), 0.0, 0.0)
    steps = np.diff(time)
    usual = local_medians(steps)
    close = np.flatnonzero(steps < NEAR * usual) + 1
    looked_at = np.diff(on_clock) if on_clock is not None else steps
    ratio = looked_at / (local_medians(looked_at) if on_clock is not None else usual)
    if on_clock is None and close.size:
        ratio[close - 1] = 1.0
        after = close[close < steps.size]
        ratio[after] = (looked_at[after] + looked_at[after - 1]) / usual[
            after
        ] - 1.0  # the pair may have two steps' room
    spread = SPREADS * float(np.median(np.abs(ratio - 1.0)))
    for factor in GAP:
        least = max(factor, 1.0 + spread)
        wide = np.flatnonzero(ratio > least)
        if wide.size <= max(1.0, SELDOM * steps.size):
            break
    gaps = tuple(Gap(float(time[k]), float(time[k + 1]), float(ratio[k]), int(k)) for k in wide)
    return Steps(gaps, close, float(steps.min()), float(steps.max()))
