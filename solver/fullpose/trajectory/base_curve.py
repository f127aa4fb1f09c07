"""A smooth path of the base through chosen needles, and the exact path of all frames that it gives."""

import numpy as np
from scipy import sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import spsolve

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.charts import TURN, base_chart, turn_to
from fullpose.trajectory.clamped_spline import clamped_basis
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.needles import CLEAR, Needles
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrix

DEGREE = 5  # of the base's spline: a jump of its acceleration at a needle is one of the outer frame's rate
RIGID = 1e-9  # beside the squared distances: pieces of the spline without a sample stay put
SIDE = 4  # samples on either side of a needle that those beside it are taken from


def smooth_base(time: Array, base: Array, pins: list[tuple[float, float]], knot: float) -> Array:
    """The quintic spline next to base (n,) [rad] that runs exactly through the pins, (time, angle) each."""
    knots, rows = clamped_basis(time, knot, DEGREE)
    count = rows.shape[1]
    matrix: Matrix = rows.T @ rows + RIGID * sparse.identity(count)
    right = rows.T @ base
    if pins:
        at: Matrix = BSpline.design_matrix(np.array([t for t, _ in pins]), knots, DEGREE)
        matrix = sparse.bmat([[matrix, at.T], [at, None]])
        right = np.r_[right, [angle for _, angle in pins]]
    coefficients: Array = spsolve(sparse.csc_matrix(matrix), right)
    return np.asarray(rows @ coefficients[:count])


@kernel
def frames_of_base(horizontal: bool, attitude: Array, base: Array, branch: Array, first: Array, d: Array) -> None:
    """d (n, 4) [rad] <- the frames of a base path (n,) [rad] with the sign of cos d3 (n,), continuous.

    attitude (n, 3, 3); first (4,) [rad], whose turns the first sample takes.
    """
    near = first
    for k in range(base.shape[0]):
        base_chart(horizontal, attitude[k], base[k], branch[k], d[k])
        turn_to(d[k], d[k, 0], near[1], near[2], near[3])
        near = d[k]


def mended(problem: Problem, found: Needles, d: Array) -> Array:
    """d with the samples next to needles taken from those around them, put back onto the solutions."""
    time, rig = problem.time, problem.rig
    for t in found.time:
        low, high = np.searchsorted(time, (t - CLEAR, t + CLEAR))
        low, high = int(low), int(high)
        if low == 0 or high >= len(time) or low == high:
            continue
        d[high:] += TURN * np.rint((d[low - 1] - d[high]) / TURN)
        a, b = slice(max(0, low - SIDE), low), slice(high, high + SIDE)
        known, values = np.r_[time[a], time[b]], np.concatenate([d[a], d[b]])
        degree = min(DEGREE, len(known) - 1)
        inside = np.ascontiguousarray(
            np.stack(
                [np.polynomial.Polynomial.fit(known, values[:, i], degree)(time[low:high]) for i in range(4)], axis=1
            )
        )
        closest_all(rig.axes, rig.geometry.horizontal, np.ascontiguousarray(problem.attitude[low:high]), inside)
        d[low:high] = inside
    return d
