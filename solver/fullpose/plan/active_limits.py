"""Which limit holds each sample that misses the attitude, read from the angles as they are written."""

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array, Codes, Integers
from fullpose.bounds import CODES, EXACT, POSITION
from fullpose.rig import LIMITS, Rig
from fullpose.trajectory.curve import LOCKED
from fullpose.trajectory.limit_shares import limit_shares
from fullpose.trajectory.linearisation import POSITION_UNIT
from fullpose.verify import attitude_errors, payload_attitudes

CHUNK = 1 << 16  # samples looked at together
AT_LIMIT = 0.02  # share of a limit, or of `POSITION_UNIT` before a stop, within which it holds the frame
TURNED = 1e-4  # [rad] a frame is turned by to see which way the attitude error falls


def active_limits(
    time: Array, attitude: Array, angles: Array, rig: Rig, missed: NDArray[np.bool_]
) -> Codes:  # fmt: skip
    """`limited_code` (n,) of the samples `missed` (n,), `EXACT` elsewhere: only limits that the rig has.

    A limit is active where the path angles (n, 4) [rad] comes within `AT_LIMIT` of it. Of those active at the sample
    nearest in time: the frame whose motion would take most of the attitude error away, a stop only where the frame
    would have to go beyond it; of one frame's, position before rate before acceleration before jerk.
    """
    codes = np.full(len(time), EXACT, np.int16)
    lost = np.flatnonzero(missed)
    if not lost.size:
        return codes
    active = _active(time, angles, rig)
    nearest = _nearest(np.flatnonzero(active.any(axis=(1, 2))), lost)
    for begin in range(0, lost.size, CHUNK):
        part = slice(begin, begin + CHUNK)
        at, held = lost[part], nearest[part]
        descent = _descent(attitude[at], angles[at], rig)
        gain = np.repeat(np.abs(descent)[:, :, None], len(LIMITS), axis=2)
        upper = rig.position_max - angles[held] < angles[held] - rig.position_min
        gain[:, :, POSITION] = np.maximum(0.0, np.where(upper, descent, -descent))
        gain[~active[held]] = -1.0
        best = np.argmax(gain.reshape(len(at), -1), axis=1)
        codes[at] = CODES[best]
    return codes


def _active(time: Array, angles: Array, rig: Rig) -> NDArray[np.bool_]:
    """The active limits (n, 4, 4), at least one in the flight.

    Where none is: the one that the path comes closest to; else, of a path too short to show, any that the rig has.
    A frame that has no room to move counts only where the rig has no other limit: it holds every sample alike.
    """
    has = np.isfinite(np.stack([rig.position_max, rig.max_rate, rig.max_acceleration, rig.max_jerk], axis=1))
    has &= (rig.axes >= 0)[:, None]
    free = has.copy()
    free[:, POSITION] &= rig.position_max - rig.position_min >= LOCKED
    has = free if free.any() else has  # at least one: without a limit nothing keeps a rig from the attitude
    n = len(time)
    active = np.zeros((n, 4, len(LIMITS)), np.bool_)
    closest, within = np.inf, AT_LIMIT
    for _ in range(2):
        for begin in range(0, n, CHUNK):
            end, wide = min(n, begin + CHUNK), max(0, begin - 2)
            left = limit_shares(time[wide : end + 2], angles[wide : end + 2], rig, POSITION_UNIT)
            left = left[begin - wide : end - wide]
            left[:, ~has] = np.inf
            active[begin:end] = left <= within
            closest = min(closest, float(left.min()))
        if active.any():
            return active
        within = closest
        if not np.isfinite(closest):
            break
    return np.broadcast_to(has, active.shape)


def _nearest(places: Integers, samples: Integers) -> Integers:
    """The nearest of `places` (sorted, at least one) to each of `samples`."""
    right = np.clip(np.searchsorted(places, samples), 0, len(places) - 1)
    left = np.maximum(right - 1, 0)
    nearer = np.abs(places[left] - samples) <= np.abs(places[right] - samples)
    return places[np.where(nearer, left, right)]


def _descent(attitude: Array, angles: Array, rig: Rig) -> Array:
    """How fast the attitude error falls with each frame's angle (n, 4)."""
    descent = np.zeros_like(angles)
    for i in rig.geometry.frames:
        turn = np.zeros(4)
        turn[i] = TURNED
        for side in (1.0, -1.0):
            error, _ = attitude_errors(payload_attitudes(rig, angles + side * turn), attitude)
            descent[:, i] -= side * error / (2.0 * TURNED)
    return descent
