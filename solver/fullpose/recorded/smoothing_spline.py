"""The attitude behind a recorded flight's noise: a penalised quintic spline (mathematics, section 13).

Minimises the sum of |q(t_k) - q_k|^2 dt + (2 pi f)^-6 times the integral of |q'''|^2 over uniform quintic B-splines
(Eilers and Marx, "Flexible smoothing with B-splines and penalties", 1996), which passes what is slower than the cut-off
f and stops what is faster. The cut-off is the one of least generalised cross-validation (Craven and Wahba 1979): how
well each sample is told by the others; it needs no noise level. Banded throughout: time and memory are linear.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from fullpose._typing import Array
from fullpose.recorded.banded_cholesky import solve_banded
from fullpose.recorded.spline_kernels import DEGREE, WIDTH, Knots, add_normal_equations, curve

KNOTS = 0.1  # of a cut-off's period between knots: the curve has next to nothing that is faster
FEWEST = 8  # samples below which there is nothing to tell noise by
SLOWEST = 0.5  # cut-off periods over the flight that the search begins with
FASTEST = 2.0  # cut-off periods a sample that it ends with: there the curve passes through every sample
COARSE, FINE = 2.0, 2.0**0.25
HIGHER = 1.4  # than the cut-off of the least score: what the accelerations are flown with
WORSE = 1.02  # a score that much above the best, twice in turn, ends the search
POINTS = 4  # of Gauss's rule a piece: exact for products of third derivatives
PIECE = np.polynomial.legendre.leggauss(POINTS)
BAND = np.polynomial.legendre.leggauss(64)


def uniform_knots(begin: float, end: float, interval: float) -> Knots:
    """Knots over [begin, end], no farther apart than `interval`."""
    pieces = max(1, math.ceil((end - begin) / interval * (1.0 - 1e-12)))
    return Knots(begin, (end - begin) / pieces, pieces)


def spline(knots: Knots, coefficients: Array) -> BSpline:
    """As SciPy has it."""
    return BSpline(knots.begin + knots.interval * np.arange(-DEGREE, knots.pieces + WIDTH), coefficients, DEGREE)


def spline_at(knots: Knots, coefficients: Array, time: Array) -> Array:
    """The values (n, d) at `time` (n,)."""
    out = np.empty((len(time), coefficients.shape[1]))
    curve(knots, time, coefficients, out)
    return out


def _third_derivatives() -> Array:
    """The third derivatives (POINTS, WIDTH) of a piece's functions at the points of Gauss's rule, a knot as unit."""
    at = 0.5 * (PIECE[0] + 1.0)
    knots = np.arange(-DEGREE, WIDTH + 1)
    pieces = [BSpline.basis_element(knots[a : a + WIDTH + 1], extrapolate=False) for a in range(WIDTH)]
    return np.stack([piece.derivative(3)(at) for piece in pieces[::-1]], axis=1)


THIRD = _third_derivatives()


def gauss_points(knots: Knots) -> tuple[Array, Array]:
    """(times (pieces, POINTS), weights (POINTS,)) of Gauss's rule on each piece."""
    at, weight = PIECE
    times = knots.begin + knots.interval * (np.arange(knots.pieces)[:, None] + 0.5 * (at + 1.0)[None, :])
    return times, 0.5 * knots.interval * weight


def roughness(knots: Knots) -> Array:
    """The upper bands (WIDTH, size) of the integral of the products of the functions' third derivatives."""
    _, weight = gauss_points(knots)
    block = THIRD.T @ (weight[:, None] * THIRD) / knots.interval**6  # the same on every piece
    bands = np.zeros((WIDTH, knots.pieces + DEGREE))
    for a in range(WIDTH):
        for b in range(a, WIDTH):
            bands[DEGREE - (b - a), b : b + knots.pieces] += block[a, b]
    return bands


@dataclass(frozen=True)
class Smooth:
    """A quaternion spline of a cut-off, and how well each of the samples it was made from is told by the others."""

    knots: Knots
    coefficients: Array  # (size, 4)
    cut_off_hz: float
    samples: int
    score: float  # generalised cross-validation: a mean square a component

    def at(self, time: Array) -> Array:
        """Unit quaternions (n, 4) at `time` (n,)."""
        q = spline_at(self.knots, self.coefficients, time)
        return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))

    def rate_curvature(self, time: Array) -> Array:
        """The second derivative (n, 3) [rad/s^3] of the rate about the reference axes, w = 2 vec(p' p*) / |p|^2."""
        p = spline(self.knots, self.coefficients)
        p0, p1, p2, p3 = (p(time, order) for order in range(4))
        v0, v1 = _vector(p1, p0), _vector(p2, p0)
        v2 = _vector(p3, p0) + _vector(p2, p1)
        n0, n1, n2 = _dot(p0, p0), 2.0 * _dot(p0, p1), 2.0 * (_dot(p1, p1) + _dot(p0, p2))
        return np.asarray(2.0 * (v2 / n0 - 2.0 * v1 * n1 / n0**2 + v0 * (2.0 * n1**2 / n0**3 - n2 / n0**2)))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=1, keepdims=True))


def _vector(a: Array, b: Array) -> Array:
    """The vector part (n, 3) of a b*, quaternions (n, 4)."""
    return np.asarray(-a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] - np.cross(a[:, 1:], b[:, 1:]))


def cut_off_spline(time: Array, q: Array, cut_off_hz: float, ends: tuple[float, float] | None = None) -> Smooth:
    """The spline of a cut-off: time (n,) [s] increasing, q (n, 4) unit and continuous in sign.

    ends [s]: where the curve begins and ends, if not with the samples; beyond them it is a parabola.
    """
    n, span = len(time), float(time[-1] - time[0])
    interval = span / (n - 1)
    begin, end = ends or (float(time[0]), float(time[-1]))
    knots = uniform_knots(begin, end, max(KNOTS / cut_off_hz, interval))
    bands, right = np.zeros((WIDTH, knots.pieces + DEGREE)), np.zeros((knots.pieces + DEGREE, 4))
    add_normal_equations(knots, time, q, bands, right)
    penalty = (2.0 * math.pi * cut_off_hz) ** -6 / interval
    solved = solve_banded(bands + penalty * roughness(knots), right)
    residual = spline_at(knots, right, time) - q
    mean_square = float(np.vdot(residual, residual)) / (3.0 * n)
    lost = 1.0 - freedom(cut_off_hz, span, n) / n
    score = mean_square / lost**2 if solved and lost > 0.0 else math.inf
    return Smooth(knots, right, cut_off_hz, n, score)


def freedom(cut_off_hz: float, span: float, samples: int) -> float:
    """The degrees of freedom that a cut-off leaves to `samples` over `span` [s]: the trace of the smoother.

    A mode of frequency f passes by 1 / (1 + (f / cut-off)^6), and a flight has 2 span df of them (Demmler and Reinsch
    1975); the parabolas, which pass unchanged, make up for the modes that the ends take.
    """
    top = 0.5 * (samples - 1) / span
    x, weight = BAND
    inside = min(1.0, 4.0 * cut_off_hz / top) * top  # beyond four cut-offs the rest is a power
    f = 0.5 * inside * (x + 1.0)
    passed = float(np.sum(0.5 * inside * weight / (1.0 + (f / cut_off_hz) ** 6)))
    if inside < top:
        passed += cut_off_hz**6 / 5.0 * (inside**-5 - top**-5)
    return 2.0 * span * passed * (samples - 1.5) / (samples - 1) + 1.5


def smoothing_spline(time: Array, q: Array, ends: tuple[float, float] | None = None) -> Smooth:
    """The spline whose cut-off has the least cross-validation score, `FEWEST` samples or more, as `cut_off_spline`.

    A flight is flown by its accelerations, for which the best cut-off is somewhat higher than for its attitude, so the
    answer is the spline of `HIGHER` times that cut-off.
    """
    span = float(time[-1] - time[0])
    lowest, highest = SLOWEST / span, FASTEST * (len(time) - 1) / span
    best = found = cut_off_spline(time, q, lowest, ends)
    rising = 0
    while found.cut_off_hz < highest and rising < 2:
        found = cut_off_spline(time, q, min(found.cut_off_hz * COARSE, highest), ends)
        rising = rising + 1 if found.score > WORSE * best.score else 0
        best = min(best, found, key=lambda one: one.score)
    for power in (-2, -1, 1, 2):
        cut_off = best.cut_off_hz * FINE**power
        if lowest <= cut_off <= highest:
            found = cut_off_spline(time, q, cut_off, ends)
            best = min(best, found, key=lambda one: one.score)
    return cut_off_spline(time, q, min(HIGHER * best.cut_off_hz, highest), ends)
