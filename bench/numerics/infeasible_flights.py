"""Flights of 2 to 2.5 s at 100 Hz that a rig cannot fly, by what keeps it from them; most are made of frame paths."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_euler, dcm_from_quaternion, quaternion_from_rotation_vector
from fullpose.flyable import flyable_path, rig_of
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import payload_attitudes

DEG = np.pi / 180.0
HZ = 100.0
GEOMETRIES = (Geometry.VERTICAL_4, Geometry.HORIZONTAL_4)


@dataclass(frozen=True)
class Case:
    """One flight: why it cannot be flown, and what is fixed at its first sample."""

    name: str
    cause: str
    time: Array  # (n,) [s]
    attitude: Array  # (n, 3, 3)
    rig: Rig
    start: Array | None = None  # (4,) [rad]
    start_rate: Array | None = None  # (4,) [rad/s]


def scaled(rig: Rig, rate: float, acceleration: float) -> Rig:
    """The rig with its rate and acceleration limits times so much."""
    frames = [FrameLimits(f.min, f.max, f.max_rate * rate, f.max_acceleration * acceleration) for f in rig.frames]
    return replace(rig, frames=(frames[0], frames[1], frames[2], frames[3]))


def cut(rig: Rig, frame: int, half: float) -> Rig:
    """The rig with one frame's range cut to +-half [rad]."""
    frames = list(rig.frames)
    frames[frame] = replace(frames[frame], min=-half, max=half)
    return replace(rig, frames=(frames[0], frames[1], frames[2], frames[3]))


def cases() -> Iterator[Case]:
    """All of them, those of one cause together."""
    for cause, rate, acceleration in (("rate", 1.7, 1.0), ("acceleration", 1.0, 2.5), ("both", 1.6, 2.5)):
        for seed in range(4):
            for name in ("narrow", "multi", "tight"):
                rig = rig_of(name, GEOMETRIES[seed % 2])
                beyond = scaled(rig, rate, acceleration) if cause != "rate" else scaled(rig, rate, 3.0)
                time, path = flyable_path(40 + seed, beyond, 0.98, 2.5, HZ)
                yield Case(f"{name} {seed}", cause, time, payload_attitudes(rig, path), rig)
    yield from _stops()
    yield from _poles()
    yield from _rolls()
    yield from _starts()
    yield from _noisy()


def _stops() -> Iterator[Case]:
    for seed in range(6):
        rig = rig_of("tight", GEOMETRIES[seed % 2])
        time, path = flyable_path(60 + seed, rig, 0.6, 2.5, HZ)
        shrunk = rig
        for frame in range(4):
            shrunk = cut(shrunk, frame, (22.0 + 2.0 * seed) * DEG)
        yield Case(f"range {seed}", "position", time, payload_attitudes(rig, path), shrunk)


def _poles() -> Iterator[Case]:
    limited = builtin_rigs()["vertical-limited"]
    time = np.arange(0.0, 2.5, 1.0 / HZ)
    for seed in range(6):
        geometry = (Geometry.VERTICAL_3, Geometry.HORIZONTAL_3)[seed % 2]
        rig = Rig("three", geometry, limited.frames)
        side = (4.0 + 3.0 * seed) * DEG  # past the pole at this distance
        lean = (70.0 + 10.0 * seed) * DEG * (time - 1.2)
        turned = payload_attitudes(rig, np.stack([0 * time, side + 0 * time, 90.0 * DEG + lean, 0.3 * time], axis=1))
        tilt = dcm_from_quaternion(
            quaternion_from_rotation_vector(np.stack([0.1 * time, 0.0 * time, 0.0 * time], axis=1))
        )
        yield Case(f"pole {seed}", "singularity", time, tilt @ turned, rig)


def _rolls() -> Iterator[Case]:
    limited = builtin_rigs()["vertical-limited"]
    time = np.arange(0.0, 2.0, 1.0 / HZ)
    for seed, rate in enumerate((250.0, 320.0, 400.0, 400.0)):
        rig = limited if seed < 3 else replace(limited, geometry=Geometry.HORIZONTAL_4)
        pitch = (5.0 + 12.0 * seed) * DEG * np.sin(2.0 * time + seed)
        attitude = dcm_from_euler(20 * DEG * np.sin(time), pitch, rate * DEG * time)
        yield Case(f"roll {rate:g} {seed}", "fast roll", time, attitude, rig)


def _starts() -> Iterator[Case]:
    limited = builtin_rigs()["vertical-limited"]
    for seed in range(4):
        time, q = random_flight(seed, 2.0, HZ, 60.0 * DEG)
        sign = 1.0 if seed % 2 else -1.0
        path_rate = sign * np.array([150.0, -120.0, 90.0, 60.0]) * DEG
        rig = scaled(limited, 1.0, 0.5)
        start = np.array([0.3, 0.5 + 0.1 * seed, 0.4, 0.1])
        turned = payload_attitudes(rig, start[None])[0] @ dcm_from_quaternion(q)[0].T
        yield Case(f"start {seed}", "start rate", time, turned @ dcm_from_quaternion(q), rig, start, path_rate)


def _noisy() -> Iterator[Case]:
    limited = builtin_rigs()["vertical-limited"]
    for seed in range(4):
        time, q = random_flight(10 + seed, 2.0, HZ, 60.0 * DEG)
        noise = np.random.default_rng(seed).normal(size=(len(time), 3)) * (0.1, 0.3, 1.0, 0.3)[seed] * DEG
        yield Case(
            f"noise {seed}",
            "noise",
            time,
            dcm_from_quaternion(quaternion_from_rotation_vector(noise)) @ dcm_from_quaternion(q),
            limited,
        )
