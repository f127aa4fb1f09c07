"""Flights that are flyable by construction: frame paths of a few random sines, and the rigs they are made for.

Scaled until every rate and acceleration is at most a share of its limit and every range holds them; the flight is where
they point the payload. Oracles for a planner: it is told the flight alone, and a path is known to exist.
"""

import numpy as np
from numpy.typing import NDArray

from fullpose.rig import FrameLimits, Geometry, Rig

DEG = np.pi / 180.0
# min, max, rate, acceleration [deg, deg/s, deg/s^2] of base, outer, middle, inner
Frames = tuple[tuple[float, float, float, float], ...]
INF = np.inf
RIGS: dict[str, Frames] = {
    "narrow": ((-300, 300, 200, 250), (-170, 170, 250, 400), (-120, 120, 300, 600), (-60, 60, 600, 2000)),
    "multi": ((-720, 720, 200, 500), (-400, 400, 200, 500), (-185, 185, 200, 500), (-10, 350, 200, 500)),
    "free": ((-INF, INF, 200, 500), (-INF, INF, 250, 800), (-INF, INF, 300, 1200), (-INF, INF, 600, 4000)),
    "tight": ((-40, 40, 60, 100), (-50, 50, 60, 100), (-50, 50, 60, 100), (-45, 45, 60, 100)),
    "sluggish": ((-INF, INF, 200, 3), (-INF, INF, 250, 800), (-INF, INF, 300, 1200), (-60, 60, 600, 4000)),
}


def rig_of(name: str, geometry: Geometry) -> Rig:
    """One of `RIGS`."""
    frames = [FrameLimits(a * DEG, b * DEG, v * DEG, c * DEG) for a, b, v, c in RIGS[name]]
    return Rig(name, geometry, (frames[0], frames[1], frames[2], frames[3]))


def flyable_path(
    seed: int, rig: Rig, share: float, duration: float, hz: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(time (n,) [s], angles (n, 4) [rad]) with rates and accelerations at most `share` of their limits."""
    random = np.random.default_rng(seed)
    t = np.arange(round(duration * hz) + 1) / hz
    x = np.zeros((len(t), 4))
    for i, frame in enumerate(rig.frames):
        waves = [
            random.normal() * np.sin(2 * np.pi * random.uniform(0.05, 0.5) * t + random.uniform(0, 6.28))
            for _ in range(4)
        ]
        y = np.sum(waves, axis=0)
        v = np.gradient(y, t)
        a = np.gradient(v, t)
        scale = min(
            share * min(frame.max_rate, 20.0) / np.abs(v).max(),
            share * min(frame.max_acceleration, 1e3) / np.abs(a).max(),
        )
        if np.isfinite(frame.max):
            y *= min(scale, (frame.max - frame.min) * 0.98 / np.ptp(y))
            low, high = frame.min - y.min(), frame.max - y.max()
            x[:, i] = y + low + (high - low) * random.uniform(0.02, 0.98)
        else:
            x[:, i] = y * scale + random.uniform(-np.pi, np.pi)
    return t, x
