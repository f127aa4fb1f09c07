"""Exact curves next to given ones: orthogonal projection onto the solutions, and the smooth curve through a node path.

The step methods' chart keeps d1 or d4, which is right for one sample but has a corner where the chart changes. Here a
curve is put back by the shortest way (Newton along J^+), which is smooth in its input; only at the very end does
the chart take the last digits.
"""

import math

import numpy as np
from scipy.linalg import solveh_banded

from fullpose._jit import inlined, kernel
from fullpose._typing import Array, Integers
from fullpose.charts import project
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.least_squares import adjugate, gram

DAMPING = 1e-14  # least damping of the projection: rounding may move a singular pose by 1e-9 rad, no more
LOCKED = 1e-4  # [rad] a frame with a range below does not move: the others follow from it
POLISHED = 1e-10  # [rad] the last digits; a chart that moves a pose by more is next to its fold


@kernel
def closest(axes: Integers, C: Array, d: Array) -> float:
    """d <- the exact pose next to d by Newton steps of least norm; returns the error left [rad].

    C (3, 3), d (4,) [rad] in place. Damped by the square of the error (Levenberg-Marquardt), which costs no order of
    convergence and lets a path through the singularity that does not ask for the lost direction.
    """
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    e = np.empty(3)
    size = 0.0
    for iteration in range(12):
        payload_attitude(axes, d, F)
        size = rotation_error(F, C, e)
        if size < 4e-16 or (iteration > 2 and size < 4e-15):
            break
        jacobian(axes, d, J)
        # (J J^T + damping) y = -e
        damping = max(DAMPING, 0.1 * size * size)
        a00, a01, a02, a11, a12, a22 = gram(J)
        c00, c01, c02, c11, c12, c22, det = adjugate(a00 + damping, a01, a02, a11 + damping, a12, a22 + damping)
        y0 = -(c00 * e[0] + c01 * e[1] + c02 * e[2]) / det
        y1 = -(c01 * e[0] + c11 * e[1] + c12 * e[2]) / det
        y2 = -(c02 * e[0] + c12 * e[1] + c22 * e[2]) / det
        scale = 1.0
        longest = 0.0
        for k in range(4):
            longest = max(longest, abs(J[0, k] * y0 + J[1, k] * y1 + J[2, k] * y2))
        if longest > 0.5:
            scale = 0.5 / longest
        for k in range(4):
            d[k] += scale * (J[0, k] * y0 + J[1, k] * y1 + J[2, k] * y2)
    return size


@kernel
def closest_all(axes: Integers, horizontal: bool, attitude: Array, d: Array) -> int:
    """`closest` of every row in place; returns how many had to fall back to the chart (singular or not converged).

    attitude (n, 3, 3), d (n, 4) [rad].
    """
    fallen = 0
    near = np.empty(4)
    for k in range(d.shape[0]):
        near[:] = d[k]
        size = closest(axes, attitude[k], d[k])
        if not size < 1e-9:
            project(horizontal, attitude[k], near, d[k])
            fallen += 1
    return fallen


@kernel
def hold_locked(horizontal: bool, axes: Integers, attitude: Array, low: Array, high: Array, d: Array) -> None:
    """Slide every row of d (n, 4) along the solutions until its locked frame is in the middle of its range, in place.

    low, high (4,) [rad]. Of several locked frames the one that the self-motion moves most; where none is moved by it,
    nothing is done.
    """
    null = np.empty((1, 4))
    for k in range(d.shape[0]):
        for _ in range(20):
            null_vectors(horizontal, d[k : k + 1], null)
            frame = -1
            for i in range(4):
                most = abs(null[0, frame]) if frame >= 0 else 1e-3
                if high[i] - low[i] < LOCKED and axes[i] >= 0 and abs(null[0, i]) > most:
                    frame = i
            if frame < 0:
                break
            gap = 0.5 * (low[frame] + high[frame]) - d[k, frame]
            if abs(gap) < 1e-15:
                break
            along = min(max(gap / null[0, frame], -0.2), 0.2)
            for i in range(4):
                d[k, i] += along * null[0, i]
            closest(axes, attitude[k], d[k])


@kernel
def polish(horizontal: bool, attitude: Array, d: Array) -> None:
    """The last digits, in place: every row through the chart that is farther from its fold, unless that is upon it."""
    exact = np.empty(4)
    for k in range(d.shape[0]):
        project(horizontal, attitude[k], d[k], exact)
        near = True
        for i in range(4):
            if abs(exact[i] - d[k, i]) > POLISHED:
                near = False
        if near:
            d[k] = exact


@kernel
def null_vectors(horizontal: bool, d: Array, n: Array) -> None:
    """n <- unit null vectors, (c3, -s2 s3, -c2 c3, -s2) scaled. d, n (k, 4).

    The vector vanishes at the singularity and comes out of it turned round: along a path that runs through, its
    direction is continued, and kept where it is not determined.
    """
    for k in range(d.shape[0]):
        s2 = math.sin(d[k, 1])
        c2 = math.cos(d[k, 1])
        s3 = math.sin(d[k, 2])
        c3 = math.cos(d[k, 2])
        n[k, 0] = c3
        n[k, 1] = -s2 * s3
        n[k, 2] = -c2 * c3
        n[k, 3] = s2 if horizontal else -s2
        size = math.sqrt(c3 * c3 + s2 * s2 * s3 * s3 + c2 * c2 * c3 * c3 + s2 * s2)
        if size < 1e-7 and k > 0:
            n[k] = n[k - 1]
            continue
        dot = 0.0
        for i in range(4):
            n[k, i] = n[k, i] / size if size > 0.0 else 0.0
            dot += n[k, i] * n[k - 1, i] if k > 0 else 0.0
        if dot < 0.0:
            for i in range(4):
                n[k, i] = -n[k, i]


def smoothed(y: Array, stiffness: float) -> Array:
    """The rows of y (k, m), evenly spaced, with stiffness * |second difference|^2 weighed against |change|^2."""
    n = len(y)
    if n < 3 or stiffness == 0.0:
        return y.copy()
    bands = np.zeros((3, n))  # I + stiffness D^T D, upper
    bands[2] = 1.0
    for row, value in ((slice(0, n - 2), 1.0), (slice(1, n - 1), 4.0), (slice(2, n), 1.0)):
        bands[2, row] += stiffness * value
    bands[1, 1 : n - 1] += -2.0 * stiffness
    bands[1, 2:n] += -2.0 * stiffness
    bands[0, 2:n] += stiffness
    return np.asarray(solveh_banded(bands, y, check_finite=False))


@inlined
def hermite(rise: float, slope0: float, slope1: float, h: float, s: float) -> tuple[float, float, float]:
    """The cubic with slopes slope0, slope1 at the ends of an interval h, which goes up by `rise` there, at s in [0, 1].

    Returns (how far it is off the chord, its first and its second derivative).
    """
    a = 1.0 - s
    bend0 = slope0 * h - rise
    bend1 = rise - slope1 * h
    bend = a * bend0 + s * bend1
    first = (rise + (1.0 - 2.0 * s) * bend + s * a * (bend1 - bend0)) / h
    second = (2.0 * (1.0 - 2.0 * s) * (bend1 - bend0) - 2.0 * bend) / (h * h)
    return s * a * bend, first, second


@kernel
def spline_rows(knots: Array, y: Array, slope: Array, time: Array, out: Array) -> None:
    """out <- the cubic Hermite curve through (knots, y) with the slopes given, at `time` (increasing)."""
    j = 0
    last = knots.shape[0] - 2
    for k in range(time.shape[0]):
        while j < last and time[k] > knots[j + 1]:
            j += 1
        h = knots[j + 1] - knots[j]
        s = (time[k] - knots[j]) / h
        a = 1.0 - s
        for i in range(y.shape[1]):
            off_chord, _, _ = hermite(y[j + 1, i] - y[j, i], slope[j, i], slope[j + 1, i], h, s)
            out[k, i] = a * y[j, i] + s * y[j + 1, i] + off_chord


def spline_slopes(knots: Array, y: Array) -> Array:
    """Slopes of the natural cubic spline through (knots (k,), y (k, m))."""
    n = len(knots)
    if n == 2:
        return np.repeat((y[1:] - y[:1]) / (knots[1] - knots[0]), 2, axis=0)
    h = np.diff(knots)
    chord = np.diff(y, axis=0) / h[:, None]
    bands = np.zeros((2, n))
    bands[1, :-1] += 2.0 / h
    bands[1, 1:] += 2.0 / h
    bands[0, 1:] = 1.0 / h
    right = np.zeros_like(y)
    right[:-1] += 3.0 * chord / h[:, None]
    right[1:] += 3.0 * chord / h[:, None]
    return np.asarray(solveh_banded(bands, right, check_finite=False))
