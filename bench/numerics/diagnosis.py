"""Diagnosis of long recorded flights: python -m bench.numerics.diagnosis [--samples N ...] [--repeat K] [--json FILE]

Flights through all attitudes at 1 kHz, recorded with white noise, rounded angles, stamps that jitter, and held samples.
Each is diagnosed in this process, kernels compiled before, and beside it stands what NumPy alone takes for the least
that a diagnosis has to do: one pass over stamps and quaternions for steps, continuity, and second differences of each
component. Times are of the processor, the least of the repeats; memory is what a diagnosis has allocated at its peak,
beside the flight itself. The bound is 1 s for 1 000 000 samples.
"""

import argparse
import json
import time as clock
import tracemalloc
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from bench.machine import machine
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, euler_from_dcm, quaternion_from_euler
from fullpose.recorded import diagnose

BOUND_S = 1.0
AT = 1_000_000
RATE_HZ = 1000.0
Flight = tuple[Array, Array]  # stamps (n,) [s], quaternions (n, 4)


@dataclass(frozen=True)
class Row:
    """One recording of one length."""

    recording: str
    samples: int
    diagnosis_s: float
    numpy_s: float
    flight_mb: float
    peak_mb: float


def clean(samples: int) -> Flight:
    """Three turns at once, of rates that have no common period."""
    time = np.arange(samples) / RATE_HZ
    angles = (0.7 * time, 0.6 * np.sin(0.9 * time), 1.3 * np.sin(0.37 * time) + 0.2 * time)
    return time, quaternion_from_euler(*angles)


def noisy(samples: int) -> Flight:
    """White noise of 0.01 deg."""
    time, q = clean(samples)
    q = q + np.radians(0.01) / 2.0 * np.random.default_rng(1).normal(size=q.shape)
    return time, q / np.linalg.norm(q, axis=1)[:, None]


def rounded(samples: int) -> Flight:
    """Angles of two decimals of a degree."""
    time, q = clean(samples)
    angles = np.round(np.degrees(np.stack(euler_from_dcm(dcm_from_quaternion(q)), axis=1)), 2)
    return time, quaternion_from_euler(*np.radians(angles).T)


def jittered(samples: int) -> Flight:
    """Stamps off by up to 0.1 ms."""
    time, q = clean(samples)
    return time + np.random.default_rng(2).uniform(-1e-4, 1e-4, samples), q


def held(samples: int) -> Flight:
    """Each sample written eight times."""
    time, q = clean(samples)
    return time, np.ascontiguousarray(q[np.arange(samples) // 8 * 8])


RECORDINGS: dict[str, Callable[[int], Flight]] = {
    "clean": clean,
    "white noise 0.01 deg": noisy,
    "angles of 2 decimals": rounded,
    "stamps off 0.1 ms": jittered,
    "125 Hz held at 1 kHz": held,
}


def least(time: Array, q: Array) -> float:
    """The least that has to be done, by NumPy alone."""
    steps = np.diff(time)
    turned = np.einsum("ij,ij->i", q[1:], q[:-1])
    second = np.diff(q, 2, axis=0)
    return float(np.median(steps)) + float(turned.min()) + float(np.sqrt((second * second).sum(axis=1)).max())


def taken_s(call: Callable[[], object], repeat: int) -> float:
    """The least time of the processor of so many [s]."""
    best = float("inf")
    for _ in range(repeat):
        begun = clock.process_time()
        call()
        best = min(best, clock.process_time() - begun)
    return best


def peak_mb(call: Callable[[], object]) -> float:
    """What Python and NumPy had allocated at once for it, at most."""
    tracemalloc.start()
    call()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / 1e6


def measured(name: str, samples: int, repeat: int) -> Row:
    """One row."""
    time, q = RECORDINGS[name](samples)
    diagnosis_s = taken_s(lambda: diagnose(time, q), repeat)
    numpy_s = taken_s(lambda: least(time, q), repeat)
    return Row(name, samples, diagnosis_s, numpy_s, (time.nbytes + q.nbytes) / 1e6, peak_mb(lambda: diagnose(time, q)))


def main() -> None:
    """Measure, print, and write where asked."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--samples", type=int, nargs="+", default=[10_000, 100_000, AT])
    arguments.add_argument("--repeat", type=int, default=3)
    arguments.add_argument("--json", type=Path)
    given = arguments.parse_args()
    print(machine())
    print(
        f"{'recording':24} {'samples':>9} {'diagnosis s':>12} {'NumPy s':>9} {'ratio':>7}"
        f" {'flight MB':>10} {'peak MB':>9}"
    )
    rows = []
    for name in RECORDINGS:
        diagnose(*RECORDINGS[name](2000))  # compiled before it is timed
        for samples in given.samples:
            row = measured(name, samples, given.repeat)
            rows.append(row)
            ratio = row.diagnosis_s / row.numpy_s
            print(
                f"{name:24} {samples:9} {row.diagnosis_s:12.4f} {row.numpy_s:9.4f} {ratio:7.1f}"
                f" {row.flight_mb:10.1f} {row.peak_mb:9.1f}",
                flush=True,
            )
    longest = [row.diagnosis_s for row in rows if row.samples == AT]
    if longest:
        print(f"{AT} samples: {max(longest):.3f} s at most, the bound is {BOUND_S:g} s")
    if given.json is not None:
        document = {"machine": machine(), "bound_s": BOUND_S, "rows": [asdict(row) for row in rows]}
        given.json.write_text(json.dumps(document, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
