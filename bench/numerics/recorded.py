"""Recorded flights within the suggested tolerance: python -m bench.numerics.recorded [--flights N] [--json FILE]

Flights of 6 s through all attitudes (60 deg/s of the body, root mean square, on the limits of mathematics, section 8),
recorded as recorders do: white noise, decimals of angles and quaternions, stamps that are rounded or jitter, a slow log
held. Each is smoothed without being told how it was recorded, planned within the tolerance that is suggested, and
compared with the plan of the clean flight at the same rate. What is flown is marked by `fullpose.verify`. Deviations
are root mean squares [deg]; "peaks" is the largest ratio of a frame's peak acceleration to the clean plan's, "body"
that of the body's own. Times are of the processor.
"""

import argparse
import json
import time as clock
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from bench.machine import machine
from fullpose._typing import Array
from fullpose.attitude import (
    dcm_from_quaternion,
    euler_from_dcm,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    quaternion_product,
)
from fullpose.plan import plan
from fullpose.recorded import smooth
from fullpose.recorded.bending import geodesic
from fullpose.recorded.motion import body_motion
from fullpose.rig import Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import verify

DURATION = 6.0  # [s]
BODY_RATE = np.radians(60.0)
FINE = 20_000.0  # [Hz] at which a flight is known, so that it can be read at any stamp
Recorded = tuple[Array, Array, Array, Array]  # stamps, quaternions; true time, true quaternions of each


def flight(seed: int, rate: float) -> tuple[Array, Array]:
    """(time (n,) [s], quaternion (n, 4)) of a clean flight."""
    return random_flight(seed, DURATION, rate, BODY_RATE)


def white(sigma_deg: float) -> Callable[[int], Recorded]:
    """White noise about each body axis."""

    def recorded(seed: int) -> Recorded:
        time, q = flight(seed, 1000.0)
        noise = np.radians(sigma_deg) * np.random.default_rng(seed).normal(size=(len(q), 3))
        return time, quaternion_product(q, quaternion_from_rotation_vector(noise)), time, q

    return recorded


def decimals(seed: int) -> Recorded:
    """Angles of two decimals of a degree."""
    time, q = flight(seed, 1000.0)
    angles = np.round(np.degrees(np.stack(euler_from_dcm(dcm_from_quaternion(q)), axis=1)), 2)
    return time, quaternion_from_euler(*np.radians(angles).T), time, q


def four(seed: int) -> Recorded:
    """Quaternions of four decimals."""
    time, q = flight(seed, 1000.0)
    rounded = np.round(q, 4)
    return time, rounded / np.linalg.norm(rounded, axis=1, keepdims=True), time, q


def milliseconds(seed: int) -> Recorded:
    """Stamps of whole milliseconds at 400 Hz."""
    time, q = flight(seed, 400.0)
    return np.round(time, 3), q, time, q


def jitter(seed: int) -> Recorded:
    """Stamps off by up to 0.1 ms at 1 kHz."""
    time, q = flight(seed, 1000.0)
    off = np.random.default_rng(seed).uniform(-1e-4, 1e-4, len(time))
    return time + off, q, time, q


def held(seed: int) -> Recorded:
    """A log of 50 Hz written at 400 Hz."""
    time, q = flight(seed, 400.0)
    return time, q[np.arange(len(q)) // 8 * 8], time, q


DEGRADATIONS: dict[str, Callable[[int], Recorded]] = {
    "white noise 0.001 deg": white(0.001),
    "white noise 0.01 deg": white(0.01),
    "white noise 0.05 deg": white(0.05),
    "angles of 2 decimals": decimals,
    "stamps of 1 ms, 400 Hz": milliseconds,
    "stamps off 0.1 ms, 1 kHz": jitter,
    "50 Hz held at 400 Hz": held,
    "quaternions of 4 decimals": four,
}


@dataclass(frozen=True)
class Outcome:
    """One recording of one flight, planned within the suggested tolerance. Degrees and seconds."""

    recording: str
    seed: int
    flown: bool
    suggested_deg: float
    floor_deg: float
    noise_rms_deg: float  # of the recording, from the clean flight at each sample's own moment
    deviation_rms_deg: float  # of the flown flight from the clean one
    peaks: float
    body: float
    smoothing_s: float
    planning_s: float


def outcome(name: str, seed: int, rig: Rig) -> Outcome:
    """Smooth, plan, compare."""
    stamps, q, true_time, clean = DEGRADATIONS[name](seed)
    attitude = dcm_from_quaternion(q)
    before = clock.process_time()
    free = smooth(stamps, attitude)
    smoothing = clock.process_time() - before
    tolerance = free.suggested or np.radians(1e-3)
    made = smooth(stamps, attitude, tolerance, free.diagnosis)
    before = clock.process_time()
    planned = plan(made.time, made.attitude, rig)
    planning = clock.process_time() - before
    checked = verify(made.time, planned.solution.angles, rig, made.attitude)
    wanted = verify(true_time, plan(true_time, dcm_from_quaternion(clean), rig).solution.angles, rig)
    body = body_motion(np.array(made.time), np.array(made.q)).acceleration.norm
    return Outcome(
        recording=name,
        seed=seed,
        flown=planned.verdict.feasible and not checked.violations and made.inside and checked.max_error < 1e-11,
        suggested_deg=float(np.degrees(free.suggested)),
        floor_deg=float(np.degrees(free.floor)),
        noise_rms_deg=_rms_deg(geodesic(_at_stamps(name, seed, stamps, true_time, clean), q)),
        deviation_rms_deg=_rms_deg(geodesic(made.q, clean)),
        peaks=float((checked.peaks[:, 2] / wanted.peaks[:, 2]).max()),
        body=body / body_motion(true_time, clean).acceleration.norm,
        smoothing_s=smoothing,
        planning_s=planning,
    )


def _rms_deg(angle: Array) -> float:
    return float(np.degrees(np.sqrt(np.mean(angle**2))))


def _at_stamps(name: str, seed: int, stamps: Array, true_time: Array, clean: Array) -> Array:
    """The clean flight where the stamps say that the samples are: what a stamp is off by is an angle, too."""
    if not name.startswith("stamps"):
        return clean
    _, fine = flight(seed, FINE)
    return fine[np.clip(np.round((stamps - true_time[0]) * FINE).astype(int), 0, len(fine) - 1)]


def flyable(count: int, rig: Rig) -> list[int]:
    """The first seeds whose clean flights this rig flies at both rates."""
    seeds: list[int] = []
    seed = 0
    while len(seeds) < count:
        seed += 1
        clean = [(time, dcm_from_quaternion(q)) for time, q in (flight(seed, 1000.0), flight(seed, 400.0))]
        if all(plan(time, attitude, rig).verdict.feasible for time, attitude in clean):
            seeds.append(seed)
    return seeds


def table(found: list[Outcome]) -> str:
    """Markdown, a row a recording: the worst of its flights."""
    head = "| recording | flown | suggested | floor | noise | left | peaks | body | smoothing | planning |"
    rows = [head, "|---|" + "---:|" * 9]
    for name in dict.fromkeys(one.recording for one in found):
        part = [one for one in found if one.recording == name]
        worst = {key: max(getattr(one, key) for one in part) for key in asdict(part[0]) if key != "recording"}
        flown = f"{sum(one.flown for one in part)}/{len(part)}"
        rows.append(
            f"| {name} | {flown} | {worst['suggested_deg']:.3g} | {worst['floor_deg']:.3g} | "
            f"{worst['noise_rms_deg']:.2g} | {worst['deviation_rms_deg']:.2g} | {worst['peaks']:.2f} | "
            f"{worst['body']:.2f} | {worst['smoothing_s']:.2f} s | {worst['planning_s']:.2f} s |"
        )
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flights", type=int, default=6)
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    rig = builtin_rigs()["vertical-limited"]
    found = [outcome(name, seed, rig) for seed in flyable(asked.flights, rig) for name in DEGRADATIONS]
    print(table(found))
    print(f"\nThe largest of each over {asked.flights} flights; {machine()}")
    if asked.json is not None:
        asked.json.write_text(json.dumps([asdict(one) for one in found], indent=2) + "\n")


if __name__ == "__main__":
    main()
