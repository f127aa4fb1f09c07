"""What a tolerance does to a flight before any rig is asked: the body's rates and accelerations, before and after."""

from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.recorded.motion import Motion, body_motion
from fullpose.recorded.tube import Smoothed

MATTERS = 0.8  # of the peak acceleration as recorded: where no more than that is left, the recording is to blame


@dataclass(frozen=True)
class Effect:
    """The body's motion by differences: as recorded, on its own stamps, and as it is to be flown."""

    recorded: Motion
    flown: Motion

    @property
    def matters(self) -> bool:
        """Whether the recording itself makes a good part of the peak acceleration."""
        return self.flown.acceleration.norm < MATTERS * self.recorded.acceleration.norm


def effect_of(time: Array, q: Array, smoothed: Smoothed) -> Effect:
    """The effect on the flight of time (n,) [s], q (n, 4) w, x, y, z, unit, either sign."""
    recorded = body_motion(np.array(time, dtype=np.float64), np.array(q, dtype=np.float64))
    return Effect(recorded, body_motion(np.array(smoothed.time), np.array(smoothed.q)))
