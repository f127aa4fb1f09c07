"""Where a path that misses the attitude is as good as exact, it is made exact, as far as the limits let it."""

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.bounds import MET
from fullpose.plan.fallback import EXACT_ERROR
from fullpose.trajectory.constraints import exceeded, rig_limits
from fullpose.trajectory.curve import closest
from fullpose.trajectory.problem import Problem
from fullpose.verify import attitude_errors, payload_attitudes

NEARLY = np.radians(0.02)  # [rad] an error below which a sample is tried
RAMP = 0.1  # [s] over which a path goes from one to the other
TRIALS = 12  # each leaves out more around the places where the limits do not hold
SPREAD = 2  # times as much is left out each time


def exact_again(problem: Problem, angles: Array) -> tuple[Array, Array]:
    """(the path (n, 4), exact wherever the limits let it, and its attitude errors (n,)) [rad] of one inside them."""
    time, rig = problem.time, problem.rig
    error, _ = attitude_errors(payload_attitudes(rig, angles), problem.attitude)
    exact = angles.copy()
    left = np.empty(len(time))
    closest_each(rig.axes, problem.attitude, exact, left)
    near = (error < NEARLY) & (left <= EXACT_ERROR)
    limits = rig_limits(rig)
    aside = RAMP
    for _ in range(TRIALS):
        weight = _weights(time, near)
        path = angles + weight[:, None] * (exact - angles)
        violation, _ = exceeded(time, path, limits)
        broken = np.flatnonzero((violation.max(axis=1) > MET) & (np.convolve(weight, np.ones(3), "same") > 0.0))
        if not broken.size:
            after, _ = attitude_errors(payload_attitudes(rig, path), problem.attitude)
            return path, after
        for k in broken:
            near[np.searchsorted(time, time[k] - aside) : np.searchsorted(time, time[k] + aside, side="right")] = False
        aside *= SPREAD
    return angles.copy(), error


def _weights(time: Array, near: NDArray[np.bool_]) -> Array:
    """1 deep inside the runs of samples `near` (n,), 0 outside, and smoothly between, over `RAMP`."""
    n = len(time)
    far = np.flatnonzero(~near)
    if not far.size:
        return np.ones(n)
    after = np.searchsorted(far, np.arange(n))
    left = np.where(after > 0, time - time[far[np.maximum(after - 1, 0)]], np.inf)
    right = np.where(after < far.size, time[far[np.minimum(after, far.size - 1)]] - time, np.inf)
    s = np.clip(np.minimum(left, right) / RAMP, 0.0, 1.0)
    return np.where(near, s**3 * (10.0 + s * (6.0 * s - 15.0)), 0.0)


@kernel
def closest_each(axes: Integers, attitude: Array, d: Array, left: Array) -> None:
    """d (n, 4) [rad] <- the exact poses of attitude (n, 3, 3) next to it, in place; left (n,) [rad]: what is missed."""
    for k in range(d.shape[0]):
        left[k] = closest(axes, attitude[k], d[k])
