"""The scenario suite: the papers' cases and the ones that break methods, generated from a few numbers.

An angle is a constant plus sines and minimum-jerk ramps, so every attitude is twice differentiable. Angles [rad],
time [s]. The kinds of case are the papers' (Zhao 2025: small angles, large angles, over the limit with a small and a
large pitch; Lin 2022: pitch and yaw both beyond 90 deg); the numbers are ours, the papers' are not at hand.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import (
    dcm_from_quaternion,
    euler_from_dcm,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    quaternion_product,
)
from fullpose.errors import InputError

DEG = math.pi / 180.0


@dataclass(frozen=True)
class Sine:
    """amplitude * sin(2 pi t / period + phase)."""

    amplitude: float
    period: float
    phase: float = 0.0

    def at(self, time: Array) -> Array:
        """(n,) [rad]"""
        return np.asarray(self.amplitude * np.sin(2.0 * math.pi / self.period * time + self.phase))


@dataclass(frozen=True)
class Ramp:
    """A change by `change` between `begin` and `end`: the quintic with rest at both ends (Flash and Hogan 1985)."""

    change: float
    begin: float
    end: float

    def at(self, time: Array) -> Array:
        """(n,) [rad]"""
        s = np.clip((time - self.begin) / (self.end - self.begin), 0.0, 1.0)
        return np.asarray(self.change * s**3 * (10.0 + s * (6.0 * s - 15.0)))


Term = Sine | Ramp


@dataclass(frozen=True)
class Angle:
    """One Euler angle over time: a constant plus terms."""

    constant: float = 0.0
    terms: tuple[Term, ...] = ()

    def at(self, time: Array) -> Array:
        """(n,) [rad]"""
        total = np.full(time.shape, self.constant)
        for term in self.terms:
            total += term.at(time)
        return total


@dataclass(frozen=True)
class Scenario:
    """A flight as yaw, pitch and roll (order Y-Z-X) over time, and the built-in rig it is meant for."""

    name: str
    about: str
    yaw: Angle = field(default_factory=Angle)
    pitch: Angle = field(default_factory=Angle)
    roll: Angle = field(default_factory=Angle)
    rig: str = "vertical-4"
    duration: float = 10.0
    rate: float = 1000.0
    jitter: float = 0.0  # largest displacement of an inner time stamp, in sample periods (< 0.5)
    start: tuple[float, float, float, float] | None = None  # frame angles to start from
    tilt: float = 0.0  # the whole flight turned about the reference x axis, so that the nose passes beside the poles

    @property
    def time(self) -> Array:
        """(n,) [s] from 0 to `duration`; the same at every call."""
        time = np.arange(round(self.duration * self.rate) + 1) / self.rate
        if self.jitter > 0.0 and time.size > 2:
            shift = np.random.default_rng(0).uniform(-self.jitter, self.jitter, time.size - 2)
            time[1:-1] += shift / self.rate
        return time

    @property
    def euler(self) -> Array:
        """(n, 3) yaw, pitch, roll [rad]: the ones the flight is made of, not wrapped; of a tilted flight, unwrapped."""
        if self.tilt == 0.0:
            return self._untilted
        return np.unwrap(np.stack(euler_from_dcm(dcm_from_quaternion(self.quaternion)), axis=-1), axis=0)

    @property
    def quaternion(self) -> Array:
        """(n, 4) w, x, y, z, reference to body, continuous."""
        q = quaternion_from_euler(*self._untilted.T)
        if self.tilt == 0.0:
            return q
        return quaternion_product(np.array([math.cos(0.5 * self.tilt), math.sin(0.5 * self.tilt), 0.0, 0.0]), q)

    @property
    def _untilted(self) -> Array:
        time = self.time
        return np.stack([self.yaw.at(time), self.pitch.at(time), self.roll.at(time)], axis=-1)


def _sine(amplitude: float, period: float, phase: float = 0.0) -> Sine:
    return Sine(amplitude * DEG, period, phase * DEG)


def _ramp(change: float, begin: float, end: float) -> Ramp:
    return Ramp(change * DEG, begin, end)


def _angle(*terms: Term, constant: float = 0.0) -> Angle:
    return Angle(constant * DEG, terms)


_SUITE = (
    Scenario(
        "small_angles",
        "Small angles: the papers' first case, no limit in reach.",
        yaw=_angle(_sine(5.0, 10.0)),
        pitch=_angle(_sine(4.0, 8.0, 30.0)),
        roll=_angle(_sine(6.0, 5.0)),
    ),
    Scenario(
        "large_no_limit",
        "Large angles on a rig without position limits.",
        yaw=_angle(_sine(90.0, 10.0)),
        pitch=_angle(_sine(30.0, 5.0)),
        roll=_angle(_sine(120.0, 10.0)),
    ),
    Scenario(
        "over_limit",
        "Yaw 90, pitch 30, roll 120 deg sines against an inner frame of +-60 deg.",
        yaw=_angle(_sine(90.0, 10.0)),
        pitch=_angle(_sine(30.0, 5.0)),
        roll=_angle(_sine(120.0, 10.0)),
        rig="vertical-limited",
    ),
    Scenario(
        "over_limit_small_pitch",
        "Roll beyond the inner limit while pitch stays small, so that the base can hardly help.",
        yaw=_angle(_sine(30.0, 10.0)),
        pitch=_angle(_sine(5.0, 5.0, 45.0)),
        roll=_angle(_sine(90.0, 10.0)),
        rig="vertical-limited",
    ),
    Scenario(
        "over_limit_large_pitch",
        "Roll beyond the inner limit while pitch goes to 120 deg and back.",
        yaw=_angle(_sine(30.0, 10.0)),
        pitch=_angle(_ramp(120.0, 0.0, 5.0), _ramp(-120.0, 5.0, 10.0)),
        roll=_angle(_sine(90.0, 10.0)),
        rig="vertical-limited",
    ),
    Scenario(
        "over_limit_loop",
        "Roll beyond the inner limit while pitch goes through 360 deg.",
        yaw=_angle(_sine(20.0, 10.0)),
        pitch=_angle(_ramp(360.0, 0.0, 10.0)),
        roll=_angle(_sine(90.0, 10.0)),
        rig="vertical-limited",
    ),
    Scenario(
        "both_beyond_90",
        "Pitch beyond 90 deg, then yaw beyond 90 deg, 4 deg beside both poles: both three-axis rigs blow up.",
        yaw=_angle(_ramp(120.0, 4.0, 7.0), _ramp(-120.0, 7.0, 10.0)),
        pitch=_angle(_ramp(110.0, 0.0, 3.0), _ramp(-110.0, 3.0, 6.0)),
        roll=_angle(_sine(30.0, 10.0)),
        tilt=4.0 * DEG,
    ),
    Scenario(
        "level",
        "A level aircraft: pitch held at 0 while it turns and banks, on the set where the solution curve breaks up.",
        yaw=_angle(_ramp(180.0, 0.0, 10.0)),
        roll=_angle(_sine(40.0, 5.0)),
    ),
    Scenario(
        "loop",
        "A plain loop: pitch through 360 deg, exactly over the pole.",
        pitch=_angle(_ramp(360.0, 0.0, 10.0)),
    ),
    Scenario(
        "double_loop",
        "Two loops with three half rolls.",
        yaw=_angle(_sine(5.0, 10.0)),
        pitch=_angle(_ramp(720.0, 0.0, 10.0)),
        roll=_angle(_ramp(180.0, 1.0, 3.0), _ramp(180.0, 4.0, 6.0), _ramp(180.0, 7.0, 9.0)),
    ),
    Scenario(
        "pole_start",
        "A start at pitch 90 deg, the vertical three-axis rig's singularity, with all three angles moving.",
        yaw=_angle(_sine(40.0, 10.0)),
        pitch=_angle(_ramp(-90.0, 0.0, 10.0), constant=90.0),
        roll=_angle(_sine(20.0, 5.0)),
    ),
    Scenario(
        "singular_start",
        "A start in the four-axis rig's own singular pose (outer 0, middle 90 deg).",
        yaw=_angle(_sine(30.0, 10.0), constant=-90.0),
        pitch=_angle(_sine(20.0, 5.0)),
        roll=_angle(_sine(45.0, 5.0)),
        start=(0.0, 0.0, -90.0 * DEG, 0.0),
    ),
    Scenario(
        "fast_roll",
        "Eight rolls in ten seconds, up to 540 deg/s, with the nose moving.",
        yaw=_angle(_sine(15.0, 10.0)),
        pitch=_angle(_sine(15.0, 10.0, 90.0)),
        roll=_angle(_ramp(2880.0, 0.0, 10.0)),
    ),
    Scenario(
        "one_sample", "A flight of one sample.", yaw=_angle(constant=30.0), pitch=_angle(constant=20.0), duration=0
    ),
    Scenario(
        "two_samples",
        "A flight of two samples.",
        yaw=_angle(_sine(30.0, 1.0)),
        pitch=_angle(constant=10.0),
        duration=0.001,
    ),
    Scenario(
        "non_uniform",
        "Large angles with time stamps displaced by up to 0.4 of a period.",
        yaw=_angle(_sine(90.0, 10.0)),
        pitch=_angle(_sine(30.0, 5.0)),
        roll=_angle(_sine(120.0, 10.0)),
        jitter=0.4,
    ),
)

SCENARIOS: dict[str, Scenario] = {scenario.name: scenario for scenario in _SUITE}

_HARMONICS = 6


def random_flight(seed: int, duration_s: float, rate_hz: float, body_rate_rad_s: float) -> tuple[Array, Array]:
    """A seeded flight through all attitudes: (time (n,) [s], quaternion (n, 4) w, x, y, z, continuous).

    The body rate is a sum of `_HARMONICS` sines an axis, of 0.02 to 0.5 Hz, scaled so that its root mean square
    length over the flight is `body_rate_rad_s`; the first attitude is uniform over all attitudes. It is a function of
    time alone, so one seed gives one flight at any sample rate. Integrated by the fourth-order Magnus expansion on
    two Gauss nodes a sample (Iserles et al. 2000, section 5.2): at 1 kHz and 120 deg/s to about 1e-13 rad.
    Raises `InputError` where duration, rate or body rate is not a positive number.
    """
    for name, value in (("duration_s", duration_s), ("rate_hz", rate_hz), ("body_rate_rad_s", body_rate_rad_s)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(name, None, value, "a number above zero")
    random = np.random.default_rng(seed)
    first = random.normal(size=4)
    frequency = random.uniform(0.02, 0.5, (_HARMONICS, 3))
    phase = random.uniform(0.0, 2.0 * math.pi, (_HARMONICS, 3))
    amplitude = random.normal(size=(_HARMONICS, 3))

    def rate(time: Array) -> Array:  # (m,) -> (m, 3)
        total = np.zeros((time.size, 3))
        for f, p, a in zip(frequency, phase, amplitude, strict=True):
            total += a * np.sin(2.0 * math.pi * f * time[:, None] + p)
        return total

    # The scale comes from a grid of its own, so that it does not depend on the sample rate.
    probe = rate(np.linspace(0.0, duration_s, 2001))
    scale = body_rate_rad_s / math.sqrt(float(np.mean(np.sum(probe * probe, axis=1))))
    time = np.arange(round(duration_s * rate_hz) + 1) / rate_hz
    h = 1.0 / rate_hz
    offset = math.sqrt(3.0) / 6.0 * h
    middle = time[:-1] + 0.5 * h
    early, late = scale * rate(middle - offset), scale * rate(middle + offset)
    # q' = q (0, w) / 2, so increments multiply from the right and the commutator keeps the order early x late.
    increment = 0.5 * h * (early + late) + math.sqrt(3.0) / 12.0 * h * h * np.cross(early, late)
    steps = np.vstack([first / np.linalg.norm(first), quaternion_from_rotation_vector(increment)])
    return time, _running_product(steps)


def _running_product(q: Array) -> Array:
    """q[0], q[0] q[1], q[0] q[1] q[2], ... by doubling: log2(n) passes and no drift that grows with n."""
    total = q.copy()
    span = 1
    while span < total.shape[0]:
        total[span:] = quaternion_product(total[:-span], total[span:])
        span *= 2
    return np.asarray(total / np.linalg.norm(total, axis=-1, keepdims=True))
