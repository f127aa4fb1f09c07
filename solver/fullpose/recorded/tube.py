"""A recorded flight inside a tolerance: the attitude behind its noise, within a tube about every sample (mathematics,
section 13).

The moments of true samples are the data: stamps that jitter are put on the clock that explains them, held samples are
left out, and so are outliers. What the tube bounds is the deviation from every sample as it was given.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, quaternion_from_dcm
from fullpose.errors import InputError
from fullpose.flight import check_flight
from fullpose.recorded.bending import Bending, floor_of, geodesic, in_tube
from fullpose.recorded.diagnosis import Diagnosis, diagnose
from fullpose.recorded.smoothing_spline import FEWEST, Smooth, smoothing_spline
from fullpose.resample import continuous

NOISELESS = 0.4  # cut-off periods a sample: from here on there is no noise to tell from the flight
ROOM = 1.1  # what is suggested beside the largest deviation of the noise itself
DIGITS = 2  # of what is suggested
WIDEST = math.radians(90.0)


@dataclass(frozen=True)
class Smoothed:
    """A flight as it is to be flown: what any method takes in place of the recorded one. Arrays are read-only."""

    time: Array  # (n,) [s] on the clock that explains the stamps
    q: Array  # (n, 4) w, x, y, z, reference to body, unit, continuous
    deviation: Array  # (n,) [rad] geodesic, from each sample as it was given
    tolerance: float | None  # [rad] that was asked for
    cut_off_hz: float  # what is slower is the flight; inf where nothing was taken away
    noise: float  # [rad] the largest deviation of a sample from the attitude behind the noise
    shift_angle: float  # [rad] the largest turn while a stamp moves to its clock
    diagnosis: Diagnosis
    bending: Bending | None  # None where nothing was taken away

    def __post_init__(self) -> None:
        for name in ("time", "q", "deviation"):
            getattr(self, name).setflags(write=False)

    @cached_property
    def attitude(self) -> Array:
        """(n, 3, 3) body from reference."""
        return dcm_from_quaternion(self.q)

    @property
    def max_deviation(self) -> float:
        """[rad]"""
        return float(self.deviation.max())

    @property
    def rms_deviation(self) -> float:
        """[rad]"""
        return float(np.sqrt(np.mean(self.deviation**2)))

    @property
    def inside(self) -> bool:
        """Whether every sample is within the tolerance, where one was asked for."""
        return self.tolerance is None or self.max_deviation <= self.tolerance

    @property
    def suggested(self) -> float:
        """The tolerance [rad] that takes away what the recording added; 0 where that is nothing."""
        return rounded_up(ROOM * max(self.noise, self.shift_angle))

    @cached_property
    def floor(self) -> float:
        """The tolerance [rad] below which none helps: no curve as smooth as the flight is so near; 0 without noise."""
        return 0.0 if self.bending is None else floor_of(self.bending)

    @property
    def largest_shift(self) -> float:
        """How far a stamp was moved onto the clock [s]."""
        return self.diagnosis.stamps.jitter_max_s if self.diagnosis.stamps.explained else 0.0


def rounded_up(angle: float) -> float:
    """An angle [rad] up to `DIGITS` digits in degrees."""
    if angle <= 0.0:
        return 0.0
    degrees = math.degrees(angle)
    unit = 10.0 ** (math.floor(math.log10(degrees)) - DIGITS + 1)
    return math.radians(math.ceil(degrees / unit * (1.0 - 1e-9)) * unit)


def smooth(
    time: ArrayLike, attitude: ArrayLike, tolerance: float | None = None, diagnosis: Diagnosis | None = None
) -> Smoothed:
    """The flight behind a recorded one: time (n,) [s], attitude (n, 3, 3) body from reference.

    tolerance [rad]: no sample is farther than that from the given one wherever such a curve is found (`inside`). It is
    a bound: what the recording added is taken away, and no more of the tolerance is used than that takes. None: without
    a bound. diagnosis: that of the flight, where it was made.

    Raises `InputError` for arrays that are no flight and for a tolerance that is none.
    """
    if tolerance is not None and not 0.0 < tolerance <= WIDEST:
        raise InputError("tolerance", None, tolerance, f"an angle above zero, at most {WIDEST:.6g} rad")
    t, C = check_flight(time, attitude)
    found = diagnosis or diagnose(t, C)
    q = continuous(quaternion_from_dcm(C))
    at = t if found.stamps.regular_time_s is None else np.array(found.stamps.regular_time_s)
    shift = _shift_angle(t, at, q)
    true = _true_samples(found)
    base = _base(at, q, true)
    if base is None:
        return Smoothed(at, q, np.zeros(len(at)), tolerance, math.inf, 0.0, shift, found, None)
    bending = Bending(base, at, q, true)
    flown = base.at(at)
    deviation = geodesic(flown, q)
    noise = float(deviation.max())
    if tolerance is not None and noise > tolerance:
        flown = in_tube(bending, tolerance)
        deviation = geodesic(flown, q)
    return Smoothed(at, continuous(flown), deviation, tolerance, base.cut_off_hz, noise, shift, found, bending)


def _base(time: Array, q: Array, true: NDArray[np.bool_]) -> Smooth | None:
    """The smooth curve of the true samples; None where there is nothing to take away."""
    count = int(np.count_nonzero(true))
    if count < FEWEST:
        return None
    at = np.ascontiguousarray(time[true])
    base = smoothing_spline(at, np.ascontiguousarray(q[true]), (float(time[0]), float(time[-1])))
    noiseless = base.cut_off_hz >= NOISELESS * (count - 1) / float(at[-1] - at[0])
    return None if noiseless and count == len(time) else base


def _true_samples(found: Diagnosis) -> NDArray[np.bool_]:
    """The samples that are data: not held, no repeated stamp, no outlier."""
    true = ~found.held.mask
    true[found.outliers.sample] = False
    if not found.stamps.explained:
        true[found.near_duplicates] = False
    return true


def _shift_angle(stamps: Array, clock: Array, q: Array) -> float:
    """The largest angle [rad] that the flight turns by while a stamp moves to its clock."""
    if len(stamps) < 2 or bool((stamps == clock).all()):
        return 0.0
    rate = geodesic(q[1:], q[:-1]) / np.diff(clock)
    faster = np.maximum(np.append(rate, 0.0), np.append(0.0, rate))  # of the two intervals beside a sample
    return float((faster * np.abs(stamps - clock)).max())
