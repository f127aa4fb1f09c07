"""Leads: the way from rest to the first sample of a path that begins in motion, and from its last sample to rest.

Each frame's rate goes to zero along a curve with a plateau of acceleration in the middle, reached and left as a cosine,
and the path's own acceleration dies out beside it, so that angles, rates and accelerations are continuous. Each frame
takes the shortest time, but a tenth of a second where there is room for it, for which its sampled lead, the joint with
the path included, keeps inside its limits, that of jerk among them; where its stop is too near, the acceleration rises
and falls more quickly, which needs little more than the braking distance. A frame that needs less time than the others
rests first. One without an acceleration limit that has no room for any of that stops at once. A lead-in is a lead-out
in reversed time.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.bounds import ACCELERATION, JERK, MET, POSITION, RATE
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose.verify import jerks

GENTLE, LONGEST = 0.1, 120.0  # [s]
LONGER = 1.04  # times the time tried before
EDGES = (0.25, 0.1, 0.03)  # shares of the lead in which the acceleration rises, and in which it falls; tried in turn
PEAK = 1.1  # times the rate over the time: the least acceleration of a lead, or what its plateau asks for if less
AT_REST = 1e-9  # of a limit: rates and accelerations below this need no lead


@dataclass(frozen=True)
class Lead:
    """Samples (m, 4) [rad] at the interval of the path's end, without that end; none, and why, where there is no room.

    None for a path that is at rest there, either.
    """

    angles: Array
    refusal: str = ""


NONE = np.empty((0, 4))


def lead_in(time: Array, angles: Array, rig: Rig) -> Lead:
    """The way from rest to the first sample. time (k,) [s], angles (k, 4) [rad]: the first few samples of the path."""
    lead = lead_out(-time[::-1], angles[::-1], rig)
    return Lead(lead.angles[::-1].copy(), lead.refusal.replace("brake to rest", "come from rest"))


def lead_out(time: Array, angles: Array, rig: Rig) -> Lead:
    """The way from the last sample to rest. time (k,) [s], angles (k, 4) [rad]: the last few samples of the path."""
    if len(time) < 2:
        return Lead(NONE)
    t, x = time[-3:], angles[-3:]
    h = float(t[-1] - t[-2])
    rate = (x[-1] - x[-2]) / h
    bend = np.zeros(4)
    if len(t) == 3:
        bend = (rate - (x[-2] - x[-3]) / (t[-2] - t[-3])) / (0.5 * (t[-1] - t[-3]))
    rate = rate + 0.5 * h * bend  # at the last sample rather than half an interval before
    leads: list[Array] = []
    for i in range(4):
        if abs(x[-1, i] - x[-2, i]) / h <= AT_REST * min(float(rig.max_rate[i]), 1.0) and abs(bend[i]) * h <= AT_REST:
            leads.append(np.empty(0))
            continue
        end = _End(t, x[:, i], float(rate[i]), float(bend[i]), h)
        lead, limit = _frame_lead(end, rig, i)
        if limit is not None:
            return Lead(NONE, f"no room to brake to rest: the {FRAMES[i]} frame's {LIMITS[limit]} limit closes the way")
        leads.append(lead)
    samples = np.repeat(x[-1:], max(len(lead) for lead in leads), axis=0)
    for i, lead in enumerate(leads):
        samples[: len(lead), i] = lead
        samples[len(lead) :, i] = lead[-1] if lead.size else x[-1, i]
    return Lead(samples)


@dataclass(frozen=True)
class _End:
    """One frame at the end of a path: its last angles x (k,) [rad] at t (k,) [s], and its motion at the last of them.

    rate [rad/s], bend [rad/s^2]; h [s] is the interval of the lead's samples.
    """

    t: Array
    x: Array
    rate: float
    bend: float
    h: float


def _frame_lead(end: _End, rig: Rig, frame: int) -> tuple[Array, int | None]:
    """(angles (m,) [rad] of one frame on its way to rest, None) or (empty, the limit that closes the way)."""
    closed: int | None = POSITION
    for edge in EDGES:
        if closed != POSITION:  # what a quicker rise does not help
            break
        lead, closed = _shortest(end, rig, frame, edge)
        if closed is None:
            return lead, None
    if _outside(end, np.r_[end.x, end.x[-1], end.x[-1]], 2, rig, frame) is None:  # at once: no acceleration limit
        return np.empty(0), None
    return np.empty(0), closed


def _shortest(end: _End, rig: Rig, frame: int, edge: float) -> tuple[Array, int | None]:
    """`_frame_lead` with one share of the lead in which the acceleration rises."""
    h = end.h
    peak = min(PEAK, 1.0 / (1.0 - edge))
    shortest = max(4.0 * h, peak * abs(end.rate) / min(float(rig.max_acceleration[frame]), 1e6))
    closed = RATE
    for T in (max(shortest, GENTLE), shortest):  # hurried only where there is no room for better
        closed = RATE
        while T < LONGEST:
            m = max(4, math.ceil(T / h))
            lead = end.x[-1] + braking(np.arange(1, m + 1) / m, end.rate, end.bend, m * h, edge)
            limit = _outside(end, np.r_[end.x, lead, lead[-1], lead[-1]], m + 2, rig, frame)
            if limit is None:
                return lead, None
            closed = limit
            if limit == POSITION:
                break  # longer is farther
            T = LONGER * T + h
    return np.empty(0), closed


def _outside(end: _End, path: Array, added: int, rig: Rig, frame: int) -> int | None:
    """The limit of the frame that the path, `added` samples after those of the end, is outside of, or None."""
    t, h = end.t, end.h
    v = np.diff(path) / np.r_[np.diff(t), np.full(added, h)]
    a = np.diff(v) / np.r_[0.5 * (t[2:] - t[:-2]), np.full(added, h)]
    if np.abs(a).max() > rig.max_acceleration[frame] * (1.0 + MET):
        return ACCELERATION
    if np.isfinite(rig.max_jerk[frame]):
        times = np.r_[t, t[-1] + h * np.arange(1, added + 1)]
        if np.abs(jerks(times, a[:, None])).max() > rig.max_jerk[frame] * (1.0 + MET):
            return JERK
    if np.abs(v).max() > rig.max_rate[frame] * (1.0 + MET):
        return RATE
    if path.max() > rig.position_max[frame] or path.min() < rig.position_min[frame]:
        return POSITION
    return None


def braking(s: Array, rate: float, bend: float, T: float, edge: float) -> Array:
    """Angle gone (m,) [rad] at shares s (m,) of the time T, from rate [rad/s] and acceleration [rad/s^2] to rest.

    The rate falls as 1 - smooth(s), smooth rising with a plateau of slope over the middle, between two edges of the
    share `edge`; the path's acceleration dies out as (1 - s)^3 s.
    """
    q = edge
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
