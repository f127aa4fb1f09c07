"""The live source's samples on the rig's clock: sorted, interpolated across jitter, extrapolated over short gaps.

A sample that is late, doubled, or off the source's clock is not used. Several such in a row that agree on a clock of
their own, with none of the old one between, are a source that began anew: then so does the buffer.

The source's clock is its own. The offset to ours is the smallest seen between arrival and time stamp (the quickest
datagram is the least delayed one), let up slowly so that drifting clocks are followed. A sample stands for its time
stamp plus that offset; the attitude flown is the one `delay` ago, so that jitter up to the delay is interpolated.
"""

import math

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose_server.runtime.live.packets import LiveSample

_KEPT = 64  # samples, beside those that are known ahead
_FASTEST_HZ = 1000.0  # of a source
_DRIFT = 2e-4  # [s/s] of the offset, upward: more than two quartz clocks differ
_NOISE = math.radians(0.1)  # of an attitude: between samples that come close together it is no rate
_STEP_S = 0.5  # of its clock: a sample farther off is none of it
# What makes a new clock of samples that are not used: so many, over so long, offsets so close. Old samples that come
# all at once are many too, but do not come as fast as their times go.
_ANEW_SAMPLES, _ANEW_S, _ANEW_SPREAD_S = 3, 0.015, 0.02


@kernel
def _turned(q: Array, rate: Array, dt: float, out: Array) -> None:
    """out <- q after turning at the body rate [rad/s] for dt [s]; quaternions w, x, y, z, out of unit length."""
    x, y, z = 0.5 * rate[0] * dt, 0.5 * rate[1] * dt, 0.5 * rate[2] * dt
    half = math.sqrt(x * x + y * y + z * z)
    s = math.sin(half) / half if half > 1e-12 else 1.0
    c = math.cos(half)
    x, y, z = s * x, s * y, s * z
    w0, x0, y0, z0 = q[0], q[1], q[2], q[3]
    out[0] = w0 * c - x0 * x - y0 * y - z0 * z
    out[1] = w0 * x + x0 * c + y0 * z - z0 * y
    out[2] = w0 * y - x0 * z + y0 * c + z0 * x
    out[3] = w0 * z + x0 * y - y0 * x + z0 * c


@kernel
def _between(q0: Array, w0: Array, q1: Array, w1: Array, h: float, u: float, out: Array) -> None:
    """out <- cubic Hermite between q0 and q1 (h [s] apart, same hemisphere, body rates w0, w1) at share u, unit."""
    d0 = np.empty(4)
    d1 = np.empty(4)
    for q, w, d in ((q0, w0, d0), (q1, w1, d1)):
        # q' = q (0, w) / 2
        d[0] = 0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2])
        d[1] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1])
        d[2] = 0.5 * (q[0] * w[1] - q[1] * w[2] + q[3] * w[0])
        d[3] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0])
    a = 2 * u * u * u - 3 * u * u + 1
    b = u * u * u - 2 * u * u + u
    c = -2 * u * u * u + 3 * u * u
    e = u * u * u - u * u
    norm = 0.0
    for k in range(4):
        out[k] = a * q0[k] + b * h * d0[k] + c * q1[k] + e * h * d1[k]
        norm += out[k] * out[k]
    norm = math.sqrt(norm)
    for k in range(4):
        out[k] /= norm


def _rate_between(q0: Array, q1: Array, h: float) -> Array:
    """The constant body rate (3,) [rad/s] that turns q0 into q1 in h [s], the short way."""
    w0, x0, y0, z0 = q0
    w1, x1, y1, z1 = q1
    # conj(q0) q1
    w = w0 * w1 + x0 * x1 + y0 * y1 + z0 * z1
    v = np.array(
        [
            w0 * x1 - x0 * w1 - y0 * z1 + z0 * y1,
            w0 * y1 - y0 * w1 - z0 * x1 + x0 * z1,
            w0 * z1 - z0 * w1 - x0 * y1 + y0 * x1,
        ]
    )
    sine = float(np.linalg.norm(v))
    if sine < 1e-12:
        return np.zeros(3)
    return np.asarray(v * (2.0 * math.atan2(sine, w) / (sine * h)))


class LiveBuffer:
    """The newest samples of one source. Times are ours [s, monotonic] unless said otherwise."""

    def __init__(self, delay_s: float) -> None:
        """delay_s: how long before it is flown a sample is told, at the least [s]."""
        self._delay = delay_s
        self._kept = _KEPT + math.ceil(delay_s * _FASTEST_HZ)
        rows = 2 * self._kept  # so that they move to the front only now and then
        self._time = np.zeros(rows)  # the source's [s]
        self._q = np.zeros((rows, 4))
        self._rate = np.zeros((rows, 3))
        self.reset()

    def reset(self) -> None:
        """Forget the source."""
        self._end = 0  # rows filled
        self._offset = math.inf
        self._offset_at = 0.0
        self._sequence = -1
        self._anew: list[tuple[float, float, int]] = []  # (arrival, time, sequence) of unused samples that agree
        self.accepted = self.dropped = self.steps = 0

    def add(self, sample: LiveSample, now: float) -> bool:
        """Take a sample that arrived at `now`; False where it is late, sent twice, or off the source's clock."""
        offset = now - sample.time_s
        if self._end:
            later = sample.time_s > self._time[self._end - 1] and sample.sequence > self._sequence
            if not later or abs(offset - self._offset) > _STEP_S:
                if not self._is_anew(sample, now):
                    self.dropped += 1
                    return False
                # Without believing the gap between.
                kept = self.steps + 1, self.accepted, self.dropped
                self.reset()
                self.steps, self.accepted, self.dropped = kept
        self._anew.clear()
        drifted = self._offset + _DRIFT * (now - self._offset_at)
        self._offset, self._offset_at = min(offset, drifted), now
        self._sequence = sample.sequence
        if self._end == len(self._time):
            for rows in (self._time, self._q, self._rate):
                rows[: self._kept] = rows[-self._kept :]
            self._end = self._kept
        k = self._end
        self._time[k] = sample.time_s
        self._q[k] = sample.quaternion
        if k and self._q[k] @ self._q[k - 1] < 0.0:
            self._q[k] *= -1.0
        if sample.rate is not None:
            self._rate[k] = sample.rate
        elif k:
            self._rate[k] = _rate_between(self._q[k - 1], self._q[k], float(self._time[k] - self._time[k - 1]))
        else:
            self._rate[k] = 0.0
        self._end += 1
        self.accepted += 1
        return True

    def rate_of(self, sample: LiveSample) -> float:
        """The body rate of a sample [rad/s]: as it says, or as it takes to come there from the one before, the greater.

        Of a sample that is not the next of its source: as it says.
        """
        said = 0.0 if sample.rate is None else math.hypot(*sample.rate)
        if not self._end:
            return said
        after_s = sample.time_s - float(self._time[self._end - 1])
        if after_s <= 0.0 or sample.sequence <= self._sequence:
            return said
        cosine = min(1.0, abs(float(self._q[self._end - 1] @ np.array(sample.quaternion))))
        return max(said, (2.0 * math.acos(cosine) - _NOISE) / after_s)

    def _is_anew(self, sample: LiveSample, now: float) -> bool:
        """Whether this unused sample and those right before it are a source that began anew."""
        row = self._anew
        if row:
            began, first, _ = row[0]
            _, last, sequence = row[-1]
            agrees = abs((now - sample.time_s) - (began - first)) <= _ANEW_SPREAD_S
            if not agrees or sample.time_s <= last or sample.sequence <= sequence:
                row.clear()
        row.append((now, sample.time_s, sample.sequence))
        del row[1:-2]  # the first and the newest tell it all
        return len(row) >= _ANEW_SAMPLES and now - row[0][0] >= _ANEW_S

    def age(self, now: float) -> float:
        """How far the flown instant lies beyond the newest sample [s]; negative while it can be interpolated."""
        if not self._end:
            return math.inf
        return now - self._delay - self._offset - float(self._time[self._end - 1])

    def at(self, now: float, q: Array) -> bool:
        """q (4,) <- the attitude to fly at `now`; False before the first sample."""
        if not self._end:
            return False
        wanted = now - self._delay - self._offset  # on the source's clock
        last = self._end - 1
        newest = float(self._time[last])
        if wanted >= newest:
            _turned(self._q[last], self._rate[last], wanted - newest, q)
            return True
        k = int(np.searchsorted(self._time[: self._end], wanted, side="right"))  # the first later one
        if k == 0:
            q[:] = self._q[0]  # older than all we keep: the source has only begun
            return True
        h = float(self._time[k] - self._time[k - 1])
        share = (wanted - float(self._time[k - 1])) / h
        _between(self._q[k - 1], self._rate[k - 1], self._q[k], self._rate[k], h, share, q)
        return True
