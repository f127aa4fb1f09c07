"""The plan of a three-axis rig: there is nothing to choose but one of two Euler sets a sample, and the turns.

The sequence of sets of least squared rates, each as a share of its limit, by dynamic programming over the samples.
At the pole, where the first angle is not determined, it keeps its value of the sample before.
"""

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.charts import TURN, nearest
from fullpose.methods.three_axis import three_axis_angles
from fullpose.rig import Rig, Y
from fullpose.trajectory.shortest_path import reference_rates


@kernel
def euler_path(
    first_is_y: bool, time: Array, attitude: Array, weight: Array, low: Array, high: Array, begin: Array, angles: Array
) -> None:
    """angles (n, 3) <- the cheapest sequence; time (n,), attitude (n, 3, 3), weight (3,) [s^2/rad^2], begin (3,) [rad].

    A set outside low..high (3,) [rad] in every turn costs a thousand times the distance.
    """
    n = time.shape[0]
    sets = np.empty((n, 2, 3))
    back = np.zeros((n, 2), np.int8)
    cost = np.zeros(2)
    fresh = np.zeros(2)
    for k in range(n):
        for branch in range(2):
            previous = sets[k - 1, branch, 0] if k > 0 else begin[0]
            three_axis_angles(first_is_y, attitude[k], 1.0 if branch == 0 else -1.0, previous, sets[k, branch])
            outside = 0.0
            for i in range(3):
                angle = sets[k, branch, i]
                if high[i] < np.inf:
                    angle = nearest(angle, 0.5 * (low[i] + high[i]))
                    outside += max(0.0, angle - high[i], low[i] - angle)
            best = np.inf
            for other in range(2):
                total = cost[other] if k > 0 else 0.0
                for i in range(3):
                    reference = sets[k - 1, other, i] if k > 0 else begin[i]
                    gap = nearest(sets[k, branch, i], reference) - reference
                    h = time[k] - time[k - 1] if k > 0 else 1.0
                    total += weight[i] * gap * gap / h
                if total < best:
                    best = total
                    back[k, branch] = other
            fresh[branch] = best + 1e3 * outside
        cost[0] = fresh[0]
        cost[1] = fresh[1]
    branch = 0 if cost[0] <= cost[1] else 1
    for k in range(n - 1, -1, -1):
        for i in range(3):
            angles[k, i] = sets[k, branch, i]
        branch = back[k, branch]
    for k in range(n):
        for i in range(3):
            angles[k, i] = nearest(angles[k, i], angles[k - 1, i] if k > 0 else begin[i])


def three_axis_path(time: Array, attitude: Array, rig: Rig, start: Array | None) -> Array:
    """The angles (n, 4) [rad] of a three-axis rig, base at zero, shifted by whole turns into the ranges if they fit."""
    columns = list(rig.geometry.frames)
    begin = np.ascontiguousarray((rig.home if start is None else start)[columns])
    weight = (rig.weight / reference_rates(rig) ** 2)[columns]
    three = np.empty((len(time), 3))
    low, high = rig.position_min[columns], rig.position_max[columns]
    euler_path(rig.geometry.axes[columns[0]] == Y, time, attitude, weight, low, high, begin, three)
    if start is None:
        three += turns_into_range(three, low, high)
    angles = np.zeros((len(time), 4))
    angles[:, columns] = three
    return angles


def turns_into_range(angles: Array, low: Array, high: Array) -> Array:
    """Whole turns [rad] a column of (n, m) that bring it inside low..high (m,), as near the middle as turns allow."""
    middle = 0.5 * (angles.min(axis=0) + angles.max(axis=0))
    target = np.where(
        np.isfinite(high), 0.5 * (np.where(np.isfinite(low), low, 0) + np.where(np.isfinite(high), high, 0)), middle
    )
    return np.asarray(TURN * np.rint((target - middle) / TURN))
