"""Flights whose truth SciPy makes, and what recording does to them. Angles in degrees here, quaternions w first."""

import warnings

import numpy as np
from scipy.spatial.transform import Rotation

from fullpose._typing import Array

FLIGHTS = ("gentle", "manoeuvre", "rest_and_turn", "pole", "spin", "tumble")


def _turn(axis: tuple[float, float, float], angle_deg: Array) -> Rotation:
    unit = np.array(axis) / np.linalg.norm(axis)
    return Rotation.from_rotvec(np.radians(angle_deg)[:, None] * unit)


def truth(name: str, time: Array) -> Rotation:
    """The attitude of a flight at time (n,) [s]: at most 720 deg/s, and at rest in parts of one of them."""
    wave = 2.0 * np.pi * time
    ramp = np.clip((time - 1.0) / 1.5, 0.0, 1.0)
    match name:
        case "gentle":
            return _turn((0, 1, 0), 40 + 8 * np.sin(0.2 * wave)) * _turn((1, 0, 0), 5 * np.sin(0.31 * wave + 1.0))
        case "manoeuvre":
            return (
                _turn((0, 1, 0), 60 * np.sin(0.15 * wave))
                * _turn((0, 0, 1), 25 * np.sin(0.23 * wave + 0.5))
                * _turn((1, 0, 0), 90 * np.sin(0.4 * wave))
            )
        case "rest_and_turn":
            return _turn((1, 2, 3), 70 * ramp**4 * (35 - 84 * ramp + 70 * ramp**2 - 20 * ramp**3))
        case "pole":
            return (
                _turn((0, 1, 0), 20 * time) * _turn((0, 0, 1), 90 + 6 * np.sin(0.5 * wave)) * _turn((1, 0, 0), 9 * time)
            )
        case "spin":
            return _turn((1, 0, 0), 700 * time) * _turn((0, 1, 1), 15 * np.sin(0.7 * wave))
    return (
        _turn((1, 1, 0), 250 * time) * _turn((0, 1, 2), 120 * np.sin(0.6 * wave)) * _turn((3, 0, 1), 100 * np.sin(wave))
    )


def quaternion(attitude: Rotation) -> Array:
    """(n, 4), w first."""
    return np.asarray(attitude.as_quat(scalar_first=True))


def grid(rate_hz: float, duration_s: float = 4.0) -> Array:
    """(n,) [s] from zero."""
    return np.arange(round(rate_hz * duration_s) + 1) / rate_hz


def noisy(attitude: Rotation, sigma_deg: Array | float, seed: int = 0) -> Rotation:
    """White noise about the body axes."""
    noise = np.random.default_rng(seed).normal(size=(len(attitude), 3))
    return attitude * Rotation.from_rotvec(np.radians(sigma_deg * noise))


def rounded_angles(attitude: Rotation, decimals: int) -> Rotation:
    """Yaw, pitch and roll (about y, z, x) rounded to decimals of a degree."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # at the pole one of many sets of angles is as good as another
        angles = attitude.as_euler("YZX", degrees=True)
    return Rotation.from_euler("YZX", np.round(angles, decimals), degrees=True)


def geodesic_deg(a: Array, b: Array) -> Array:
    """(n,) between quaternions (n, 4)."""
    ra, rb = (Rotation.from_quat(q, scalar_first=True) for q in (a, b))
    return np.degrees((ra.inv() * rb).magnitude())
