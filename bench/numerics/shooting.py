"""A slow reference for the least tolerance, of another kind: single shooting from many random starts.

Unknowns are each frame's first angle, first rate and its acceleration at every sample, in the box of the acceleration
limit; the samples follow by their own differences. What is minimised is a power mean of 1 - cos(error), the power
raised step by step, with squared penalties on ranges and rates raised too, by L-BFGS-B (SciPy; Byrd, Lu, Nocedal
and Zhu 1995). Nothing is shared with the planner: no spline, no quadratic programme, no linearised attitude, own
kinematics. It may exceed a range or rate by `BEYOND`, so it has a hair more than the rig.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np
from scipy.optimize import minimize

from bench.numerics.infeasible_flights import Case
from fullpose._typing import Array, Integers
from fullpose.charts import base_chart, inner_chart
from fullpose.rig import Rig
from fullpose.verify import attitude_errors, payload_attitudes

POWERS = (1.0, 3.0, 8.0, 20.0, 50.0, 150.0)
PENALTIES = (3.0, 10.0, 30.0, 100.0, 300.0, 300.0)
ITERATIONS = (60, 60, 100, 150, 300, 800)
ROUNDS = ((2, 6), (4, 3), (6, 0))  # stages until, and how many of the starts go on from there
BEYOND = 2e-3  # of a rate limit, or [rad], that counts as kept
FREE = 1e3  # in place of a limit that is none


class Shot(NamedTuple):
    """What is shot at, and how."""

    h: float  # [s]
    axes: Integers
    attitude: Array  # (n, 3, 3)
    low: Array  # (4,) [rad]
    high: Array
    rate: Array  # (4,) [rad/s]
    acceleration: Array  # (4,) [rad/s^2]
    power: float
    penalty: float


@numba.njit(cache=True)
def integrated(shot, y, x, v):
    """x, v (n, 4) <- the samples and rates of unknowns y (n, 4)."""
    for i in range(4):
        x[0, i] = y[0, i]
        v[0, i] = 0.0
        for k in range(1, x.shape[0]):
            v[k, i] = y[1, i] * shot.rate[i] if k == 1 else v[k - 1, i] + shot.h * shot.acceleration[i] * y[k, i]
            x[k, i] = x[k - 1, i] + shot.h * v[k, i]


@numba.njit(cache=True)
def turned(axis, c, s, M, out):
    """out <- the passive turn about an axis of M (3, 3)."""
    out[:] = M
    if axis >= 0:
        a = (axis + 1) % 3
        b = (axis + 2) % 3
        for q in range(3):
            out[a, q] = c * M[a, q] + s * M[b, q]
            out[b, q] = c * M[b, q] - s * M[a, q]


@numba.njit(cache=True)
def chords(shot, x, chord, slope):
    """chord (n,) <- 1 - cos(error) of x (n, 4), slope (n, 4) <- its derivatives."""
    P = np.empty((5, 3, 3))
    D = np.empty((3, 3))
    E = np.empty((3, 3))
    for k in range(x.shape[0]):
        P[0] = np.eye(3)
        for i in range(4):
            turned(shot.axes[i], math.cos(x[k, i]), math.sin(x[k, i]), P[i], P[i + 1])
        chord[k] = max(0.5 * (3.0 - (P[4] * shot.attitude[k]).sum()), 0.0)
        for i in range(4):
            slope[k, i] = 0.0
            axis = shot.axes[i]
            if axis < 0:
                continue
            # The derivative of a turn is the turn, a right angle on, without the axis; then what is inside of it.
            D[axis] = 0.0
            D[(axis + 1) % 3] = P[i + 1, (axis + 2) % 3]
            D[(axis + 2) % 3] = -P[i + 1, (axis + 1) % 3]
            for j in range(i + 1, 4):
                turned(shot.axes[j], math.cos(x[k, j]), math.sin(x[k, j]), D, E)
                D[:] = E
            slope[k, i] = -0.5 * (D * shot.attitude[k]).sum()


@numba.njit(cache=True)
def objective(shot, y, gradient, gaps):
    """The root of the power mean of 1 - cos(error) and the penalties; gradient (n, 4) by y, gaps (2,): what is over."""
    n = y.shape[0]
    x = np.empty((n, 4))
    v = np.empty((n, 4))
    gx = np.zeros((n, 4))
    gv = np.zeros((n, 4))
    chord = np.empty(n)
    slope = np.empty((n, 4))
    integrated(shot, y, x, v)
    chords(shot, x, chord, slope)
    most = chord.max() + 1e-15
    mean = ((chord / most) ** shot.power).mean()
    norm = most * mean ** (1.0 / shot.power)
    total = math.sqrt(norm + 1e-12)  # about the error by sqrt(2): the penalties are measured against angles
    for k in range(n):
        gx[k] = norm / mean / n * (chord[k] / most) ** (shot.power - 1.0) / most * 0.5 / total * slope[k]
    gaps[:] = 0.0
    for k in range(n):
        for i in range(4):
            out = max(x[k, i] - shot.high[i], shot.low[i] - x[k, i])
            if out > 0.0:
                gaps[0] = max(gaps[0], out)
                total += shot.penalty * out * out
                gx[k, i] += 2.0 * shot.penalty * out * (1.0 if x[k, i] > shot.high[i] else -1.0)
            out = abs(v[k, i]) / shot.rate[i] - 1.0
            if out > 0.0:
                gaps[1] = max(gaps[1], out)
                total += shot.penalty * out * out
                gv[k, i] += 2.0 * shot.penalty * out / shot.rate[i] * (1.0 if v[k, i] > 0.0 else -1.0)
    for i in range(4):
        back_x = 0.0
        back_v = 0.0
        for k in range(n - 1, 0, -1):
            back_x += gx[k, i]
            back_v += gv[k, i] + shot.h * back_x
            gradient[k, i] = back_v * (shot.rate[i] if k == 1 else shot.h * shot.acceleration[i])
        gradient[0, i] = back_x + gx[0, i]
    return total


@dataclass(frozen=True)
class Reference:
    """The least tolerance [rad] of all starts that keep the limits, and how many do."""

    tolerance: float
    kept: int


def reference(case: Case, restarts: int, seed: int = 0) -> Reference:
    """The least tolerance by shooting from random starts."""
    random = np.random.default_rng(seed)
    pool = [(0.0, number, pursuit(case, start_path(case, random, number))) for number in range(restarts)]
    best, kept, begin = math.inf, 0, 0
    for end, going_on in ROUNDS:
        carried = []
        for _, number, unknowns in pool:
            y, cost, gaps = unknowns, 0.0, np.zeros(2)
            for stage in range(begin, end):
                y, cost, gaps = descended(case, y, stage)
            carried.append((cost, number, y))
            if end == len(POWERS) and gaps.max() <= BEYOND:
                kept += 1
                best = min(best, largest_error(case, y))
        pool = sorted(carried, key=lambda each: each[:2])[:going_on]
        begin = end
    return Reference(best, kept)


def limits(rig: Rig) -> tuple[Array, Array, Array, Array]:
    """Low, high, rate, acceleration (4,), all finite; a frame that the rig has not stays where it is."""
    low, high = np.maximum(rig.position_min, -FREE), np.minimum(rig.position_max, FREE)
    rate, acceleration = np.minimum(rig.max_rate, 50.0), np.minimum(rig.max_acceleration, 1e3)
    return low, high, rate, acceleration


def descended(case: Case, y: Array, stage: int) -> tuple[Array, float, Array]:
    """(unknowns, objective, gaps) after L-BFGS-B at one power and penalty."""
    rig, n = case.rig, len(case.time)
    low, high, rate, acceleration = limits(rig)
    h = float(case.time[1] - case.time[0])
    shot_at = Shot(
        h, rig.axes, case.attitude, low, high, rate, acceleration, POWERS[stage], PENALTIES[stage]
    )  # fmt: skip
    gradient, gaps = np.zeros((n, 4)), np.zeros(2)
    bounds = np.tile([-1.0, 1.0], (n, 4, 1))
    bounds[0] = [-np.inf, np.inf]
    if case.start is not None:
        bounds[0] = case.start[:, None]
    if case.start_rate is not None:
        bounds[1] = (case.start_rate / rate)[:, None]

    def call(flat: Array) -> tuple[float, Array]:
        return objective(shot_at, flat.reshape(n, 4), gradient, gaps), gradient.ravel().copy()

    options = {"maxiter": ITERATIONS[stage], "maxcor": 20}
    flat = np.clip(y, bounds[..., 0], bounds[..., 1]).ravel()
    found = minimize(call, flat, jac=True, method="L-BFGS-B", bounds=bounds.reshape(-1, 2), options=options)
    value, _ = call(found.x)
    return found.x.reshape(n, 4), float(value), gaps.copy()


def largest_error(case: Case, y: Array) -> float:
    """[rad] of the path of unknowns (n, 4)."""
    return float(attitude_errors(payload_attitudes(case.rig, path_of(case, y)), case.attitude)[0].max())


def path_of(case: Case, y: Array) -> Array:
    """(n, 4) [rad]"""
    _, _, rate, acceleration = limits(case.rig)
    h = float(case.time[1] - case.time[0])
    v = np.cumsum(np.vstack([y[1] * rate, h * acceleration * y[2:]]), axis=0)
    return np.vstack([y[:1], y[0] + h * np.cumsum(v, axis=0)])


def start_path(case: Case, random: np.random.Generator, number: int) -> Array:
    """A random path (n, 4) [rad]: exact, at a random smooth angle of a chart, or anything smooth."""
    rig, t = case.rig, case.time
    s = (t - t[0]) / (t[-1] - t[0])

    def smooth() -> Array:
        waves = sum(random.normal() * 0.7 * np.sin(np.pi * f * s + random.uniform(0.0, 6.3)) for f in (1, 2, 3))
        return np.asarray(random.uniform(-np.pi, np.pi) + random.normal() * 1.5 * s + waves)

    path = np.stack([smooth() for _ in range(4)], axis=1)
    if rig.geometry.redundant and number % 4:
        chart, branch = (base_chart, inner_chart)[number % 2], float(random.choice((-1.0, 1.0)))
        angle = smooth()
        for k in range(len(t)):
            chart(rig.geometry.horizontal, case.attitude[k], angle[k], branch, path[k])
        path = np.unwrap(path, axis=0)
    path[:, rig.axes < 0] = 0.0
    finite = np.isfinite(rig.position_min)
    middle = np.zeros(4)
    middle[finite] = 0.5 * (rig.position_min[finite] + rig.position_max[finite])
    return np.asarray(path - 2.0 * np.pi * np.rint((path.mean(axis=0) - middle) / (2.0 * np.pi)))


def pursuit(case: Case, path: Array) -> Array:
    """Unknowns (n, 4) whose path stays near `path` (n, 4) [rad] inside the limits: a damped pursuit."""
    low, high, rate, acceleration = limits(case.rig)
    h = float(case.time[1] - case.time[0])
    y = np.zeros_like(path)
    y[0] = np.clip(path[0], low, high) if case.start is None else case.start
    v = np.clip((path[1] - path[0]) / h, -rate, rate) if case.start_rate is None else case.start_rate
    y[1] = v / rate
    x = y[0] + h * v
    for k in range(2, len(path)):
        wanted = (path[k] - path[k - 1]) / h + 5.0 * (np.clip(path[k - 1], low, high) - x)
        y[k] = np.clip((np.clip(wanted, -rate, rate) - v) / (h * acceleration), -1.0, 1.0)
        v = v + h * acceleration * y[k]
        x = x + h * v
    return y
