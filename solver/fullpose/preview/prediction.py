"""The attitude to come: what the source has told, then what its motion so far makes likely.

After the last known sample the body goes on at its present rate; its acceleration dies away over `settling`. Both come
from a least-squares parabola through the rotation vectors of the last `window` seconds, so that a source's jitter is
averaged and not differentiated.
"""

import math

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.errors import InputError
from fullpose.kinematics import rotate_back, rotation_error

SPACING = 0.005  # [s] between samples kept: a stage of the search is ten times as long
CAPACITY = 1024


@kernel
def body_motion(time: Array, attitude: Array, window: float, rate: Array, acceleration: Array) -> None:
    """rate, acceleration (3,) [rad/s, rad/s^2] <- of the body at the last sample, from those within `window` [s] of it.

    time (m,) [s], attitude (m, 3, 3). One sample: both are zero; two: the acceleration is.
    """
    last = time.shape[0] - 1
    e = np.empty(3)
    s2 = s3 = s4 = 0.0
    first = np.zeros(3)
    second = np.zeros(3)
    count = 0
    for j in range(last - 1, -1, -1):
        t = time[j] - time[last]
        if t < -window and count > 0:
            break
        rotation_error(attitude[j], attitude[last], e)
        s2 += t * t
        s3 += 0.5 * t * t * t
        s4 += 0.25 * t * t * t * t
        for i in range(3):
            first[i] += t * e[i]
            second[i] += 0.5 * t * t * e[i]
        count += 1
    for i in range(3):
        rate[i] = 0.0
        acceleration[i] = 0.0
    if count == 0:
        return
    determinant = s2 * s4 - s3 * s3
    parabola = count > 1 and determinant > 1e-9 * s2 * s4
    for i in range(3):
        if parabola:
            rate[i] = (s4 * first[i] - s3 * second[i]) / determinant
            acceleration[i] = (s2 * second[i] - s3 * first[i]) / determinant
        else:
            rate[i] = first[i] / s2


@kernel
def attitudes_ahead(
    time: Array, attitude: Array, ahead: Array, window: float, settling: float, known_beyond: float, out: Array
) -> int:
    """out (k, 3, 3) <- the attitude at the times `ahead` (k,) [s]; returns how many of them are known.

    time (m,), attitude (m, 3, 3): what is known, the present and the past included. settling [s]: how long an
    acceleration is taken to last. known_beyond [s]: how far past the last known sample a stage still counts as known.
    """
    last = time.shape[0] - 1
    rate = np.empty(3)
    acceleration = np.empty(3)
    e = np.empty(3)
    body_motion(time, attitude, window, rate, acceleration)
    j = 0
    known = 0
    before = time[last]
    before_at = -1
    for k in range(ahead.shape[0]):
        t = ahead[k]
        if t <= time[last]:
            while j < last - 1 and time[j + 1] < t:
                j += 1
            if last == 0 or t <= time[0]:
                out[k] = attitude[0]
            else:
                rotation_error(attitude[j + 1], attitude[j], e)
                share = (t - time[j]) / (time[j + 1] - time[j])
                for i in range(3):
                    e[i] *= share
                rotate_back(e, attitude[j], out[k])
            known = k + 1
            continue
        if t <= time[last] + known_beyond:
            known = k + 1
        # The mean rate from the stage before to this one.
        a = before - time[last]
        b = t - time[last]
        if settling > 0.0:
            lag = settling - settling * settling * (math.exp(-a / settling) - math.exp(-b / settling)) / (b - a)
        else:
            lag = 0.0
        for i in range(3):
            e[i] = (b - a) * (rate[i] + lag * acceleration[i])
        rotate_back(e, attitude[last] if before_at < 0 else out[before_at], out[k])
        before = t
        before_at = k
    return known


class Track:
    """What is known of the attitude: the recent past, the present and the announced future, `SPACING` apart."""

    def __init__(self, memory: float) -> None:
        """`memory` [s] of the past is kept."""
        self._memory = memory
        self._time = np.empty(CAPACITY)
        self._attitude = np.empty((CAPACITY, 3, 3))
        self._count = 0

    @property
    def end(self) -> float:
        """The time of the last known sample [s]; -inf without one."""
        return float(self._time[self._count - 1]) if self._count else -math.inf

    def tell(self, time: Array, attitude: Array) -> None:
        """Take in samples, time (m,) [s] and attitude (m, 3, 3); what was known for those times and after is replaced.

        Raises `InputError` where the times do not increase.
        """
        if np.any(np.diff(time) <= 0.0):
            raise InputError("time", None, time.tolist(), "times that increase")
        self._count = int(np.searchsorted(self._time[: self._count], time[0]))
        for k in range(len(time)):
            self._append(float(time[k]), attitude[k])

    def void(self, now: float) -> None:
        """Forget what was announced for after `now` [s]."""
        self._count = int(np.searchsorted(self._time[: self._count], now, side="right"))

    def flown(self, time: float, attitude: Array) -> None:
        """Take in the present sample: attitude (3, 3). What is known of the future stays."""
        at = int(np.searchsorted(self._time[: self._count], time))
        if at == self._count:
            self._append(time, attitude)

    def forget(self, now: float) -> None:
        """Drop what is older than the memory [s]."""
        gone = int(np.searchsorted(self._time[: self._count], now - self._memory))
        if gone > 1:
            kept = self._count - gone
            self._time[:kept] = self._time[gone : self._count].copy()
            self._attitude[:kept] = self._attitude[gone : self._count].copy()
            self._count = kept

    def copy(self) -> tuple[Array, Array]:
        """(time (m,), attitude (m, 3, 3))."""
        return self._time[: self._count].copy(), self._attitude[: self._count].copy()

    def _append(self, time: float, attitude: Array) -> None:
        # The newest is always there; the one before it goes where it is too close to the one before that.
        if self._count > 1 and time - self._time[self._count - 2] < SPACING:
            self._count -= 1
        if self._count == len(self._time):
            self._time = np.concatenate([self._time, np.empty(self._count)])
            self._attitude = np.concatenate([self._attitude, np.empty((self._count, 3, 3))])
        self._time[self._count] = time
        self._attitude[self._count] = attitude
        self._count += 1
