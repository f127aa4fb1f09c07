"""What a recorded flight is made of and what is wrong with it (mathematics, section 13).

Nothing is changed: the flight is looked at, and every finding has its figure. Angles [rad], times [s].
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fullpose._typing import Array, Integers
from fullpose.attitude import quaternion_from_dcm
from fullpose.errors import InputError
from fullpose.flight import bad_time
from fullpose.recorded.holds import Held, held_samples
from fullpose.recorded.motion import Peak, body_motion
from fullpose.recorded.noise import SECOND_DIFFERENCE, white_noise
from fullpose.recorded.outliers import Outliers, outliers
from fullpose.recorded.quantum import Quantum, quantum_of
from fullpose.recorded.stamps import Stamps, regular_stamps
from fullpose.recorded.steps import Gap, uneven_steps
from fullpose.resample import continuous


@dataclass(frozen=True)
class Diagnosis:
    """What `diagnose` finds. Arrays are read-only; nothing found is zero, empty or None."""

    samples: int
    time_s: Array  # (n,) as recorded
    duration_s: float
    median_step_s: float  # of the regular clock where there is one
    smallest_step_s: float
    largest_step_s: float
    white_noise_rad: Array  # (3,) standard deviation per body axis, what rounding makes of it included
    noise_measured: bool  # False where too few samples or too long steps leave the noise open
    quantum: Quantum
    held: Held
    stamps: Stamps
    near_duplicates: Integers  # (m,) samples whose stamp all but repeats the one before
    gaps: tuple[Gap, ...]
    outliers: Outliers
    body_rate: Peak  # [rad/s] of the samples as they stand, on the regular clock where there is one
    body_acceleration: Peak  # [rad/s^2] likewise

    @property
    def quantum_rad(self) -> float:
        """The step that the angles are rounded to [rad]; 0 where none is found."""
        return self.quantum.rad

    @property
    def roughness_rad(self) -> Array:
        """(3,) the standard deviation of what is white in the attitude: noise or rounding, whichever is more [rad]."""
        return np.maximum(self.white_noise_rad, self.quantum.rad / math.sqrt(12.0))

    @property
    def noise_acceleration_rad_s2(self) -> Array:
        """(3,) what noise and rounding alone cost in body acceleration, a standard deviation [rad/s^2].

        The second difference of white noise sigma at the step h is sigma sqrt(6) / h^2.
        """
        step = self.median_step_s
        return self.roughness_rad * (SECOND_DIFFERENCE / step**2 if step > 0.0 else 0.0)


def diagnose(time_s: ArrayLike, attitude: ArrayLike) -> Diagnosis:
    """The diagnosis of the flight. time_s (n,); attitude (n, 4) quaternions w, x, y, z or (n, 3, 3) matrices C.

    Raises `InputError` for arrays that are no flight.
    """
    time, q = _flight(time_s, attitude)
    stamps = regular_stamps(time, q)
    steps = uneven_steps(time, stamps.regular_time_s)
    clock = time if stamps.regular_time_s is None else stamps.regular_time_s
    motion = body_motion(clock, q)
    quantum = quantum_of(clock, q)
    held = held_samples(clock, motion.angle, quantum.rad)
    true = ~held.mask
    if stamps.regular_time_s is None:
        true[steps.near_duplicates] = False
    all_true = bool(true.all())
    noise = white_noise(clock, q) if all_true else white_noise(clock[true], q[true])
    found = outliers(clock, q, float(noise.sigma.max())) if all_true else _outliers_among(clock, q, true, noise.sigma)
    for part in (time, noise.sigma, held.mask, steps.near_duplicates, found.sample, found.size_rad, found.sigmas):
        part.setflags(write=False)
    return Diagnosis(
        samples=time.size,
        time_s=time,
        duration_s=float(time[-1] - time[0]),
        median_step_s=stamps.median_step_s,
        smallest_step_s=steps.smallest_s,
        largest_step_s=steps.largest_s,
        white_noise_rad=noise.sigma,
        noise_measured=noise.measured,
        quantum=quantum,
        held=held,
        stamps=stamps,
        near_duplicates=steps.near_duplicates,
        gaps=steps.gaps,
        outliers=found,
        body_rate=motion.rate,
        body_acceleration=motion.acceleration,
    )


def _outliers_among(time: Array, q: Array, true: NDArray[np.bool_], sigma: Array) -> Outliers:
    """The outliers of the samples that are `true` (n,), numbered in the flight."""
    found = outliers(time[true], q[true], float(sigma.max()))
    return Outliers(np.flatnonzero(true)[found.sample], found.size_rad, found.sigmas)


def _flight(time_s: ArrayLike, attitude: ArrayLike) -> tuple[Array, Array]:
    """(time (n,), unit continuous quaternions (n, 4)), copied. Raises `InputError`."""
    time = np.array(time_s, dtype=np.float64, order="C")
    given = np.asarray(attitude, dtype=np.float64)
    if time.ndim != 1 or not time.size:
        raise InputError("time", None, time.shape, "(n,) seconds, at least one sample")
    if given.shape not in ((time.size, 4), (time.size, 3, 3)):
        raise InputError("attitude", None, given.shape, f"({time.size}, 4) or ({time.size}, 3, 3), one a sample")
    if found := bad_time(time):
        raise InputError("time", found[0], float(time[found[0]]), found[1])
    q = quaternion_from_dcm(given) if given.ndim == 3 else given
    norm = np.linalg.norm(q, axis=1)
    bad = np.flatnonzero(~((norm > 0.5) & (norm < 2.0)))
    if bad.size:
        raise InputError("attitude", int(bad[0]), given[bad[0]].tolist(), "a rotation: a unit quaternion or matrix")
    return time, continuous(q / norm[:, None])
