"""Kernels of the refinement: limits of a sampled path, and the rows of its quadratic programme.

The path is x_k = d_k + n_k z_k with z in a `Basis`. Rates and accelerations are the differences at the sample rate that
the verdict takes: v_k = (x_k - x_{k-1}) / h_k, a_k = (v_{k+1} - v_k) / ((h_k + h_{k+1}) / 2), jerks likewise, where a
rig limits them: arrays of a column a kind of limit have three columns, or four. Rows are divided by the limit.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Flags, Integers
from fullpose.bounds import ACCELERATION, JERK, LOWER, POSITION, RATE, UPPER
from fullpose.trajectory.bspline import WIDTH, Basis

ROW = WIDTH + 2  # functions that one row of differences can touch,
JERK_ROW = WIDTH + 3  # and one of third differences
POSITION_UNIT = 0.02  # [rad] counts as much as the whole of a rate limit
NEARLY = 0.3  # share of a rate, acceleration or jerk limit below which even a row that is asked for cannot matter


class Iterate(NamedTuple):
    """The path as it is, and the direction along which each sample may be displaced."""

    time: Array  # (n,) [s]
    d: Array  # (n, 4) [rad]
    n: Array  # (n, 4) the null vectors, or ones where every frame is displaced by itself


class Limits(NamedTuple):
    """The limits that a path keeps to, arrays (4,) [rad, rad/s, rad/s^2, rad/s^3]; infinite where there is none."""

    low: Array
    high: Array
    rate: Array
    acceleration: Array
    jerk: Array

    @property
    def kinds(self) -> int:
        """How many kinds of limits there are: jerk is one only where a frame has it."""
        return 4 if np.isfinite(self.jerk).any() else 3


class Reach(NamedTuple):
    """Which rows may matter to a step: at every `stride`-th sample those near a limit, and those that `flags` mark."""

    stride: int
    flags: Flags  # (n, 3 or 4) a column a kind of limit
    trust: float  # [rad] the farthest along the direction that a step goes
    near: float  # share of a rate, acceleration or jerk limit from which its rows are taken


class Row(NamedTuple):
    """One linear condition on the coefficients, those from `origin` on: row c = value, or <= value."""

    origin: int
    row: Array  # (ROW,)
    value: float
    frame: int = 0  # whose coefficients they are, where all frames are free


class Rows(NamedTuple):
    """Rows of a quadratic programme, row c <= room, over the coefficients from `origin` on."""

    origin: Integers  # (r,)
    rows: Array  # (r, ROW or JERK_ROW)
    room: Array  # (r,)
    bound: Integers  # (r, 3) `Bound`: frame, limit, side


@kernel
def difference(kind: int, k: int, i: int, time: Array, d: Array) -> float:
    """Position, rate, acceleration or jerk of frame i at sample k; time (n,) [s], d (n, 4) [rad]. Ends: nan."""
    if kind == POSITION:
        return float(d[k, i])
    if k < 1:
        return np.nan
    past = (d[k, i] - d[k - 1, i]) / (time[k] - time[k - 1])
    if kind == RATE:
        return float(past)
    if k > time.shape[0] - 2:
        return np.nan
    ahead = (d[k + 1, i] - d[k, i]) / (time[k + 1] - time[k])
    bend = (ahead - past) / (0.5 * (time[k + 1] - time[k - 1]))
    if kind == ACCELERATION:
        return float(bend)
    if k < 2:
        return np.nan
    before = (d[k - 1, i] - d[k - 2, i]) / (time[k - 1] - time[k - 2])
    bend_before = (past - before) / (0.5 * (time[k] - time[k - 2]))
    return float(3.0 * (bend - bend_before) / (time[k + 1] - time[k - 2]))


@kernel
def limit_violations(time: Array, d: Array, limits: Limits, violation: Array, frame: NDArray[np.int8]) -> None:
    """over (n, 3 or 4) <- how far outside a limit each sample is, a column a kind, <= 0 inside; and whose.

    Rates, accelerations and jerks as shares of the limit, positions in `POSITION_UNIT`. frame, as over.
    """
    low, high, rate, acceleration, jerk = limits
    kinds = violation.shape[1]
    n = time.shape[0]
    for k in range(n):
        for kind in range(kinds):
            violation[k, kind] = -np.inf
            frame[k, kind] = -1
        for i in range(4):
            gap = max(d[k, i] - high[i], low[i] - d[k, i]) / POSITION_UNIT
            if gap > violation[k, POSITION]:
                violation[k, POSITION] = gap
                frame[k, POSITION] = i
            if k >= 1 and rate[i] < np.inf:
                gap = abs(difference(RATE, k, i, time, d)) / rate[i] - 1.0
                if gap > violation[k, RATE]:
                    violation[k, RATE] = gap
                    frame[k, RATE] = i
            if k >= 1 and k < n - 1 and acceleration[i] < np.inf:
                gap = abs(difference(ACCELERATION, k, i, time, d)) / acceleration[i] - 1.0
                if gap > violation[k, ACCELERATION]:
                    violation[k, ACCELERATION] = gap
                    frame[k, ACCELERATION] = i
            if kinds > JERK and k >= 2 and k < n - 1 and jerk[i] < np.inf:
                gap = abs(difference(JERK, k, i, time, d)) / jerk[i] - 1.0
                if gap > violation[k, JERK]:
                    violation[k, JERK] = gap
                    frame[k, JERK] = i


@kernel
def displaced(d: Array, n: Array, basis: Basis, c: Array, out: Array) -> None:
    """out <- d + n z, z the spline of coefficients c. d, n, out (k, 4)."""
    _, first, values = basis
    for k in range(d.shape[0]):
        z = 0.0
        for b in range(values.shape[1]):
            if first[k] + b < c.shape[0]:
                z += values[k, b] * c[first[k] + b]
        for i in range(4):
            out[k, i] = d[k, i] + n[k, i] * z


@kernel
def _add(row: Array, origin: int, k: int, scale: float, first: Integers, values: Array) -> None:
    for b in range(values.shape[1]):
        row[first[k] - origin + b] += scale * values[k, b]


@kernel
def fill_row(kind: int, k: int, i: int, at: Iterate, basis: Basis, row: Array) -> int:
    """row (ROW,), of a jerk (JERK_ROW,) <- derivative of `difference` by the coefficients; returns the first index."""
    time, _, n = at
    _, first, values = basis
    row[:] = 0.0
    if kind == POSITION:
        _add(row, first[k], k, n[k, i], first, values)
        return int(first[k])
    origin = int(first[k - 1])
    h0 = time[k] - time[k - 1]
    if kind == RATE:
        _add(row, origin, k, n[k, i] / h0, first, values)
        _add(row, origin, k - 1, -n[k - 1, i] / h0, first, values)
        return origin
    h1 = time[k + 1] - time[k]
    if kind == JERK:
        origin = int(first[k - 2])
        for j in range(k - 2, k + 2):  # six times the third divided difference
            weight = 6.0
            for m in range(k - 2, k + 2):
                if m != j:
                    weight /= time[j] - time[m]
            _add(row, origin, j, n[j, i] * weight, first, values)
        return origin
    mid = 0.5 * (h0 + h1)
    _add(row, origin, k + 1, n[k + 1, i] / (h1 * mid), first, values)
    _add(row, origin, k, -n[k, i] * (1.0 / h1 + 1.0 / h0) / mid, first, values)
    _add(row, origin, k - 1, n[k - 1, i] / (h0 * mid), first, values)
    return origin


@kernel
def _shown(kind: int, k: int, count: int) -> bool:
    """Whether sample k of `count` shows a difference of that kind."""
    if kind == POSITION:
        return True
    if kind == RATE:
        return k >= 1
    return (1 if kind == ACCELERATION else 2) <= k <= count - 2


@kernel
def _largest(limits: Limits, kind: int, i: int) -> float:
    """Frame i's limit of that kind; 1 for a position."""
    if kind == RATE:
        return float(limits.rate[i])
    if kind == ACCELERATION:
        return float(limits.acceleration[i])
    return float(limits.jerk[i]) if kind == JERK else 1.0


@kernel
def limit_rows(at: Iterate, basis: Basis, limits: Limits, reach: Reach, out: Rows) -> int:
    """out <- the rows that may matter, divided by their limits. Returns how many; fills as many as `out` holds.

    A position's row is taken where `reach.trust` along the direction can come to the limit.
    """
    count = 0
    width = out.rows.shape[1]
    row = np.empty(width)
    total = at.time.shape[0]
    for k in range(total):
        for kind in range(reach.flags.shape[1]):
            flagged = reach.flags[k, kind] > 0
            if not flagged and k % reach.stride != 0:
                continue
            if not _shown(kind, k, total):
                continue
            for i in range(4):
                limit = _largest(limits, kind, i)
                if math.isinf(limit) or (kind == POSITION and math.isinf(limits.high[i])):
                    continue
                value = difference(kind, k, i, at.time, at.d)
                for side in (UPPER, LOWER):
                    sign = 1.0 if side == UPPER else -1.0
                    if kind == POSITION:
                        room = limits.high[i] - value if side == UPPER else value - limits.low[i]
                        if not flagged and room > reach.trust * abs(at.n[k, i]):
                            continue
                        scale = 1.0 / POSITION_UNIT
                        room *= scale
                    else:
                        share = sign * value / limit
                        if share < (NEARLY if flagged else reach.near):
                            continue
                        scale = 1.0 / limit
                        room = 1.0 - share
                    if count < out.origin.shape[0]:
                        out.origin[count] = fill_row(kind, k, i, at, basis, row)
                        for a in range(width):
                            out.rows[count, a] = sign * row[a] * scale
                        out.room[count] = room
                        out.bound[count, 0], out.bound[count, 1], out.bound[count, 2] = i, kind, side
                    count += 1
    return count
