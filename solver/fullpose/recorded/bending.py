"""A smooth base bent into a tube where a sample is outside it, and how far that can go (mathematics, section 13)."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.attitude import (
    quaternion_from_rotation_vector,
    quaternion_product,
    rotation_vector_from_quaternion,
)
from fullpose.recorded.smoothing_spline import KNOTS, Smooth, gauss_points, spline_at, uniform_knots
from fullpose.recorded.spline_kernels import DEGREE, Knots, Tube
from fullpose.recorded.tube_curve import Programme, brought_in, nearest_in_tube, projected

BEND = 0.1  # of the rate of the samples that count: what a bend is at most as fast as
MARGIN = 2.0  # periods of that on either side of a sample outside the tube, in which the curve is bent
INSIDE = 1.0 - 1e-6  # of the tolerance is the tube's radius
ATTEMPTS = 4  # at the radius: the tube is measured along the sphere, the curve in its tangent space
HOPELESS = 1.1  # of the tolerance: no curve of these knots is inside
LOOKED_AT = 4  # of the largest deviations are looked at for the floor
NARROWEST = 0.25  # of a deviation is as far as it is brought in


@dataclass(frozen=True)
class Bending:
    """A base and the samples that it is bent to: time (n,) [s], q (n, 4), and which of them count as data."""

    base: Smooth
    time: Array
    q: Array
    true: NDArray[np.bool_]

    @property
    def fastest_hz(self) -> float:
        """The cut-off of a bend."""
        span = self.base.knots.interval * self.base.knots.pieces
        return min(self.base.cut_off_hz, BEND * (self.base.samples - 1) / span)

    @property
    def penalty(self) -> float:
        """Of roughness beside a sample's weight of one."""
        spacing = self.base.knots.interval * self.base.knots.pieces / (self.base.samples - 1)
        return (2.0 * math.pi * self.fastest_hz) ** -6 / spacing


def in_tube(given: Bending, tolerance: float) -> Array:
    """The base, bent where a sample is outside the tube: unit quaternions (n, 4), the best that was found."""
    q0 = given.base.at(given.time)
    r = rotation_vectors(given.q, q0)
    best, least = q0, float(np.linalg.norm(r, axis=1).max())
    radius = INSIDE * tolerance
    for _ in range(ATTEMPTS):
        s = np.zeros_like(r)
        for part in _stretches(given, np.linalg.norm(r, axis=1) > radius):
            programme = _programme(given, part, r, radius)
            s[part.samples] = spline_at(part.knots, nearest_in_tube(programme), programme.tube.time) * radius
        bent = np.asarray(quaternion_product(quaternion_from_rotation_vector(s), q0))
        largest = float(geodesic(bent, given.q).max())
        if largest < least:
            best, least = bent, largest
        if largest <= tolerance or largest > HOPELESS * tolerance:
            break
        radius *= INSIDE * tolerance / largest
    return best


def floor_of(given: Bending) -> float:
    """The tolerance [rad] below which no curve as smooth as the base, bent, is near every sample; a bound from below.

    From the samples that are farthest from the base, each with its surroundings alone.
    """
    r = rotation_vectors(given.q, given.base.at(given.time))
    away = np.linalg.norm(r, axis=1)
    floor = 0.0
    for _ in range(LOOKED_AT):
        k = int(np.argmax(away))
        if away[k] <= floor:
            break
        outside = np.zeros(len(r), bool)
        outside[k] = True
        for part in _stretches(given, outside):
            free = replace(_programme(given, part, r, NARROWEST * float(away[k])), pinned=(False, False))
            _, reached = brought_in(free)
            floor = max(floor, reached * NARROWEST * float(away[k]))
            away[part.samples] = 0.0
    return floor


def geodesic(a: Array, b: Array) -> Array:
    """The angle (n,) [rad] between unit quaternions (n, 4)."""
    return np.asarray(np.linalg.norm(rotation_vectors(a, b), axis=1))


def rotation_vectors(a: Array, b: Array) -> Array:
    """The rotation (n, 3) [rad] about the reference axes from b to a, unit quaternions (n, 4): log(a b*)."""
    return rotation_vector_from_quaternion(quaternion_product(a, b * np.array([1.0, -1.0, -1.0, -1.0])))


@dataclass(frozen=True)
class _Stretch:
    """A part of the flight that is bent: its knots, its samples, whether the base goes on before and after it."""

    knots: Knots
    samples: slice
    pinned: tuple[bool, bool]


def _stretches(given: Bending, outside: NDArray[np.bool_]) -> Iterator[_Stretch]:
    """The pieces about the samples outside, far enough to either side."""
    begin, interval, pieces = given.base.knots
    time = given.time
    knots = uniform_knots(begin, begin + interval * pieces, 0.5 * KNOTS / given.fastest_hz)
    piece = np.clip(((time[outside] - knots.begin) / knots.interval).astype(np.int64), 0, knots.pieces - 1)
    reach = math.ceil(MARGIN / (given.fastest_hz * knots.interval)) + DEGREE
    breaks = np.flatnonzero(np.diff(piece) > 2 * reach) + 1
    for group in np.split(piece, breaks) if piece.size else []:
        low, high = max(0, int(group[0]) - reach), min(knots.pieces, int(group[-1]) + reach + 1)
        begin = knots.begin + low * knots.interval
        first = int(np.searchsorted(time, begin)) if low else 0
        last = int(np.searchsorted(time, knots.begin + high * knots.interval)) if high < knots.pieces else len(time)
        yield _Stretch(Knots(begin, knots.interval, high - low), slice(first, last), (low > 0, high < knots.pieces))


def _programme(given: Bending, part: _Stretch, r: Array, radius: float) -> Programme:
    """The programme of a stretch; lengths in units of the radius."""
    at, _ = gauss_points(part.knots)
    linear = projected(part.knots, given.base.rate_curvature(at.ravel())) / radius
    data = given.true[part.samples].astype(np.float64)
    tube = Tube(given.time[part.samples], r[part.samples] / radius, data, 1.0)
    return Programme(part.knots, tube, linear, given.penalty, part.pinned)
