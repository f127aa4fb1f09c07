"""Whether the way in which a flight was recorded is what keeps a rig from it."""

from fullpose._typing import Array
from fullpose.attitude import quaternion_from_dcm
from fullpose.recorded import Smoothed, effect_of, smooth


def recorded_noise(time: Array, attitude: Array) -> Smoothed | None:
    """The flight behind a recorded one where the recording makes a good part of its accelerations; None elsewhere."""
    if len(time) < 2:
        return None
    smoothed = smooth(time, attitude)
    matters = smoothed.suggested > 0.0 and effect_of(time, quaternion_from_dcm(attitude), smoothed).matters
    return smoothed if matters else None
