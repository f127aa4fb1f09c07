"""Single samples off the way of their neighbours (mathematics, section 13).

A sample is an outlier if the flight is smooth without it and not with it. A corner or a jump of the flight itself stays
in the differences whichever sample is left out.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._jit import inner, kernel
from fullpose._typing import Array, Integers
from fullpose.recorded.divided_differences import ORDERS, relative_rotation, window_residual

SIGMAS = 8.0  # of the noise, and of what the sample's surroundings differ by
SMALLEST = 1e-7  # [rad]; what is nearer to its neighbours' way is none
LONGEST = 3  # outliers in a row
ORDER = 4
_REACH = 5  # samples on either side that are looked at
_FIRST_SIGMAS = 4.0  # of the quick look that says which samples are looked at closely
_THIRD_DIFFERENCE = math.sqrt(70.0)  # what the third difference of increments makes of white noise


@dataclass(frozen=True)
class Outliers:
    """`sample` (m,): which; `size_rad` (m,): how far off its neighbours' way; `sigmas` (m,): in standard deviations."""

    sample: Integers
    size_rad: Array
    sigmas: Array


@kernel
def _quick_look(q: Array, out: Array) -> None:
    """out (n,) <- the third difference of the increments about each sample [rad], of unit noise; 0 near the ends."""
    w = np.zeros((4, 3))
    for k in range(q.shape[0] - 1):
        relative_rotation(q[k], q[k + 1], w[k % 4])
        if k >= 3:
            square = 0.0
            for i in range(3):
                d = w[k % 4, i] - 3.0 * w[(k - 1) % 4, i] + 3.0 * w[(k - 2) % 4, i] - w[(k - 3) % 4, i]
                square += d * d
            out[k - 1] = math.sqrt(square) / _THIRD_DIFFERENCE


@inner
def _norm(v: Array) -> float:
    return math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@inner
def _without(time: Array, q: Array, first: int, run: int, at: Integers, buffer: Array, r: Array) -> float:
    """The largest difference of the samples around first .. first + run - 1, these left out [rad].

    nan where the samples on both sides cannot be compared, across a gap or at an end.
    """
    largest = 0.0
    spanning = 0
    for low in range(-_REACH, 2):  # five samples in a row, the run skipped: the first is -5 .. +1 from it
        fits = True
        for j in range(ORDER + 1):
            offset = low + j
            sample = first + offset + (run if offset >= 0 else 0)
            fits = fits and 0 <= sample < time.size
            at[j] = sample
        if not fits:
            continue
        if window_residual(time, q, at, ORDER, buffer, r):
            largest = max(largest, _norm(r))
            spanning += -ORDER <= low < 0
        elif -ORDER <= low < 0:
            return math.nan
    return largest if spanning > 1 else math.nan


@inner
def _with(time: Array, q: Array, first: int, run: int, sample: int, at: Integers, buffer: Array, r: Array) -> float:
    """The difference of `sample` of a run and the two samples on either side of the run [rad]; nan if there is none."""
    at[0], at[1], at[2], at[3], at[4] = first - 2, first - 1, sample, first + run, first + run + 1
    if at[0] < 0 or at[4] >= time.size or not window_residual(time, q, at, ORDER, buffer, r):
        return math.nan
    return _norm(r)


@kernel
def _look(time: Array, q: Array, candidates: Integers, scale: float, size: Array, sigmas: Array) -> None:
    """size, sigmas (n,) <- of the candidates that are outliers, alone or in a run that begins with them."""
    at = np.empty(ORDER + 1, np.int64)
    buffer = np.empty((3, ORDERS))
    r = np.empty(3)
    for m in range(candidates.size):
        for first in range(candidates[m] - 1, candidates[m] + 2):
            for run in range(1, LONGEST + 1):
                around = _without(time, q, first, run, at, buffer, r)
                if math.isnan(around) or sigmas[first] > 0.0:
                    continue
                around = max(scale, around)
                least = math.inf
                for sample in range(first, first + run):
                    off = _with(time, q, first, run, sample, at, buffer, r)
                    least = min(least, 0.0 if math.isnan(off) else off)
                if not least > SIGMAS * around:
                    continue
                for sample in range(first, first + run):
                    off = _with(time, q, first, run, sample, at, buffer, r)
                    sigmas[sample] = off / around
                    size[sample] = off / abs(buffer[1, ORDER // 2])
                break


def outliers(time: Array, q: Array, sigma: float) -> Outliers:
    """The outliers of the flight (time (n,) [s], q (n, 4)) whose noise has the standard deviation sigma [rad]."""
    n = time.size
    quick = np.zeros(n)
    _quick_look(q, quick)
    scale = max(sigma, SMALLEST / SIGMAS)
    reach = _REACH + 1
    inner_part = quick[reach:-reach] if n > 2 * reach else np.empty(0)
    about = np.minimum(quick[: n - 2 * reach], quick[2 * reach :]) if n > 2 * reach else inner_part
    candidates = np.flatnonzero((inner_part > _FIRST_SIGMAS * scale) & (inner_part > 2.0 * about)) + reach
    size, sigmas = np.zeros(n), np.zeros(n)
    _look(time, q, candidates, scale, size, sigmas)
    found = np.flatnonzero(sigmas)
    return Outliers(found, size[found], sigmas[found])
