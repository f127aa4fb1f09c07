"""Verdicts and margins: what a plan says about a flight, and how much room it leaves."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solver.rig import Rig
from solver.solution import Blocking
from solver.verify import Violation, attitude_errors, differences, payload_attitudes, verify

Array = NDArray[np.float64]
CHUNK = 1 << 18  # samples looked at together, so that an hour needs no copies of itself


@dataclass(frozen=True)
class Verdict:
    """Whether the flight can be flown. `decided_by` names the stage that decided; `grid` [rad] it used."""

    feasible: bool
    blocking: Blocking | None
    decided_by: str  # "checked", "position", "rate", "acceleration"
    grid: float
    statement: str
    between: float  # largest entry of F - C half-way between samples


@dataclass(frozen=True)
class Margins:
    """The smallest distance to each limit, (4, 2) a kind: value and time [s]; inf and nan where there is no limit.

    Positions [rad], rates [rad/s], accelerations [rad/s^2]; negative outside. `singularity` is (value, time) of the
    smallest sin^2 d2 + cos^2 d3.
    """

    position: Array
    rate: Array
    acceleration: Array
    singularity: tuple[float, float]


def margins(time: Array, angles: Array, rig: Rig) -> Margins:
    """Margins of angles (n, 4) [rad] at time (n,) [s]."""
    n = len(time)
    tables = [np.tile([math.inf, math.nan], (4, 1)) for _ in range(3)]
    nearest = (math.inf, math.nan)
    for begin in range(0, n, CHUNK):
        part = slice(begin, min(n, begin + CHUNK + 2))
        t, x = time[part], angles[part]
        measure = np.sin(x[:, 1]) ** 2 + np.cos(x[:, 2]) ** 2
        k = int(np.argmin(measure))
        if rig.geometry.redundant and measure[k] < nearest[0]:
            nearest = (float(measure[k]), float(t[k]))
        room = [np.minimum(x - rig.position_min, rig.position_max - x)]
        if len(t) > 1:
            rate, acceleration = differences(t, x)
            room += [rig.max_rate - np.abs(rate), rig.max_acceleration - np.abs(acceleration)]
        for kind, values in enumerate(room):
            for i in rig.geometry.frames:
                if not values.shape[0] or not np.isfinite(values[0, i]):
                    continue
                k = int(np.argmin(values[:, i]))
                if values[k, i] < tables[kind][i, 0]:
                    tables[kind][i] = values[k, i], t[k + (1 if kind else 0)]
    for table in tables:
        table.setflags(write=False)
    return Margins(tables[0], tables[1], tables[2], nearest)


@dataclass(frozen=True)
class Check:
    """The independent check of a plan: errors (n,) at every sample, the worst between samples, limits exceeded."""

    error: Array  # (n,) [rad]
    matrix_error: Array  # (n,)
    between: float  # largest entry of F - C half-way between samples, both interpolated by cubics through four
    violations: tuple[Violation, ...]


def check(time: Array, attitude: Array, angles: Array, rig: Rig) -> Check:
    """Check a whole flight by `solver.verify`, which shares nothing with the planner; an hour in pieces."""
    n = len(time)
    error, matrix_error = np.empty(n), np.empty(n)
    violations: list[Violation] = []
    between = 0.0
    for begin in range(0, n, CHUNK):
        end = min(n, begin + CHUNK)
        F = payload_attitudes(rig, angles[begin:end])
        error[begin:end], matrix_error[begin:end] = attitude_errors(F, attitude[begin:end])
        wide = slice(max(0, begin - 1), min(n, end + 1))
        inner = verify(time[wide], angles[wide], rig).violations
        violations += [v for v in inner if time[begin] <= v.time <= time[end - 1]]
        at, C = angles[begin : end + 3], attitude[begin : end + 3]
        if len(at) > 3:
            gap = np.abs(payload_attitudes(rig, _halfway(at)) - _halfway(C))
            between = max(between, float(gap.max()))
    return Check(error, matrix_error, between, tuple(violations))


def _halfway(y: Array) -> Array:
    return np.asarray((9.0 * (y[1:-2] + y[2:-1]) - y[:-3] - y[3:]) / 16.0)
