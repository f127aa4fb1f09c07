"""The cost of a path, and the quadratic models of it that a step minimises (mathematics, section 8).

Rates and accelerations squared, each as a share of its limit, a rise near the singularity and a little distance from
home: that is what a refinement along the self-motion costs. Where all frames are free the attitude error squared comes
instead of the last two. Both are integrals over time, sampled every `stride` samples.
"""

import math
from typing import NamedTuple

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.bounds import ACCELERATION, POSITION, RATE
from fullpose.kinematics import (
    singularity_measure,
    singularity_measures,
)
from fullpose.rig import Rig
from fullpose.trajectory.bspline import Basis
from fullpose.trajectory.linearisation import ROW, Iterate, difference, fill_row
from fullpose.trajectory.options import PlanOptions
from fullpose.trajectory.shortest_path import reference_rates

TINY = 1e-9  # on the Hessian's diagonal: what nothing else determines stays where it is
FIVEFOLD = 5.0  # [1/s] an acceleration without a limit is measured against this times the frame's reference rate


class Cost(NamedTuple):
    """Weights of the cost; a frame that the rig has not weighs nothing."""

    rate: Array  # (4,) [s^2/rad^2] of the rates squared
    acceleration: Array  # (4,) [s^4/rad^2]
    home: Array  # (4,) [rad]
    homing: float  # [1/rad^2] of the distance from home squared; 0 where no frame has a range
    margin: float  # sin^2 d2 + cos^2 d3 below which the cost rises
    rise: float  # to this, at the singularity


class QuadraticModel(NamedTuple):
    """1/2 c'Hc + g'c of the coefficients c of a displacement."""

    H: Array  # upper bands
    g: Array


def cost_of(rig: Rig, options: PlanOptions) -> Cost:
    """The weights for a rig: rates and accelerations count as shares of their limits."""
    rates = reference_rates(rig)
    acceleration = np.where(np.isfinite(rig.max_acceleration), rig.max_acceleration, FIVEFOLD * rates)
    present = rig.axes >= 0
    return Cost(
        rate=np.where(present, rig.weight / rates**2, 0.0),
        acceleration=np.where(present, options.acceleration_cost * rig.weight / acceleration**2, 0.0),
        home=rig.home,
        homing=options.home_cost if np.isfinite(rig.position_max).any() else 0.0,
        margin=options.singularity_margin,
        rise=options.singularity_cost,
    )


def path_cost(time: Array, d: Array, cost: Cost, stride: int) -> float:
    """The cost of a whole path d (n, 4) [rad] at time (n,) [s], which `cost_bands` models."""
    h = np.diff(time)
    rate = np.diff(d, axis=0) / h[:, None]
    total = float(np.sum(rate**2 * cost.rate * h[:, None]))
    if len(time) > 2:
        mid = 0.5 * (h[1:] + h[:-1])
        total += float(np.sum((np.diff(rate, axis=0) / mid[:, None]) ** 2 * cost.acceleration * mid[:, None]))
    some = d[::stride]
    span = np.gradient(time[::stride]) if len(some) > 1 else np.ones(1)
    deficit = np.maximum(0.0, 1.0 - singularity_measures(some) / cost.margin)
    total += float(np.sum(cost.rise * deficit**2 * span))
    if cost.homing:
        total += float(np.sum(cost.homing * (some - cost.home) ** 2 * span[:, None]))
    return total


@kernel
def _interval(time: Array, k: int, stride: int) -> float:
    """The time [s] that sample k stands for where every `stride`-th is looked at."""
    return float(time[min(k + stride - stride // 2, time.shape[0] - 1)] - time[max(k - stride // 2, 0)])


@kernel
def cost_bands(at: Iterate, basis: Basis, stride: int, cost: Cost, model: QuadraticModel) -> None:
    """model <- the cost's. H (size, ROW) upper bands: H[j, b] of (j, j + b)."""
    time, d, n = at
    size, first, values = basis
    H, g = model
    row = np.empty(ROW)
    count = time.shape[0]
    for k in range(0, count, stride):
        dt = _interval(time, k, stride)
        if dt <= 0.0:
            dt = 1.0
        for kind in range(3):
            if (kind >= RATE and k < 1) or (kind == ACCELERATION and k > count - 2):
                continue
            for i in range(4):
                weight = cost.homing if kind == POSITION else cost.rate[i] if kind == RATE else cost.acceleration[i]
                if weight == 0.0:
                    continue
                origin = fill_row(kind, k, i, at, basis, row)
                value = difference(kind, k, i, time, d)
                if kind == POSITION:
                    value -= cost.home[i]
                for a in range(ROW):
                    if row[a] == 0.0:
                        continue
                    g[origin + a] += 2.0 * weight * dt * value * row[a]
                    for b in range(a, ROW):
                        H[origin + a, b - a] += 2.0 * weight * dt * row[a] * row[b]
        deficit = 1.0 - singularity_measure(d[k]) / cost.margin
        if deficit > 0.0:
            slope = 2.0 * math.sin(d[k, 1]) * math.cos(d[k, 1]) * n[k, 1]
            slope -= 2.0 * math.cos(d[k, 2]) * math.sin(d[k, 2]) * n[k, 2]
            down = -2.0 * cost.rise * deficit / cost.margin
            bend = 2.0 * cost.rise / (cost.margin * cost.margin)
            for a in range(values.shape[1]):
                va = values[k, a] * slope
                g[first[k] + a] += dt * down * va
                for b in range(a, values.shape[1]):
                    H[first[k] + a, b - a] += dt * bend * va * values[k, b] * slope
    for j in range(size):
        H[j, 0] += TINY
