"""The stamps of a record: their jitter, what they are rounded to, and the regular clock that explains them.

A stamp can be wrong while its sample is right: rounded to a millisecond, or taken when the message came. The clock is
the line through stamp against index. It explains the stamps only where the attitude says so, too: under the clock the
flight is smoother than under the stamps (mathematics, section 13).
"""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.recorded.divided_differences import residuals, window_starts
from fullpose.recorded.steps import local_medians

BREAK = 2.5  # local median steps: a longer one ends a stretch, and the clock's phase beyond it is free
FARTHEST = 0.75  # of a period: a stamp farther from a clock's tick is not that tick's
ON_CLOCK = 1e-6  # of a period: the rounding of a double
SMOOTHER = 0.85  # a clock explains stamps if it leaves at most this part of their differences
SMOOTHER_BY_FEW = 0.5  # ... where there are few to compare
FEW_WINDOWS = 200
FEWEST = 8
ORDER = 6  # of the differences by which two clocks are compared
MOST_WINDOWS = 20_000
DECIMALS = (0, 1, 2, 3, 4, 5, 6)
_ROUNDS = 3
_GAIN = 0.05  # of the phase that follows the stamps; the first stamps move it more


@dataclass(frozen=True)
class Stamps:
    """How regular the stamps are. Jitter is measured against the regular clock, or, where there is none, step by step.

    `regular_time_s` is the clock's time of every sample, and None where the stamps are as regular as doubles are, or
    where no regular clock makes the attitude smoother.
    """

    median_step_s: float  # 0 for a single sample
    jitter_rms_s: float
    jitter_max_s: float
    quantum_s: float  # the decimal that explains the jitter; 0 where none does
    regular_time_s: Array | None  # (n,), read-only

    @property
    def explained(self) -> bool:
        """Whether the stamps jitter and a regular clock explains them."""
        return self.regular_time_s is not None


@kernel
def _ticks(time: Array, period: float, first: Integers, ticks: Integers) -> None:
    """ticks <- the clock's count at each stamp, dropped samples jumped over; it begins anew at each stretch `first`."""
    stretch = 0
    phase = time[0]
    seen = 0
    for k in range(time.size):
        if stretch < first.size and first[stretch] == k:
            ticks[k] = 0
            phase = time[k]
            seen = 1
            stretch += 1
            continue
        off = time[k] - phase - period
        jump = round(off / period) if off > FARTHEST * period else 0
        ticks[k] = ticks[k - 1] + 1 + jump
        seen += 1
        phase += period * (1 + jump) + max(_GAIN, 1.0 / seen) * (off - jump * period)


@dataclass(frozen=True)
class _Clock:
    """Ticks of one period through the stamps of stretches, each with its own phase."""

    time: Array  # (n,) [s]
    off: Array  # (n,) [s] stamp minus tick
    period: float


def regular_stamps(time: Array, q: Array) -> Stamps:
    """What the stamps of the flight (time (n,) [s], q (n, 4)) are like."""
    n = time.size
    if n < FEWEST:
        step = float(np.median(np.diff(time))) if n > 1 else 0.0
        return Stamps(step, 0.0, 0.0, 0.0, None)
    steps = np.diff(time)
    median = float(np.median(steps))
    first = np.concatenate([[0], np.flatnonzero(steps > BREAK * local_medians(steps)) + 1]).astype(np.int64)
    clocks = [_straight(time, first), _jumping(time, first, median)]
    best: _Clock | None = None
    regular: _Clock | None = None
    left = 1.0
    for clock in clocks:
        if _rms(clock.off) <= ON_CLOCK * clock.period + _spacing(time):
            regular = clock
        elif clock.time.size and bool(np.all(np.diff(clock.time) > 0.0)):
            ratio = _smoother(time, clock, q)
            if ratio < left:
                best, left = clock, ratio
    if best is None and regular is not None:
        return Stamps(median, _rms(regular.off), float(np.abs(regular.off).max()), 0.0, None)
    if best is None:
        wobble = np.abs(np.diff(steps)) / np.sqrt(6.0)
        return Stamps(median, _rms(wobble[wobble <= median]), float(wobble.max()), 0.0, None)
    largest = float(np.abs(best.off).max())
    best.time.setflags(write=False)
    return Stamps(best.period, _rms(best.off), largest, _quantum(time, largest, best.period), best.time)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def _spacing(time: Array) -> float:
    """What the doubles that hold these stamps are apart: 0.2 us for seconds since 1970."""
    return float(np.spacing(np.abs(time).max()))


def _straight(time: Array, first: Integers) -> _Clock:
    """The clock that ticks once a sample, with no sample dropped but between stretches."""
    ticks = np.arange(time.size) - np.repeat(first, np.diff(np.append(first, time.size)))
    return _fit(time, first, ticks)


def _jumping(time: Array, first: Integers, period: float) -> _Clock:
    """The clock whose ticks were not all recorded."""
    ticks = np.empty(time.size, np.int64)
    for _ in range(2):
        _ticks(time, period, first, ticks)
        clock = _fit(time, first, ticks)
        period = clock.period
    return clock


def _fit(time: Array, first: Integers, ticks: Integers) -> _Clock:
    """The line through the stamps against their ticks, by least squares; stamps far from it are left out."""
    length = np.diff(np.append(first, time.size))
    used = np.ones(time.size)
    period, off = 1.0, time
    for _ in range(_ROUNDS):
        count = np.maximum(np.add.reduceat(used, first), 1.0)
        x = ticks - np.repeat(np.add.reduceat(used * ticks, first) / count, length)
        y = time - np.repeat(np.add.reduceat(used * time, first) / count, length)
        square = float(np.sum(used * x * x))
        if square == 0.0:
            return _Clock(np.empty(0), np.zeros(1), 1.0)
        period = float(np.sum(used * x * y)) / square
        off = y - period * x
        scale = float(np.median(np.abs(off)))
        used = (np.abs(off) <= max(6.0 * scale, ON_CLOCK * period)).astype(float)
    return _Clock(time - off, off, period)


def _smoother(time: Array, clock: _Clock, q: Array) -> float:
    """The median difference under the clock as a part of that under the stamps, where the two differ; 1 if not less."""
    moved = np.abs(clock.off) > 0.1 * np.abs(clock.off).max()
    hit = np.flatnonzero(np.convolve(moved, np.ones(ORDER + 1), "valid") > 0.0)
    first = hit[window_starts(hit.size, 0, MOST_WINDOWS)]
    under_stamps, under_clock = (np.abs(residuals(t, q, first, ORDER)).max(axis=1) for t in (time, clock.time))
    both = np.isfinite(under_stamps) & np.isfinite(under_clock)
    if not both.any():
        return 1.0
    before, after = float(np.median(under_stamps[both])), float(np.median(under_clock[both]))
    most = SMOOTHER if int(both.sum()) >= FEW_WINDOWS else SMOOTHER_BY_FEW
    return after / before if after <= most * before and before > 0.0 else 1.0


def _quantum(time: Array, largest: float, period: float) -> float:
    """The decimal of a second that the stamps are rounded to, if that is what moved them [s]."""
    for decimals in DECIMALS:
        unit = 10.0**-decimals
        if unit < largest:
            break
        if largest <= 0.6 * unit and unit <= 2.0 * period:
            near = np.abs(time / unit - np.round(time / unit))
            if float(near.max()) <= 1e-6 + 4.0 * _spacing(time) / unit:
                return unit
    return 0.0
