"""The way from rest to the first sample of a plan, and from the last one to rest.

Each frame's rate goes from zero to the flight's along a curve with a plateau of acceleration in the middle and the
flight's acceleration at its end, so that angles, rates and accelerations are continuous. All frames take the same
time, the shortest for which the sampled lead, its joint with the flight included, keeps inside every limit.
"""

import math

import numpy as np
from numpy.typing import NDArray

from solver.planner.refine import MET, rig_limits, worst
from solver.rig import FRAMES, LIMITS, Rig

Array = NDArray[np.float64]
ROOM = 0.8  # of v^2 / a: the way that a lead needs between rest and rate v
LONGEST = 120.0  # [s]
EDGE = 0.25  # share of the lead in which the deceleration rises, and in which it falls
AT_REST = 1e-9  # of a limit: rates and accelerations below this need no lead


def lead_in(time: Array, angles: Array, rig: Rig) -> tuple[Array, str]:
    """(samples (m, 4) [rad] before the first at its interval, "") or (empty, why there is no room).

    time (k,), angles (k, 4): the first few samples of the flight.
    """
    samples, note = lead_out(-time[::-1], angles[::-1], rig)
    return samples[::-1].copy(), note.replace("brake to rest", "come from rest")


def lead_out(time: Array, angles: Array, rig: Rig) -> tuple[Array, str]:
    """(samples (m, 4) [rad] after the last at its interval, "") or (empty, why there is no room)."""
    none = np.empty((0, 4))
    if len(time) < 2:
        return none, ""
    t, x = time[-3:], angles[-3:]
    h = float(t[-1] - t[-2])
    rate = (x[-1] - x[-2]) / h
    bend = np.zeros(4)
    if len(t) == 3:
        bend = (rate - (x[-2] - x[-3]) / (t[-2] - t[-3])) / (0.5 * (t[-1] - t[-3]))
    rate = rate + 0.5 * h * bend  # at the last sample rather than half an interval before
    limits = rig_limits(rig)
    still = np.abs(x[-1] - x[-2]) / h <= AT_REST * np.minimum(rig.max_rate, 1.0)
    if still.all():
        return none, ""
    # No frame can do it faster than at its full deceleration.
    T = max(4.0 * h, float(np.max(np.abs(rate) / np.minimum(rig.max_acceleration, 1e6))))
    closed = (math.inf, 0, 0, 0)
    while T < LONGEST:
        m = max(3, math.ceil(T / h))
        s = np.arange(1, m + 1)[:, None] / m
        samples = x[-1] + _way(s, rate, bend, m * h)
        all_time = np.concatenate([t, t[-1] + h * np.arange(1, m + 3)])
        path = np.concatenate([x, samples, samples[-1:], samples[-1:]])
        over = worst(all_time, path, limits)
        if over[0] <= MET and not (over[3] == 0 and over[0] > 0.0):
            return samples, ""
        if over[0] < closed[0]:
            closed = over
        T = 1.04 * T + h
    _, _, frame, limit = closed
    return none, f"no room to brake to rest: the {FRAMES[frame]} frame's {LIMITS[limit]} limit closes the way"


def _way(s: Array, rate: Array, bend: Array, T: float) -> Array:
    """Angle gone (m, 4) at shares s (m, 1) of the time T, from rate (4,) and acceleration (4,) to rest.

    The rate falls as 1 - smooth(s), smooth rising with a plateau of slope over the middle; the flight's acceleration
    dies out as (1 - s)^3 s.
    """
    q = EDGE
    top = 1.0 / (1.0 - q)  # slope of the plateau
    u0 = np.clip(s / q, 0.0, 1.0)
    u1 = np.clip((s - 1.0 + q) / q, 0.0, 1.0)
    middle = np.clip(s - q, 0.0, 1.0 - 2.0 * q)
    late = np.maximum(s - 1.0 + q, 0.0)
    # The step's integral piece by piece: rising edge, plateau, and after it the plateau's end value and falling edge.
    step = top * (_edge(u0, q) + 0.5 * q * np.maximum(s - q, 0.0) + 0.5 * middle**2 + (1.0 - 2.0 * q) * late)
    step += top * (0.5 * (q * u1) ** 2 - _edge(u1, q))
    die = 0.5 * s**2 - s**3 + 0.75 * s**4 - 0.2 * s**5  # integral of s (1 - s)^3
    return rate * T * (s - step) + bend * T * T * die


def _edge(u: Array, q: float) -> Array:
    """Second integral, in units of the whole, of a slope that rises 0 to 1 as a cosine over the share q; u in 0..1."""
    return np.asarray(q * q * (0.25 * u * u - (1.0 - np.cos(np.pi * u)) / (2.0 * np.pi**2)))
