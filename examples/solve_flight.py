"""Solve a flight in Python: read it, choose a rig and a method, look at errors and limits.

python examples/solve_flight.py [examples/flights/split_s.csv]
"""

import sys
import time
from pathlib import Path

import numpy as np

from fullpose.attitude import dcm_from_quaternion, quaternion_from_ned
from fullpose.bounds import limited_name
from fullpose.resample import resample
from fullpose.rig import FRAMES, builtin_rigs
from fullpose.solve import solve
from fullpose.verify import verify

# A flight: times [s] and attitudes. This file is north-east-down, so its axes are changed to ours.
path = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent / "flights" / "loop.csv")
rows = np.loadtxt(path, delimiter=",", skiprows=1)
flight = resample(rows[:, 0], quaternion_from_ned(rows[:, 1:]), 1000.0)  # the rig runs at 1 kHz
attitude = dcm_from_quaternion(flight.q)  # (n, 3, 3) body from reference

for rig_name in ("vertical-4", "horizontal-4"):
    rig = builtin_rigs()[rig_name]
    solution = solve(flight.time, attitude, rig, method="exact", clock=time.perf_counter)

    # `verify` shares no code with the methods: it multiplies the rotations out and differences the angles.
    check = verify(flight.time, solution.angles, rig, attitude)
    print(f"{path.stem} on {rig_name}: {len(flight.time)} samples in {solution.solve_time:.2f} s")
    print(f"  largest error {np.degrees(check.max_error):.1e} deg, matrix error {check.max_matrix_error:.1e}")
    for frame, (position, rate, acceleration, _jerk) in zip(FRAMES, np.degrees(check.peaks), strict=True):
        print(f"  {frame:6s} up to {position:6.1f} deg, {rate:6.1f} deg/s, {acceleration:7.1f} deg/s^2")
    if solution.limited_samples:
        codes, counts = np.unique(solution.limited[solution.limited > 0], return_counts=True)
        frame, limit = limited_name(int(codes[np.argmax(counts)])) or ("", "")
        print(
            f"  {solution.limited_samples} samples miss the attitude, most for the {limit} limit of the {frame} frame"
        )
    else:
        print("  flown exactly, inside every limit")
