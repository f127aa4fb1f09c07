"""A bound on what all frames of a rig together can give the body: beyond it no path exists, whatever the search.

w = sum_i d_i' a_i with unit axes a_i, each carried by the frames outside it, so that |w'| <= sum_i |d_i''| +
sum_{i<j} |d_i'| |d_j'|. Both sides by differences of samples: over a step the mean of w' is bounded alike, but for
terms of the order of the step.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import quaternion_from_dcm
from fullpose.recorded.motion import body_motion
from fullpose.resample import continuous
from fullpose.rig import Rig

ROOM = 1.5  # times the bound: far more than the terms of the order of a step


def most_acceleration(rig: Rig) -> float:
    """The body acceleration [rad/s^2] that no motion of the frames inside their limits exceeds; may be infinite."""
    frames = list(rig.geometry.frames)
    rate, acceleration = rig.max_rate[frames], rig.max_acceleration[frames]
    pairs = 0.5 * (float(rate.sum()) ** 2 - float((rate**2).sum())) if np.isfinite(rate).all() else math.inf
    return float(acceleration.sum()) + pairs


@dataclass(frozen=True)
class Beyond:
    """When [s] the attitude accelerates most, by how much, and the most that all frames can give it [rad/s^2]."""

    time: float
    needed: float
    most: float


def beyond_all_frames(time: Array, attitude: Array, rig: Rig) -> Beyond | None:
    """Where the flight of time (n,) [s], attitude (n, 3, 3) needs clearly more than that; None: nowhere."""
    most = most_acceleration(rig)
    if len(time) < 3 or not math.isfinite(most):
        return None
    peak = body_motion(np.array(time), continuous(quaternion_from_dcm(attitude))).acceleration
    return Beyond(peak.norm_time_s, peak.norm, most) if peak.norm > ROOM * most else None
