"""Runs methods on every rig, and the rigs' loop, so that Numba's kernels are in the cache: all methods for the image.

Usage: warm.py [METHOD ...]
"""

import sys
import time
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from fullpose.attitude import dcm_from_quaternion, quaternion_from_ned
from fullpose.errors import MethodError
from fullpose.registry import method_names
from fullpose.resample import resample
from fullpose.rig import builtin_rigs
from fullpose.solve import solve
from fullpose.verify import verify
from fullpose_server.api.offload.prewarm import prewarm as of_diagnosis
from fullpose_server.drives import registry
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.loop import prewarm


def main() -> None:
    """One second of the demo flight through everything; one line a method."""
    with as_file(files("fullpose_server") / "demo_flights" / "loop_and_roll.csv") as path:
        rows = np.loadtxt(path, delimiter=",", skiprows=1, max_rows=201)
    flight = resample(rows[:, 0], quaternion_from_ned(rows[:, 1:]), 1000.0)
    attitude = dcm_from_quaternion(flight.q)
    for method in sys.argv[1:] or method_names():
        started, flown = time.perf_counter(), []
        for name, rig in builtin_rigs().items():
            try:
                solution = solve(flight.time, attitude, rig, method)
            except MethodError:
                continue  # a method for the other kind of rig
            verify(flight.time, solution.angles, rig, attitude)
            flown.append(name)
        if not flown:
            sys.exit(f"{method}: no rig flies it")
        print(f"{method}: {', '.join(flown)} in {time.perf_counter() - started:.1f} s", flush=True)  # noqa: T201
    started = time.perf_counter()
    for name, rig in builtin_rigs().items():
        config = RigConfig(name, rig, directory=Path("unused"), runs=Path("unused"))  # nothing is written
        prewarm.kernels(config)
        drive = registry.make(config.drive, rig, config.rate_hz, config.drive_options)
        drive.connect(0.0)
        drive.read(1.0 / config.rate_hz, np.zeros(4), np.zeros(4))
        drive.close()
    print(f"loop and drive in {time.perf_counter() - started:.1f} s", flush=True)  # noqa: T201
    started = time.perf_counter()
    of_diagnosis()
    print(f"diagnosis and tolerance in {time.perf_counter() - started:.1f} s", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
