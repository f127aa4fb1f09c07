"""What a recorded attitude is rounded to: decimals of its angles or of its quaternion, or the counts of an encoder.

Found without the file: rounded quaternions that were made unit since are looked for along the ray through each of
them. Angles that are multiples and smooth, such as 0.1 deg a sample, are not rounded.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, euler_from_dcm
from fullpose.recorded.divided_differences import residuals, window_starts

MOST_SAMPLES = 3_000  # looked at
FEWEST_VALUES = 5  # different ones: fewer say nothing
_ORDER = 4
_MOST_WINDOWS = 20_000
_AS_LARGE = 0.1  # of what rounding to a quantum makes of the differences; beyond it values are exact, and not rounded
_OFTEN = 0.01  # of the windows that move
_STEEP = math.cos(math.radians(85.0))  # of the pitch: nearer to the pole yaw and roll lose digits
_CHANCE = 1e-3  # of a unit: values so near to its multiples are multiples


class Of(StrEnum):
    """What is rounded."""

    ANGLES_DEG = "angles_deg"
    QUATERNION = "quaternion"
    COUNTS = "counts"


@dataclass(frozen=True)
class Quantum:
    """`rad`: the step of the angles [rad], 0 where none is found. `unit`: the step in what is rounded (`of`)."""

    rad: float
    unit: float = 0.0
    of: Of | None = None


NONE = Quantum(0.0)
_DECIMAL = tuple(unit for d in range(8) for unit in (10.0**-d, 0.5 * 10.0**-d))  # [deg]
_COUNTS = tuple(360.0 / 2**bits for bits in range(8, 25))  # [deg] of an encoder
_QUATERNION = tuple(range(2, 8))  # decimals


def quantum_of(time: Array, q: Array) -> Quantum:
    """The quantum of the attitudes q (n, 4) at time (n,) [s]."""
    some = q[np.unique(np.linspace(0, len(q) - 1, MOST_SAMPLES).astype(np.int64))]
    some = some[np.concatenate([[True], np.any(np.diff(some, axis=0) != 0.0, axis=1)])]
    if len(some) < FEWEST_VALUES:
        return NONE
    found = _of_quaternions(some) or _of_angles(some)
    return found if found is not None and _rounded(time, q, found.rad) else NONE


def _of_angles(q: Array) -> Quantum | None:
    """The largest unit whose multiples all angles are; but a decimal is a simpler cause than a count."""
    angles = np.degrees(np.stack(euler_from_dcm(dcm_from_quaternion(q)), axis=-1))
    angles = angles[np.cos(np.radians(angles[:, 1])) > _STEEP]
    if len(angles) < FEWEST_VALUES:
        return None
    for units, of in ((_DECIMAL, Of.ANGLES_DEG), (_COUNTS, Of.COUNTS)):
        for unit in units:
            if _multiples(angles / unit):
                return Quantum(math.radians(unit), unit, of)
    return None


def _multiples(ratio: Array) -> bool:
    return bool(np.all(np.abs(ratio - np.round(ratio)) <= _CHANCE))


def _of_quaternions(q: Array) -> Quantum | None:
    """The decimals of the quaternions before they were made unit: some multiple of each is whole numbers of units."""
    largest = np.take_along_axis(q, np.argmax(np.abs(q), axis=1)[:, None], axis=1)
    for decimals in _QUATERNION:
        unit = 10.0**-decimals
        nearest = np.full(len(q), np.inf)
        for shift in (-1.0, 0.0, 1.0):
            ray = q * ((np.round(largest / unit) + shift) / largest)
            nearest = np.minimum(nearest, np.abs(ray - np.round(ray)).max(axis=1))
        if np.all(nearest <= _CHANCE):
            return Quantum(2.0 * unit, unit, Of.QUATERNION)
    return None


def _rounded(time: Array, q: Array, quantum: float) -> bool:
    """Whether the attitude has the differences that rounding to the quantum [rad] makes, somewhere at least."""
    r = residuals(time, q, window_starts(len(q), _ORDER, _MOST_WINDOWS), _ORDER)
    r = np.abs(r[np.isfinite(r[:, 0])])
    if not len(r):
        return False
    return float(np.mean(r.max(axis=1) > _AS_LARGE * quantum / math.sqrt(12.0))) >= _OFTEN
