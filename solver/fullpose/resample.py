"""A flight's attitude on a uniform grid: a quaternion spline through the samples, or the samples themselves.

The spline is SciPy's `RotationSpline` (twice differentiable, cubic in the rotation vector of each interval). It is
built over overlapping windows, because its memory is about 1.7 kB a sample; beyond the overlap a cubic spline has
forgotten its ends (the influence of a knot falls by 0.27 a knot). At the flight's own two ends SciPy takes the mean
rate of the outermost interval, so there the rate is right to first order in the interval only.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy.spatial.transform import Rotation, RotationSpline

from fullpose._typing import Array, Integers
from fullpose.errors import InputError
from fullpose.flight import bad_time

# A time stamp may be rounded; one within this part of a period of its grid point counts as on it.
ON_GRID = 1e-3
# Between two samples so far apart the turn taken is a guess: the spline takes the short way.
LARGEST_STEP = 0.5 * math.pi
MOST_SAMPLES = 30_000_000  # on the grid: eight hours at 1 kHz; a grid longer than that is a time stamp gone wrong
_WINDOW = 20_000
_OVERLAP = 50


class Choice(StrEnum):
    """What was done to the samples."""

    KEPT = "kept"
    SPLINE = "spline"


@dataclass(frozen=True)
class Resampled:
    """A flight at the rig's rate. Arrays are read-only."""

    time: Array  # (n,) [s]
    q: Array  # (n, 4) w, x, y, z, reference to body, unit, continuous
    body_rate: Array  # (n, 3) [rad/s] in body axes, the derivative of the same spline
    choice: Choice
    sentence: str  # the choice in words, with what to mind

    def __post_init__(self) -> None:
        for name in ("time", "q", "body_rate"):
            getattr(self, name).setflags(write=False)


def resample(time: Array, q: Array, rate_hz: float) -> Resampled:
    """The flight at `rate_hz`. time (n,) [s] strictly increasing, q (n, 4) w, x, y, z (either sign, any length but 0).

    Samples already on the grid are kept as they are (made unit and continuous in sign); any others, sparser, denser
    or uneven, are read off the spline at time[0] + k / rate_hz, up to the last sample. A flight of one sample is
    kept, at rate zero. Raises `InputError` for arrays that are not a flight, or one that is
    longer than `MOST_SAMPLES` on the grid.
    """
    time = np.array(time, float)
    q = np.array(q, float)
    _check(time, q, rate_hz)
    q /= np.abs(q).max(axis=1, keepdims=True)  # first, so that no square overflows
    q = continuous(q / np.linalg.norm(q, axis=1, keepdims=True))
    if time.size == 1:
        return Resampled(time, q, np.zeros((1, 3)), Choice.KEPT, "one sample, kept")
    grid = time[0] + np.arange(math.floor((time[-1] - time[0]) * rate_hz + ON_GRID) + 1) / rate_hz
    if grid.size == time.size and bool(np.all(np.abs(time - grid) <= ON_GRID / rate_hz)):
        _, rate = _spline(time, q, time)
        return Resampled(time, q, rate, Choice.KEPT, f"{time.size} samples already at {rate_hz:g} Hz, kept")
    grid[-1] = min(grid[-1], time[-1])
    q_grid, rate = _spline(time, q, grid)
    mean_rate = (time.size - 1) / (time[-1] - time[0])
    sentence = (
        f"{time.size} samples at {mean_rate:.4g} Hz on average, quaternion spline to {grid.size} at {rate_hz:g} Hz"
    )
    if mean_rate > rate_hz * (1.0 + ON_GRID):
        sentence += "; the flight is sampled faster than the rig, what lies between its samples is left out"
    widest = _largest_step(q)
    if widest > LARGEST_STEP:
        sentence += (
            f"; neighbouring samples up to {math.degrees(widest):.0f} deg apart, the way between them is a guess"
        )
    return Resampled(grid, q_grid, rate, Choice.SPLINE, sentence)


def check_length(duration_s: float, rate_hz: float) -> None:
    """Raise `InputError` where a flight of `duration_s` is longer than can be had at `rate_hz`."""
    longest = MOST_SAMPLES / rate_hz
    if duration_s > longest:
        raise InputError("duration_s", None, duration_s, f"at most {longest:.6g} s at {rate_hz:g} Hz")


def continuous(q: Array) -> Array:
    """q (n, 4) with signs such that neighbours are on the same half of the sphere; the first keeps its sign."""
    if q.shape[0] < 2:
        return q.copy()
    flips = np.where(np.sum(q[1:] * q[:-1], axis=1) < 0.0, -1.0, 1.0)
    signs = np.concatenate([[1.0], np.cumprod(flips)])
    return np.asarray(q * signs[:, None])


def _largest_step(q: Array) -> float:
    gap = np.linalg.norm(np.diff(q, axis=0), axis=1)
    return float(4.0 * np.arcsin(np.minimum(1.0, 0.5 * gap.max())))


def _spline(time: Array, q: Array, at: Array) -> tuple[Array, Array]:
    """(q (m, 4), body rate (m, 3)) of the spline through (time, q) at the sorted times `at` (m,)."""
    out, rate = np.empty((at.size, 4)), np.empty((at.size, 3))
    for begin in range(0, time.size - 1, _WINDOW):
        end = min(begin + _WINDOW, time.size - 1)
        low, high = max(0, begin - _OVERLAP), min(time.size, end + _OVERLAP + 1)
        spline = RotationSpline(time[low:high], Rotation.from_quat(q[low:high], scalar_first=True))
        first = int(np.searchsorted(at, time[begin], "left"))
        last = int(np.searchsorted(at, time[end], "right" if end == time.size - 1 else "left"))
        if last > first:
            out[first:last] = spline(at[first:last]).as_quat(scalar_first=True)
            rate[first:last] = spline(at[first:last], 1)
    out = continuous(out)
    return (-out if float(out[0] @ q[0]) < 0.0 else out), rate


def _check(time: Array, q: Array, rate_hz: float) -> None:
    if not (math.isfinite(rate_hz) and rate_hz > 0.0):
        raise InputError("rate_hz", None, rate_hz, "a number above zero")
    if time.ndim != 1 or time.size == 0:
        raise InputError("time", None, time.shape, "(n,) with n >= 1")
    if q.shape != (time.size, 4):
        raise InputError("q", None, q.shape, f"({time.size}, 4)")
    if found := bad_time(time):
        raise InputError("time", found[0], float(time[found[0]]), found[1])
    check_length(float(time[-1] - time[0]), rate_hz)
    good = np.isfinite(q).all(axis=1) & (np.abs(q).max(axis=1) > 0.0)
    if not good.all():
        bad = int(np.argmin(good))
        raise InputError("q", bad, q[bad].tolist(), "a finite quaternion that is not zero")


def subdivide(time: Array, attitude: Array, longest: float, most_parts: int) -> tuple[Array, Array, Integers]:
    """The flight with samples between those that are farther apart than `longest` [s], read off the spline.

    time (n,) [s], attitude (n, 3, 3) body from reference. Returns both at (m,) times, and which of these (n,) the
    given samples are; they are kept to the last bit. A step is divided into `most_parts` at most.
    """
    parts = np.clip(np.ceil(np.diff(time) / longest), 1, most_parts).astype(np.int64)
    rows = np.concatenate([[0], np.cumsum(parts)])
    if rows[-1] == time.size - 1:
        return time, attitude, rows
    at = np.interp(np.arange(rows[-1] + 1), rows, time)
    body_to_reference = Rotation.from_matrix(np.swapaxes(attitude, 1, 2))
    between = RotationSpline(time, body_to_reference)(at)
    C = np.ascontiguousarray(np.swapaxes(between.as_matrix(), 1, 2))
    C[rows] = attitude
    return at, C, rows
