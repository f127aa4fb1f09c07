"""The curve inside a tube that is nearest to the samples and smooth (mathematics, section 13).

The whole motion is exp(s(t)) R0(t): R0 a smooth base, s a quintic spline in three dimensions about the reference axes.
Its rate is s' + w0 to first order in s, so the cost is the integral of |s''' + w0''|^2, beside the samples' |s - r|^2
where those count, r the rotation vector from base to sample. The tube is a ball about each sample, kept by a
logarithmic barrier whose weight falls (Boyd and Vandenberghe, "Convex Optimization", chapter 11): Newton's systems are
banded, and every iterate is inside.
"""

from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.recorded.banded_cholesky import solve_banded
from fullpose.recorded.smoothing_spline import POINTS, THIRD, gauss_points, roughness
from fullpose.recorded.spline_kernels import DEGREE, WIDTH, Knots, Tube, Weights, add_tube, tube_sums

BARRIERS = (1.0, 0.1, 1e-2, 1e-3)  # its weight beside a sample's, falling
NEWTON = 12  # steps for one weight
SETTLED = 0.1  # of a weight: a step that promises less ends its turn
NARROWER = 1.02  # of the largest deviation: the radius that a curve outside its tube is brought in by
STEPS_IN = 60
SLOW = 0.998  # a radius that falls by less in three steps does not fall any more


@dataclass(frozen=True)
class Programme:
    """Find the curve: knots, the tube of samples, w0'' as its projection, and what roughness costs.

    Lengths are in units of the tolerance, so that the tube's radius is 1 or next to it.
    pinned: whether the curve joins a base that goes on before its first and after its last knot.
    """

    knots: Knots
    tube: Tube
    linear: Array  # (size, 3): integral of the functions' third derivative times w0''
    penalty: float  # of the roughness beside a sample's weight of one
    pinned: tuple[bool, bool]

    @property
    def free(self) -> slice:
        """The coefficients that are unknown."""
        size = self.knots.pieces + DEGREE
        return slice(DEGREE if self.pinned[0] else 0, size - (DEGREE if self.pinned[1] else 0))


def projected(knots: Knots, curvature: Array) -> Array:
    """(size, 3): the integral of each function's third derivative times what Gauss's points (pieces, 4, 3) have."""
    _, weight = gauss_points(knots)
    blocks = np.einsum("p,pa,npi->nai", weight, THIRD, curvature.reshape(-1, POINTS, 3)) / knots.interval**3
    total = np.zeros((knots.pieces + DEGREE, 3))
    for a in range(WIDTH):
        total[a : a + knots.pieces] += blocks[:, a]
    return total


def nearest_in_tube(given: Programme) -> Array:
    """The coefficients (size, 3) of least squares and roughness inside the tube.

    Where there is no curve inside it on these knots, those of the least largest deviation that was found.
    """
    c, radius = brought_in(given)
    return c if radius > given.tube.radius else _descended(given, c)


def brought_in(given: Programme) -> tuple[Array, float]:
    """(coefficients, the radius they are inside of): a tube that narrows about the curve pushes it in."""
    tube = given.tube
    c = np.zeros((given.knots.pieces + DEGREE, 3))
    radius = max(tube.radius, NARROWER * tube_sums(given.knots, tube, c)[2])
    fallen = [radius]
    while radius > tube.radius and len(fallen) <= STEPS_IN:
        wide = Programme(given.knots, tube._replace(radius=radius), given.linear, given.penalty, given.pinned)
        c, _ = _newton(wide, c, Weights(0.0, radius * radius))
        radius = max(tube.radius, NARROWER * tube_sums(given.knots, tube, c)[2])
        fallen.append(radius)
        if len(fallen) > 3 and radius > SLOW * fallen[-4]:
            break
    return c, radius


def _descended(given: Programme, c: Array) -> Array:
    """From inside the tube to the least cost in it."""
    for barrier in BARRIERS:
        for _ in range(NEWTON):
            c, promised = _newton(given, c, Weights(1.0, barrier))
            if promised < SETTLED * barrier:
                break
    return c


def _newton(given: Programme, c: Array, weights: Weights) -> tuple[Array, float]:
    """(coefficients one Newton step on, what the step promised of the cost)."""
    knots, free = given.knots, given.free
    size = knots.pieces + DEGREE
    rough = given.penalty * roughness(knots)
    bands = np.zeros((3 * WIDTH, 3 * size))
    bands[2::3] = rough.repeat(3, axis=1)  # a component at a time: 3 apart
    gradient = given.penalty * given.linear + _times(rough, c)
    add_tube(knots, given.tube, c, weights, bands, gradient)
    right = gradient[free].reshape(-1, 1).copy()
    if not solve_banded(np.ascontiguousarray(bands[:, 3 * free.start : 3 * free.stop]), right):
        return c, 0.0  # no curvature left to the last digit: it is as good as it gets
    step = -right.reshape(-1, 3)
    slope = float(np.vdot(gradient[free], step))
    cost = _cost(given, rough, c, weights)
    share = 1.0
    for _ in range(40):
        trial = c.copy()
        trial[free] += share * step
        if _cost(given, rough, trial, weights) <= cost + 1e-4 * share * slope:
            return trial, -slope
        share *= 0.5
    return c, 0.0


def _cost(given: Programme, rough: Array, c: Array, weights: Weights) -> float:
    squares, barrier, _ = tube_sums(given.knots, given.tube, c)
    smooth = 0.5 * float(np.vdot(c, _times(rough, c))) + given.penalty * float(np.vdot(given.linear, c))
    return smooth + 0.5 * weights.data * squares + weights.barrier * barrier


def _times(bands: Array, c: Array) -> Array:
    """The symmetric matrix of the upper bands (WIDTH, size) times c (size, d)."""
    total = bands[DEGREE][:, None] * c
    for b in range(1, WIDTH):
        band = bands[DEGREE - b, b:][:, None]
        total[:-b] += band * c[b:]
        total[b:] += band * c[:-b]
    return np.asarray(total)
