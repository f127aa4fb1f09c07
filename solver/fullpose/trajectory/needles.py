"""What a path must run through exactly in the plane of time and one frame's angle (mathematics, section 14).

Needles, of the planes of base and inner frame: with the sign of cos d3 fixed, any smooth base angle gives four smooth
frames by the base chart, but at isolated points: where sin d2 cos d3 = V01 crosses zero at a time t and
M00 = V00 cos d1 - V02 sin d1 is zero too. Beside such a point d2 turns round; a path exactly through it crosses the
fold, cos d3 changes sign, and all stays smooth. The inner frame's are at the same times,
where V11 sin d4 + V21 cos d4 = 0.

Gates, of the planes of outer and middle frame: |sin d2| and |cos d3| are never below |V01|. Where |V01| is largest, a
path that touches this bound has the other of the two on its way through 0 or 180 deg; beside it that turns round.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.charts import vertical_views
from fullpose.rig import Rig

DEGREE, REACH = 7, 4  # of the local fit, and how many samples on either side it goes through
TOUCH = 3e-6  # a pitch whose extremum comes as near to zero as this touches it
CLEAR = 0.004  # [s] around a needle in which a base angle has no digits for the outer and inner frames
APART = 1e-3  # [s] two roots nearer than this are one
BEND = 0.01  # [s] between the three samples that a gate's curvature is taken from
LEVEL = 1e-3  # a gate's |V01| below which it is none: it is two needles
BASE, OUTER, MIDDLE, INNER = range(4)


@dataclass(frozen=True)
class Needles:
    """Times (m,) [s], increasing, base and inner angles (m,) [rad]: each stands for that angle plus any half turns."""

    time: Array
    base: Array
    inner: Array


@dataclass(frozen=True)
class Aims:
    """What may be aimed at in the plane of a frame: times (m,) [s] and angles (m,) [rad], up to half turns.

    A path of slope v runs by bend v^2 beside the angle, (m,) [s^2/rad]: the vertex of a parabola that it touches.
    """

    time: Array
    angle: Array
    bend: Array
    exact: bool  # whether a path has to run exactly through


def needles(time: Array, attitude: Array, horizontal: bool) -> Needles:
    """The needles of a flight: time (n,) [s], attitude (n, 3, 3)."""
    V = vertical_views(attitude, horizontal)
    rows = np.concatenate([V[:, 0], V[:, 1:, 1]], axis=1)  # V00, V01, V02, V11, V21
    if len(time) < 2 * REACH + 1:
        return Needles(np.empty(0), np.empty(0), np.empty(0))
    found: list[tuple[float, float, float]] = []
    for k in _candidates(rows[:, 1]).tolist():
        root = _root(time, rows, k)
        if root is not None and (not found or root[0] > found[-1][0] + APART):
            found.append(root)
    table = np.array(found).reshape(-1, 3)
    return Needles(table[:, 0].copy(), table[:, 1].copy(), table[:, 2].copy())


def aims_of(found: Needles, time: Array, attitude: Array, rig: Rig, frame: int) -> Aims:
    """What may be aimed at in the plane of a frame."""
    if frame in (BASE, INNER):
        angle = found.base if frame == BASE else found.inner
        return Aims(found.time, angle, np.zeros(len(angle)), True)
    at, leaned, bend = gates(time, vertical_views(attitude, rig.geometry.horizontal)[:, 0, 1])
    side = leaned if frame == OUTER else leaned - 0.5 * math.pi  # beyond it on the side of `bend`, both times
    pairs = np.stack([side, -side], axis=1), np.stack([bend, -bend], axis=1)
    return Aims(np.repeat(at, 2), pairs[0].ravel(), pairs[1].ravel(), False)


def gates(time: Array, sine: Array) -> tuple[Array, Array, Array]:
    """(time [s], angle [rad], 1 / (2 |its curvature|)) of the maxima of the angle whose |sine| (n,) is given."""
    leaned = np.arcsin(np.clip(np.abs(sine), 0.0, 1.0))
    peak = 1 + np.flatnonzero((leaned[1:-1] >= leaned[:-2]) & (leaned[1:-1] > leaned[2:]) & (leaned[1:-1] > LEVEL))
    step = max(1, round(BEND / float(np.median(np.diff(time)))))
    peak = peak[(peak >= step) & (peak < len(time) - step)]
    before, here, after = leaned[peak - step], leaned[peak], leaned[peak + step]
    length = 0.5 * (time[peak + step] - time[peak - step])
    curvature = np.maximum((2.0 * here - before - after) / length**2, 1e-3)
    slope = 0.5 * (after - before) / length
    return time[peak] + slope / curvature, here + 0.5 * slope**2 / curvature, 0.5 / curvature


def _candidates(s: Array) -> NDArray[np.intp]:
    """Samples before which, or at which, V01 (n,) crosses or touches zero."""
    crossing = (s[:-1] * s[1:] < 0.0) | (s[:-1] == 0.0)
    size = np.abs(s)
    touching = np.zeros(len(s) - 1, np.bool_)
    touching[1:] = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (size[1:-1] < TOUCH)
    return np.flatnonzero(crossing | touching)


def _root(time: Array, rows: Array, k: int) -> tuple[float, float, float] | None:
    """(time, base angle, inner angle) of the root of V01 next to sample k, by polynomials through the samples around
    it."""
    begin = min(max(0, k + 1 - REACH), len(time) - 2 * REACH)
    part = slice(begin, begin + 2 * REACH)
    middle, unit = time[k], time[min(k + 1, len(time) - 1)] - time[max(k, 0)] or 1.0
    u = (time[part] - middle) / (REACH * unit)
    # `full`: stamps next to each other leave the fit fewer degrees, which is no news here.
    fits, _ = np.polynomial.polynomial.polyfit(u, rows[part], DEGREE, full=True)
    roots = [complex(root) * REACH for root in np.polynomial.polynomial.polyroots(fits[:, 1])]
    near = [root.real for root in roots if abs(root.imag) < 0.5 and -0.6 <= root.real <= 1.6]
    if not near:
        return None
    at = min(near, key=lambda root: abs(root - 0.5))
    value: Array = np.asarray(np.polynomial.polynomial.polyval(at / REACH, fits))
    v00, _, v02, v11, v21 = map(float, value)
    return middle + at * unit, math.atan2(v00, v02), math.atan2(-v21, v11)
