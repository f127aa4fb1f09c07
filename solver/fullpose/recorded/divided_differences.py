"""Divided differences of an attitude, scaled to white noise (mathematics, section 13).

Over p + 1 samples the differences take away every polynomial of degree below p in the rotation vector from the middle
sample, whatever the steps are, and what they leave of white noise has the noise's own size, since the weights are
scaled to unit length. What they leave of a smooth flight falls with every order, by the sine of half its phase a
sample.
"""

import math

import numpy as np

from fullpose._jit import inner, kernel
from fullpose._typing import Array, Integers

LONGEST_STEP = 0.5 * math.pi  # [rad] between neighbours; beyond it the way between them is a guess
FARTHEST = 2.5  # [rad] from a window's middle sample; the rotation vector ends at a half turn
_SPREAD = 4.5  # a window holds a gap where one of its steps is so many times the mean of the others
ORDERS = 11  # the weights' buffer: an order of at most 10


@inner
def relative_rotation(a: Array, b: Array, v: Array) -> float:
    """v <- the rotation vector of a^-1 b in body axes [rad]; returns its length. a, b (4,) unit, v (3,)."""
    w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    x = a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1]
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    angle = 2.0 * math.atan2(sine, w)
    scale = angle / sine if sine > 1e-150 else 2.0
    v[0] = scale * x
    v[1] = scale * y
    v[2] = scale * z
    return angle


@inner
def window_weights(t: Array, order: int, c: Array) -> bool:
    """c <- the weights of the divided difference over t (order + 1,), of unit length; False across a gap.

    c_j = 1 / prod (t_j - t_i), i != j. Times are scaled by the mean step, so that no product overflows.
    """
    mean = (t[order] - t[0]) / order
    square = 0.0
    for j in range(order + 1):
        if j > 0 and t[j] - t[j - 1] > _SPREAD * (t[order] - t[0] - t[j] + t[j - 1]) / (order - 1):
            return False
        product = 1.0
        for i in range(order + 1):
            if i != j:
                product *= (t[j] - t[i]) / mean
        c[j] = 1.0 / product
        square += c[j] * c[j]
    for j in range(order + 1):
        c[j] /= math.sqrt(square)
    return True


@inner
def window_residual(time: Array, q: Array, at: Integers, order: int, buffer: Array, out: Array) -> bool:
    """out <- the scaled divided difference of the samples `at` (order + 1,) in body axes of the middle one [rad].

    False, and nan, where it cannot be had: across a gap or a step beyond `LONGEST_STEP`.
    time (n,), q (n, 4), buffer (3, ORDERS), out (3,).
    """
    t = buffer[0]
    c = buffer[1]
    v = buffer[2, 0:3]
    out[0] = out[1] = out[2] = math.nan
    for j in range(order + 1):
        t[j] = time[at[j]] - time[at[0]]
    if not window_weights(t, order, c):
        return False
    middle = q[at[order // 2]]
    total0, total1, total2 = 0.0, 0.0, 0.0
    for j in range(order + 1):
        angle = relative_rotation(middle, q[at[j]], v)
        total0 += c[j] * v[0]
        total1 += c[j] * v[1]
        total2 += c[j] * v[2]
        if angle > FARTHEST or (j > 0 and relative_rotation(q[at[j - 1]], q[at[j]], v) > LONGEST_STEP):
            return False
    out[0], out[1], out[2] = total0, total1, total2
    return True


@kernel
def _residuals(time: Array, q: Array, first: Integers, order: int, out: Array) -> None:
    at = np.empty(order + 1, np.int64)
    buffer = np.empty((3, ORDERS))
    for m in range(first.size):
        for j in range(order + 1):
            at[j] = first[m] + j
        window_residual(time, q, at, order, buffer, out[m])
        if out[m, 0] == 0.0 and out[m, 1] == 0.0 and out[m, 2] == 0.0:
            out[m] = math.nan


def residuals(time: Array, q: Array, first: Integers, order: int) -> Array:
    """The scaled divided differences (m, 3) [rad] over samples first[i] .. first[i] + order.

    nan where there is none, and where nothing moves: a flight at rest says nothing of noise.
    time (n,) [s], q (n, 4) unit, first (m,) with first + order < n.
    """
    out = np.empty((first.size, 3))
    _residuals(time, q, first, order, out)
    return out


def window_starts(samples: int, order: int, most: int) -> Integers:
    """The first samples of at most `most` windows, spread evenly. (m,)"""
    windows = max(0, samples - order)
    if windows <= most:
        return np.arange(windows, dtype=np.int64)
    return np.linspace(0, windows - 1, most).astype(np.int64)
