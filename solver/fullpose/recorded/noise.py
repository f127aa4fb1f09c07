"""White noise of a recorded attitude, a robust estimate per body axis (mathematics, section 13)."""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.recorded.divided_differences import residuals, window_starts

CLEAN = 1e-10  # [rad]; below it a flight is as exact as the arithmetic that made it
ORDER = 8
LOWER = 6  # the order beside it, which tells what the flight's own motion leaves
MOST_WINDOWS = 40_000  # as many as make the estimate good to a percent
FEWEST_WINDOWS = 12
SECOND_DIFFERENCE = math.sqrt(6.0)  # the root of 1 + 4 + 1: what a second difference makes of white noise
_MAD = 1.482602218505602  # a normal distribution's standard deviation in median absolute deviations
_TRIM = 2.5  # standard deviations beyond which a difference is no noise: an outlier, a jump
_TRIMMED = 0.9546  # the standard deviation of a normal distribution of unit size that is cut off there
_FALL = (
    3.0  # a smooth flight of at most a quarter of the sampling rate falls to half its square from one order to the next
)


@dataclass(frozen=True)
class Noise:
    """sigma (3,) [rad] per body axis; `measured` is False where too few samples or too long steps leave it open."""

    sigma: Array
    measured: bool


def white_noise(time: Array, q: Array) -> Noise:
    """The standard deviation of the white noise in the attitudes q (n, 4) at time (n,) [s], per body axis.

    From the divided differences of order 8, which a smooth flight does not reach: what order 6 has more than order 8
    is the flight's own motion, and a share of it is taken off.
    """
    unknown = Noise(np.zeros(3), measured=False)
    high, low = (residuals(time, q, window_starts(len(q), order, MOST_WINDOWS), order) for order in (ORDER, LOWER))
    high, low = high[np.isfinite(high[:, 0])], low[np.isfinite(low[:, 0])]
    if min(len(high), len(low)) < FEWEST_WINDOWS:
        return unknown
    square, lower = robust_scale(high) ** 2, robust_scale(low) ** 2
    left = square - np.maximum(0.0, lower - square) / _FALL
    sigma = np.sqrt(np.maximum(left, 0.0))
    sigma[(left < 0.5 * square) | (sigma < CLEAN)] = 0.0
    return Noise(sigma, measured=True)


def robust_scale(values: Array) -> Array:
    """The standard deviation of each column of values (n, m) about zero, what is beyond 2.5 of them left out. (m,)

    Median absolute deviation first, then the trimmed root mean square, which needs a third of the samples for the same
    precision (Huber and Ronchetti 2009, section 5.1).
    """
    scale = np.asarray(_MAD * np.median(np.abs(values), axis=0))
    inside = np.abs(values) <= _TRIM * scale
    squares = np.sum(np.where(inside, values, 0.0) ** 2, axis=0)
    return np.asarray(np.sqrt(squares / np.maximum(inside.sum(axis=0), 1)) / _TRIMMED)
