"""A smooth path of one frame through chosen needles, and what is next to needles mended."""

import numpy as np
from scipy import sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import spsolve

from fullpose._typing import Array, Integers
from fullpose.charts import TURN
from fullpose.trajectory.clamped_spline import clamped_basis
from fullpose.trajectory.curve import closest_all
from fullpose.trajectory.needles import CLEAR, Needles
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.qp import Matrix

DEGREE = 5  # of the base's spline: a jump of its acceleration at a needle is one of the outer frame's rate
RIGID = 1e-9  # beside the squared distances: pieces of the spline without a sample stay put
SIDE = 4  # samples on either side of a needle that those beside it are taken from


def smooth_base(
    time: Array, known: Integers, base: Array, pins: list[tuple[float, float]], knot: float
) -> Array:  # fmt: skip
    """The quintic spline (n,) at time (n,) [s] next to base (m,) [rad] at the samples `known` (m,), exactly through the
    pins, (time, angle) each."""
    knots, rows = clamped_basis(time, knot, DEGREE)
    count = rows.shape[1]
    near = rows[known]
    matrix: Matrix = near.T @ near + RIGID * sparse.identity(count)
    right = near.T @ base
    if pins:
        at: Matrix = BSpline.design_matrix(np.array([t for t, _ in pins]), knots, DEGREE)
        matrix = sparse.bmat([[matrix, at.T], [at, None]])
        right = np.r_[right, [angle for _, angle in pins]]
    coefficients: Array = spsolve(sparse.csc_matrix(matrix), right)
    return np.asarray(rows @ coefficients[:count])


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
