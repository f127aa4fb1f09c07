"""Kernels of the refinement: limits of a sampled path, and the rows of its quadratic programme.

The path is x_k = d_k + n_k z_k with z in a `Basis`. Rates and accelerations are the differences at the sample rate that
the verdict takes: v_k = (x_k - x_{k-1}) / h_k, a_k = (v_{k+1} - v_k) / ((h_k + h_{k+1}) / 2). Rows are divided by the
limit.
"""

import math

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array, Flags, Integers
from fullpose.kinematics import jacobian, payload_attitude, rotation_error
from fullpose.trajectory.bspline import WIDTH

ROW = WIDTH + 2  # functions that one row of differences can touch
POSITION, RATE, ACCELERATION = range(3)
POSITION_UNIT = 0.02  # [rad] counts as much as the whole of a rate limit


@kernel
def difference(kind: int, k: int, i: int, time: Array, d: Array) -> float:
    """Position, rate or acceleration of frame i at sample k; time (n,) [s], d (n, 4) [rad]. Ends: nan."""
    if kind == 0:
        return float(d[k, i])
    if k < 1:
        return np.nan
    past = (d[k, i] - d[k - 1, i]) / (time[k] - time[k - 1])
    if kind == 1:
        return float(past)
    if k > time.shape[0] - 2:
        return np.nan
    ahead = (d[k + 1, i] - d[k, i]) / (time[k + 1] - time[k])
    return float((ahead - past) / (0.5 * (time[k + 1] - time[k - 1])))


@kernel
def over_limits(
    time: Array,
    d: Array,
    low: Array,
    high: Array,
    rate: Array,
    acceleration: Array,
    over: Array,
    frame: NDArray[np.int8],
) -> None:
    """over (n, 3) <- how far outside a limit each sample is (position, rate, acceleration), <= 0 inside; and whose.

    Rates and accelerations as shares of the limit, positions in `POSITION_UNIT`. frame (n, 3).
    """
    n = time.shape[0]
    for k in range(n):
        for kind in range(3):
            over[k, kind] = -np.inf
            frame[k, kind] = -1
        for i in range(4):
            gap = max(d[k, i] - high[i], low[i] - d[k, i]) / POSITION_UNIT
            if gap > over[k, 0]:
                over[k, 0] = gap
                frame[k, 0] = i
            if k >= 1 and rate[i] < np.inf:
                gap = abs(difference(1, k, i, time, d)) / rate[i] - 1.0
                if gap > over[k, 1]:
                    over[k, 1] = gap
                    frame[k, 1] = i
            if k >= 1 and k < n - 1 and acceleration[i] < np.inf:
                gap = abs(difference(2, k, i, time, d)) / acceleration[i] - 1.0
                if gap > over[k, 2]:
                    over[k, 2] = gap
                    frame[k, 2] = i


@kernel
def displaced(d: Array, n: Array, first: Integers, values: Array, c: Array, out: Array) -> None:
    """out <- d + n z, z the spline of coefficients c. d, n, out (k, 4)."""
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
def fill_row(kind: int, k: int, i: int, time: Array, n: Array, first: Integers, values: Array, row: Array) -> int:
    """row (ROW,) <- derivative of `difference` by the coefficients; returns the first one's index."""
    row[:] = 0.0
    if kind == 0:
        _add(row, first[k], k, n[k, i], first, values)
        return int(first[k])
    origin = int(first[k - 1])
    h0 = time[k] - time[k - 1]
    if kind == 1:
        _add(row, origin, k, n[k, i] / h0, first, values)
        _add(row, origin, k - 1, -n[k - 1, i] / h0, first, values)
        return origin
    h1 = time[k + 1] - time[k]
    mid = 0.5 * (h0 + h1)
    _add(row, origin, k + 1, n[k + 1, i] / (h1 * mid), first, values)
    _add(row, origin, k, -n[k, i] * (1.0 / h1 + 1.0 / h0) / mid, first, values)
    _add(row, origin, k - 1, n[k - 1, i] / (h0 * mid), first, values)
    return origin


@kernel
def cost_bands(
    time: Array, d: Array, n: Array, first: Integers, values: Array, stride: int, rate_weight: Array,
    acceleration_weight: Array,
    home: Array, home_cost: float, margin: float, rise: float, H: Array, g: Array,
) -> None:  # fmt: skip
    """H, g <- the quadratic model of the cost: 1/2 c'Hc + g'c. H (size, ROW) upper bands: H[j, b] of (j, j + b)."""
    row = np.empty(ROW)
    count = time.shape[0]
    size = g.shape[0]
    for k in range(0, count, stride):
        lo = max(k - stride // 2, 0)
        hi = min(k + stride - stride // 2, count - 1)
        dt = time[hi] - time[lo]
        if dt <= 0.0:
            dt = 1.0
        for kind in range(3):
            if kind >= 1 and k < 1:
                continue
            if kind == 2 and k > count - 2:
                continue
            for i in range(4):
                weight = home_cost if kind == 0 else rate_weight[i] if kind == 1 else acceleration_weight[i]
                if weight == 0.0:
                    continue
                origin = fill_row(kind, k, i, time, n, first, values, row)
                value = difference(kind, k, i, time, d)
                if kind == 0:
                    value -= home[i]
                for a in range(ROW):
                    if row[a] == 0.0:
                        continue
                    g[origin + a] += 2.0 * weight * dt * value * row[a]
                    for b in range(a, ROW):
                        H[origin + a, b - a] += 2.0 * weight * dt * row[a] * row[b]
        s2 = math.sin(d[k, 1])
        c3 = math.cos(d[k, 2])
        short = 1.0 - (s2 * s2 + c3 * c3) / margin
        if short > 0.0:
            slope = 2.0 * s2 * math.cos(d[k, 1]) * n[k, 1] - 2.0 * c3 * math.sin(d[k, 2]) * n[k, 2]
            down = -2.0 * rise * short / margin
            bend = 2.0 * rise / (margin * margin)
            for a in range(values.shape[1]):
                va = values[k, a] * slope
                g[first[k] + a] += dt * down * va
                for b in range(a, values.shape[1]):
                    H[first[k] + a, b - a] += dt * bend * va * values[k, b] * slope
    for j in range(size):
        H[j, 0] += 1e-9


@kernel
def limit_rows(
    time: Array, d: Array, n: Array, first: Integers, values: Array, stride: int, flags: Flags, trust: float,
    low: Array, high: Array,
    rate: Array, acceleration: Array, near: float, origin: Integers, rows: Array, bound: Array, tag: Integers,
) -> int:  # fmt: skip
    """The rows that may matter: row c <= bound. Returns how many; fills as many as the outputs hold.

    A row is taken at every `stride`-th sample where its value is above `near` of the limit (positions: where `trust`
    along the self-motion can reach the limit), and at every sample that `flags` (n, 3) marks.
    origin (r,), rows (r, ROW),
    bound (r,), tag (r,) = 12 sample + 3 frame + kind.
    """
    count = 0
    row = np.empty(ROW)
    total = time.shape[0]
    for k in range(total):
        for kind in range(3):
            flagged = flags[k, kind] > 0
            if not flagged and k % stride != 0:
                continue
            if kind >= 1 and k < 1:
                continue
            if kind == 2 and k > total - 2:
                continue
            for i in range(4):
                limit = rate[i] if kind == 1 else acceleration[i] if kind == 2 else 1.0
                if kind == 0 and math.isinf(high[i]):
                    continue
                if math.isinf(limit):
                    continue
                value = difference(kind, k, i, time, d)
                for sign in range(2):
                    if kind == 0:
                        room = high[i] - value if sign == 0 else value - low[i]
                        if not flagged and room > trust * abs(n[k, i]):
                            continue
                        scale = 1.0 / POSITION_UNIT
                        room *= scale
                    else:
                        share = value / limit if sign == 0 else -value / limit
                        if share < (0.3 if flagged else near):
                            continue
                        scale = 1.0 / limit
                        room = 1.0 - share
                    if count < origin.shape[0]:
                        origin[count] = fill_row(kind, k, i, time, n, first, values, row)
                        for a in range(ROW):
                            rows[count, a] = row[a] * scale if sign == 0 else -row[a] * scale
                        bound[count] = room
                        tag[count] = 12 * k + 3 * i + kind
                    count += 1
    return count


@kernel
def error_bands(
    axes: Integers, time: Array, attitude: Array, d: Array, first: Integers, values: Array, stride: int, weight: float,
    rate_weight: Array, acceleration_weight: Array, H: Array, g: Array,
) -> float:  # fmt: skip
    """H, g <- the Gauss-Newton model of the attitude error squared, all four frames free; returns that error.

    The integral of weight |e|^2 plus the rates' and accelerations' squares. Unknown 4 j + i is coefficient j of frame
    i; H (4 size, 4 ROW) upper bands.
    """
    F = np.empty((3, 3))
    J = np.empty((3, 4))
    e = np.empty(3)
    ones = np.ones((time.shape[0], 4))
    row = np.empty(ROW)
    count = time.shape[0]
    total = 0.0
    for k in range(0, count, stride):
        lo = max(k - stride // 2, 0)
        hi = min(k + stride - stride // 2, count - 1)
        dt = max(time[hi] - time[lo], 1e-9)
        payload_attitude(axes, d[k], F)
        size = rotation_error(F, attitude[k], e)
        total += weight * dt * size * size
        jacobian(axes, d[k], J)
        for i in range(4):
            if axes[i] < 0:
                continue
            push = J[0, i] * e[0] + J[1, i] * e[1] + J[2, i] * e[2]
            for a in range(values.shape[1]):
                u = 4 * (first[k] + a) + i
                if values[k, a] == 0.0:
                    continue
                g[u] += 2.0 * weight * dt * push * values[k, a]
                for j in range(4):
                    dot = J[0, i] * J[0, j] + J[1, i] * J[1, j] + J[2, i] * J[2, j]
                    for b in range(values.shape[1]):
                        v = 4 * (first[k] + b) + j
                        if v >= u:
                            H[u, v - u] += 2.0 * weight * dt * dot * values[k, a] * values[k, b]
            for kind in range(1, 3):
                if k < 1 or (kind == 2 and k > count - 2):
                    continue
                share = rate_weight[i] if kind == 1 else acceleration_weight[i]
                origin = fill_row(kind, k, i, time, ones, first, values, row)
                value = difference(kind, k, i, time, d)
                for a in range(ROW):
                    if row[a] == 0.0:
                        continue
                    u = 4 * (origin + a) + i
                    g[u] += 2.0 * share * dt * value * row[a]
                    for b in range(a, ROW):
                        if row[b] != 0.0:
                            H[u, 4 * (b - a)] += 2.0 * share * dt * row[a] * row[b]
    for u in range(g.shape[0]):
        H[u, 0] += 1e-9
    return total
