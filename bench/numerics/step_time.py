"""Median time of one step, ours beside mink's, on the same real flight in the same run.

    python -m bench.numerics.step_time [--flight F.csv] [--rig vertical-4] [--methods exact,alm,lagrange]

Ours: `solve()` at 1 kHz, the clock read every 16 samples; "one a call": the stepper called sample by sample, as a live
session does, where the call from Python is most of it. mink: see `bench.numerics.peers`; it is always called sample by
sample, for it has no other way. It has no acceleration limit and no exact end, so its error is printed too. `--cold`
adds the seconds that a fresh machine compiles for: one short solve with an empty cache, in a process of its own.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from bench.machine import machine
from bench.numerics.peers import race
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, quaternion_from_ned
from fullpose.methods import METHODS
from fullpose.resample import resample
from fullpose.rig import Rig, builtin_rigs
from fullpose.solve import solve
from fullpose.verify import attitude_errors, payload_attitudes, verify

RATE_HZ = 1000.0
SINGLE_SAMPLES = 5000  # of the flight, for the peers and for ours one a call
COLD = """
import sys, time
begin = time.perf_counter()
import numpy as np
from fullpose.solve import solve
from fullpose.rig import builtin_rigs
solve([0.0, 0.001], np.broadcast_to(np.eye(3), (2, 3, 3)), builtin_rigs()["vertical-4"], sys.argv[1])
print(time.perf_counter() - begin)
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--flight", type=Path, default=Path("examples/flights/loop.csv"), help="time_s,qw,qx,qy,qz; NED"
    )
    parser.add_argument("--rig", default="vertical-4", choices=[r for r in builtin_rigs() if r[-1] != "3"])
    parser.add_argument("--methods", default="exact,alm,lagrange")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--cold", action="store_true")
    arguments = parser.parse_args()
    rig = builtin_rigs()[arguments.rig]
    rows = np.loadtxt(arguments.flight, delimiter=",", skiprows=1)
    flight = resample(rows[:, 0], quaternion_from_ned(rows[:, 1:5]), RATE_HZ)
    at, C = flight.time, dcm_from_quaternion(flight.q)
    short = slice(0, SINGLE_SAMPLES)
    methods = arguments.methods.split(",")
    start = solve(at[:1], C[:1], rig, methods[0]).angles[0]
    # First the peers: a row's ratio is to the first of them, the quickest.
    peers = list(race(["mink"], rig, RATE_HZ, C[short], start, arguments.repeats))
    quickest = float(np.nanmedian(peers[0][1][0]))
    print(f"{arguments.flight.name} on {rig.name}, {len(at)} samples at {RATE_HZ:g} Hz, {machine()}")
    head = ("median us", "p99 us", "x of mink", "matrix error", "violations")
    print(f"{'':24}" + "".join(f"{word:>14}" for word in head))
    for method in methods:
        runs = [solve(at, C, rig, method, clock=time.perf_counter) for _ in range(arguments.repeats + 1)][1:]
        _row(method, np.concatenate([run.step_time for run in runs]), quickest, rig, at, runs[0].angles, C)
        single = [_one_a_call(method, rig, at[short], C[short]) for _ in range(arguments.repeats + 1)][1:]
        times = np.concatenate([run[0] for run in single])
        _row(f"{method}, one a call", times, quickest, rig, at[short], single[0][1], C[short])
    for name, (times, angles, _) in peers:
        _row(name, times, quickest, rig, at[short], angles, C[short])
    if arguments.cold:
        for method in methods:
            print(f"cold start of {method}: {_cold(method):.1f} s (imports and compilation)")


def _one_a_call(method: str, rig: Rig, at: Array, C: Array) -> tuple[Array, Array]:
    """(seconds of each step (n,), angles (n, 4) [rad])."""
    chosen = METHODS[method]
    stepper = chosen.stepper(rig, chosen.options(), None, C[0])
    times, angles = np.empty(len(at)), np.empty((len(at), 4))
    for k in range(len(at)):
        begin = time.perf_counter()
        block = stepper.block(at[k : k + 1], C[k : k + 1])
        times[k] = time.perf_counter() - begin
        angles[k] = block.angles[0]
    return times, angles


def _row(name: str, times: Array, quickest: float, rig: Rig, at: Array, angles: Array, C: Array) -> None:
    median, p99 = np.nanpercentile(times, [50, 99])
    error = attitude_errors(payload_attitudes(rig, angles), C)[1].max()
    cells = [f"{median * 1e6:.2f}", f"{p99 * 1e6:.2f}", f"{quickest / median:.1f}", f"{error:.1e}"]
    cells.append(str(len(verify(at, angles, rig).violations)))
    print(f"{name:24}" + "".join(f"{cell:>14}" for cell in cells))


def _cold(method: str) -> float:
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        done = subprocess.run(
            [sys.executable, "-c", COLD, method], env=environment, check=True, capture_output=True, text=True
        )
    return float(done.stdout)


if __name__ == "__main__":
    main()
