"""The way from rest to the first sample of a plan, and from the last one to rest.

Each frame's rate goes from zero to the flight's along a curve with a plateau of acceleration in the middle and the
flight's acceleration at its end, so that angles, rates and accelerations are continuous. Each frame takes the
shortest time, but a tenth of a second where there is room for it, for which its sampled lead, the joint with the flight
included, keeps inside its limits. A frame without an acceleration limit that has no room for that stops at once.
"""

import math

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose.trajectory.sqp import MET

GENTLE, LONGEST = 0.1, 120.0  # [s]
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
    ways: list[Array] = []
    for i in range(4):
        if abs(x[-1, i] - x[-2, i]) / h <= AT_REST * min(float(rig.max_rate[i]), 1.0) and abs(bend[i]) * h <= AT_REST:
            ways.append(np.empty(0))
            continue
        way, limit = _frame_way(t, x[:, i], float(rate[i]), float(bend[i]), h, rig, i)
        if limit is not None:
            return none, f"no room to brake to rest: the {FRAMES[i]} frame's {LIMITS[limit]} limit closes the way"
        ways.append(way)
    samples = np.repeat(x[-1:], max(len(way) for way in ways), axis=0)
    for i, way in enumerate(ways):
        samples[: len(way), i] = way
        samples[len(way) :, i] = way[-1] if way.size else x[-1, i]
    return samples, ""


def _frame_way(
    t: Array, x: Array, rate: float, bend: float, h: float, rig: Rig, frame: int
) -> tuple[Array, int | None]:
    """(angles (m,) [rad] of one frame on its way to rest, None) or (empty, the limit that closes the way)."""
    shortest = max(4.0 * h, 1.1 * abs(rate) / min(float(rig.max_acceleration[frame]), 1e6))
    for T in (max(shortest, GENTLE), shortest):  # hurried only where there is no room for better
        closed = 1
        while T < LONGEST:
            m = max(4, math.ceil(T / h))
            way = x[-1] + _way(np.arange(1, m + 1) / m, rate, bend, m * h)
            limit = _outside(t, np.r_[x, way, way[-1], way[-1]], m + 2, h, rig, frame)
            if limit is None:
                return way, None
            closed = limit
            if limit == 0:
                break  # longer is farther
            T = 1.04 * T + h
    if _outside(t, np.r_[x, x[-1], x[-1]], 2, h, rig, frame) is None:  # at once: it has no acceleration limit
        return np.empty(0), None
    return np.empty(0), closed


def _outside(t: Array, path: Array, added: int, h: float, rig: Rig, frame: int) -> int | None:
    """The limit of the frame that the path, `added` samples of interval h after those at t, is outside of, or None."""
    v = np.diff(path) / np.r_[np.diff(t), np.full(added, h)]
    a = np.diff(v) / np.r_[0.5 * (t[2:] - t[:-2]), np.full(added, h)]
    if np.abs(a).max() > rig.max_acceleration[frame] * (1.0 + MET):
        return 2
    if np.abs(v).max() > rig.max_rate[frame] * (1.0 + MET):
        return 1
    if path.max() > rig.position_max[frame] or path.min() < rig.position_min[frame]:
        return 0
    return None


def _way(s: Array, rate: float, bend: float, T: float) -> Array:
    """Angle gone (m,) [rad] at shares s (m,) of the time T, from rate [rad/s] and acceleration [rad/s^2] to rest.

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
