"""The needles of a flight in the plane of time and base angle (mathematics, section 14).

With the sign of cos d3 fixed, any smooth base angle gives four smooth frames by the base chart, but at isolated points:
where sin d2 cos d3 = V01 crosses zero at a time t and M00 = V00 cos d1 - V02 sin d1 is zero too. Beside such a point d2
turns round; a path exactly through it crosses the fold, cos d3 changes sign, and all stays smooth.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.charts import vertical_views

DEGREE, REACH = 7, 4  # of the local fit, and how many samples on either side it goes through
TOUCH = 3e-6  # a pitch whose extremum comes as near to zero as this touches it
CLEAR = 0.004  # [s] around a needle in which a base angle has no digits for the outer and inner frames
APART = 1e-3  # [s] two roots nearer than this are one


@dataclass(frozen=True)
class Needles:
    """Times (m,) [s], increasing, and base angles (m,) [rad]: each stands for that angle plus any half turns."""

    time: Array
    base: Array


def needles(time: Array, attitude: Array, horizontal: bool) -> Needles:
    """The needles of a flight: time (n,) [s], attitude (n, 3, 3)."""
    rows = vertical_views(attitude, horizontal)[:, 0]
    if len(time) < 2 * REACH + 1:
        return Needles(np.empty(0), np.empty(0))
    found: list[tuple[float, float]] = []
    for k in _candidates(rows[:, 1]).tolist():
        root = _root(time, rows, k)
        if root is not None and (not found or root[0] > found[-1][0] + APART):
            found.append(root)
    table = np.array(found).reshape(-1, 2)
    return Needles(table[:, 0].copy(), table[:, 1].copy())


def _candidates(s: Array) -> NDArray[np.intp]:
    """Samples before which, or at which, V01 (n,) crosses or touches zero."""
    crossing = (s[:-1] * s[1:] < 0.0) | (s[:-1] == 0.0)
    size = np.abs(s)
    touching = np.zeros(len(s) - 1, np.bool_)
    touching[1:] = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (size[1:-1] < TOUCH)
    return np.flatnonzero(crossing | touching)


def _root(time: Array, rows: Array, k: int) -> tuple[float, float] | None:
    """(time, base angle) of the root of V01 next to sample k, by a polynomial through the samples around it."""
    begin = min(max(0, k + 1 - REACH), len(time) - 2 * REACH)
    part = slice(begin, begin + 2 * REACH)
    middle, unit = time[k], time[min(k + 1, len(time) - 1)] - time[max(k, 0)] or 1.0
    u = (time[part] - middle) / unit
    # `full`: stamps next to each other leave the fit fewer degrees, which is no news here.
    fits = [np.polynomial.Polynomial.fit(u, rows[part, i], DEGREE, full=True)[0] for i in range(3)]
    roots = [complex(root) for root in fits[1].roots()]
    near = [root.real for root in roots if abs(root.imag) < 0.5 and -0.6 <= root.real <= 1.6]
    if not near:
        return None
    at = min(near, key=lambda root: abs(root - 0.5))
    v00, v02 = float(fits[0](at)), float(fits[2](at))
    return middle + at * unit, math.atan2(v00, v02)
