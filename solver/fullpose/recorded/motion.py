"""Body rates and accelerations that a record implies: the differences of its samples, taken as they stand."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.recorded.divided_differences import relative_rotation


@dataclass(frozen=True)
class Peak:
    """`value` (3,): the largest magnitude about each body axis; `norm`: of the vector; and when each was [s]."""

    value: Array
    time_s: Array
    norm: float
    norm_time_s: float


@kernel
def _motion(time: Array, q: Array, angle: Array, peaks: Array) -> None:
    """angle (n - 1,) <- between neighbours [rad]; peaks (2, 2, 4) <- of rate and acceleration.

    Value and time of each, about x, y, z and of the vector.
    """
    w = np.empty(3)
    rate = np.zeros(4)
    last = np.zeros(3)
    for k in range(time.size - 1):
        step = time[k + 1] - time[k]
        angle[k] = relative_rotation(q[k], q[k + 1], w)
        square = 0.0
        for i in range(3):
            rate[i] = w[i] / step
        rate[3] = angle[k] / step
        for i in range(4):
            if abs(rate[i]) > peaks[0, 0, i]:
                peaks[0, 0, i] = abs(rate[i])
                peaks[0, 1, i] = 0.5 * (time[k] + time[k + 1])
        if k > 0:
            span = 0.5 * (time[k + 1] - time[k - 1])
            for i in range(3):
                value = abs(rate[i] - last[i]) / span
                square += value * value
                if value > peaks[1, 0, i]:
                    peaks[1, 0, i] = value
                    peaks[1, 1, i] = time[k]
            if square > peaks[1, 0, 3] ** 2:
                peaks[1, 0, 3] = np.sqrt(square)
                peaks[1, 1, 3] = time[k]
        for i in range(3):
            last[i] = rate[i]


@dataclass(frozen=True)
class Motion:
    """`angle` (n - 1,) between neighbours [rad]; the peaks of body rate [rad/s] and acceleration [rad/s^2]."""

    angle: Array
    rate: Peak
    acceleration: Peak


def body_motion(time: Array, q: Array) -> Motion:
    """The differences of the flight of time (n,) [s] and q (n, 4)."""
    angle, peaks = np.zeros(max(0, time.size - 1)), np.zeros((2, 2, 4))
    peaks[:, 1, :] = time[0]
    _motion(time, q, angle, peaks)
    rate, acceleration = (Peak(p[0, :3], p[1, :3], float(p[0, 3]), float(p[1, 3])) for p in peaks)
    return Motion(angle, rate, acceleration)
