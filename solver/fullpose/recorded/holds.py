"""Held samples: a slower log written out at a faster rate, or samples that repeat the last one while it moves.

A flight at rest repeats itself, too, and so does a slow one that is rounded; neither is held. Where a flight is held,
all of its motion is in the jumps between the runs of equal samples, and the runs are of one length, or of two
neighbouring ones where the rates are no multiples.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Integers

SAME = 1e-13  # [rad] the angle between samples that are one sample written twice
REGULAR = 0.8  # of the runs have the two lengths in the middle: then the flight is held at one rate
FEWEST_RUNS = 5
JUMP = 1.5  # a run of a flight not held throughout is held if it ends with a jump of so many of its neighbours
_NEIGHBOURS = 4


@dataclass(frozen=True)
class Held:
    """`mask` (n,) is True where a sample repeats the one before although the flight moves."""

    mask: NDArray[np.bool_]
    length: float  # samples a run, on average, where the flight is held at one rate; 1 where it is not
    rate_hz: float | None  # of the true samples, where the flight is held at one rate

    @property
    def count(self) -> int:
        """How many samples are repeated."""
        return int(np.count_nonzero(self.mask))


def held_samples(time: Array, step_rad: Array, quantum: float) -> Held:
    """The samples held in the flight of time (n,) [s], whose samples are step_rad (n - 1,) [rad] apart.

    quantum: what the angles are rounded to [rad]; jumps of that size are the rounding's.
    """
    n = time.size
    none = Held(np.zeros(n, np.bool_), 1.0, None)
    moved = step_rad > SAME
    begins = np.concatenate([[0], np.flatnonzero(moved) + 1])  # the first sample of each run
    if n < 3 or bool(moved.all()) or begins.size < 3:
        return none
    length = np.diff(begins)[1:] if begins.size > 3 else np.diff(begins)  # how the first run began is not known
    jump = step_rad[begins[2:] - 1] if begins.size > 3 else step_rad[begins[1:] - 1]
    start = begins[1:-1] if begins.size > 3 else begins[:-1]
    regular = _regular(time, begins, start, length, jump, quantum)
    return regular or _single(n, start, length, jump, quantum)


def _regular(
    time: Array, begins: Integers, start: Integers, length: Integers, jump: Array, quantum: float
) -> Held | None:
    """The flight as one held at one rate, or None."""
    middle = float(np.median(length))
    usual = np.abs(length - middle) <= 1.0
    if length.size < FEWEST_RUNS or middle < 2.0 or np.mean(usual) < REGULAR or np.median(jump) <= 1.5 * quantum:
        return None
    mean = float(np.mean(length[usual]))
    if np.mean(np.abs(length - mean) <= 1.0) < REGULAR:
        return None
    mask = np.ones(time.size, np.bool_)
    mask[begins] = False
    rest = length > 2.0 * mean + 1.0  # the flight rests here: what it repeats is true
    hold = round(mean)
    _mark(mask, start[rest] + hold, start[rest] + length[rest], value=False)
    if begins[1] > 2.0 * mean + 1.0:  # it begins at rest: true until one hold before it moves
        mask[: begins[1] - hold + 1] = False
    if time.size - begins[-1] > 2.0 * mean + 1.0:  # it ends at rest
        mask[begins[-1] + hold :] = False
    span = float(np.sum((time[start + length] - time[start])[usual]))
    return Held(mask, mean, int(np.count_nonzero(usual)) / span)


def _single(n: int, start: Integers, length: Integers, jump: Array, quantum: float) -> Held:
    """Runs here and there that end with a jump of more than the neighbours' steps, but not more than was missed."""
    mask = np.zeros(n, np.bool_)
    usual = np.empty(jump.size)
    _neighbours(jump, usual)
    missed = (jump > JUMP * usual + 2.0 * quantum) & (jump < 2.0 * length * usual + 2.0 * quantum)
    held = (length > 1) & missed
    _mark(mask, start[held] + 1, start[held] + length[held], value=True)
    return Held(mask, 1.0, None)


@kernel
def _mark(mask: NDArray[np.bool_], low: Integers, high: Integers, value: bool) -> None:
    for k in range(low.size):
        mask[low[k] : high[k]] = value


@kernel
def _neighbours(jump: Array, usual: Array) -> None:
    """usual <- the median of the four jumps on either side of each; infinite where there is none."""
    near = np.empty(2 * _NEIGHBOURS)
    for k in range(jump.size):
        count = 0
        for i in range(max(0, k - _NEIGHBOURS), min(jump.size, k + _NEIGHBOURS + 1)):
            if i != k:
                near[count] = jump[i]
                count += 1
        usual[k] = np.median(near[:count]) if count else np.inf
