"""Median time of one step, ours beside mink's, on the same real flight in the same run.

    python -m bench.step_time [--flight examples/flights/loop.csv] [--rig vertical-4] [--methods exact,alm,lagrange]

Ours: `solve()` at 1 kHz, the clock read every 16 samples. mink (stephane-caron's pink for MuJoCo): `solve_ik` with an
orientation task on the payload, position and rate limits, its quickest QP solver here, then integrated: what its own
examples do in a step. It has no acceleration limit and no exact end, so its error is printed too. `--cold` adds the
seconds that a fresh machine compiles for: one short solve with an empty cache, in a process of its own.
"""

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray

from bench.mjcf import mjcf
from solver.attitude import dcm_from_quaternion, quaternion_from_ned
from solver.resample import resample
from solver.rig import FRAMES, Rig, builtin_rigs
from solver.solution import Solution
from solver.solve import solve
from solver.verify import attitude_errors, payload_attitudes, verify

Array = NDArray[np.float64]
RATE_HZ = 1000.0
SOLVER = "daqp"
COLD = """
import sys, time
begin = time.perf_counter()
import numpy as np
from solver.solve import solve
from solver.rig import builtin_rigs
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
    C = dcm_from_quaternion(flight.q)
    print(f"{arguments.flight.name} on {rig.name}, {len(flight.time)} samples at {RATE_HZ:g} Hz, {_machine()}")
    print(f"{'':24}{'median us':>10}{'p99 us':>10}{'matrix error':>14}{'limited':>9}{'violations':>12}")
    starts = np.zeros(4)
    for method in arguments.methods.split(","):
        runs = [solve(flight.time, C, rig, method, clock=time.perf_counter) for _ in range(arguments.repeats + 1)][1:]
        starts = runs[0].angles[0]
        _row(method, [run.step_time for run in runs], runs[0])
    times, angles = _mink(rig, flight.time, C, starts)
    _row_of(f"mink {SOLVER}", times, attitude_errors(payload_attitudes(rig, angles), C)[1].max(), "-",
            len(verify(flight.time, angles, rig).violations))  # fmt: skip
    if arguments.cold:
        for method in arguments.methods.split(","):
            print(f"cold start of {method}: {_cold(method):.1f} s (imports and compilation)")


def _row(name: str, times: list[Array], solution: Solution) -> None:
    violations = len(verify(solution.time, solution.angles, solution.rig).violations)
    _row_of(name, np.concatenate(times), solution.matrix_error.max(), str(solution.limited_samples), violations)


def _row_of(name: str, times: Array, error: float, limited: str, violations: int) -> None:
    median, p99 = np.percentile(times * 1e6, [50, 99])
    print(f"{name:24}{median:10.2f}{p99:10.2f}{error:14.1e}{limited:>9}{violations:12}")


def _mink(rig: Rig, flight_time: Array, C: Array, start: Array) -> tuple[Array, Array]:
    """(seconds of each step, angles (n, 4) [rad]) of mink following the same attitudes."""
    model = mujoco.MjModel.from_xml_string(mjcf(rig))
    configuration = mink.Configuration(model, q=start.copy())
    task = mink.FrameTask(FRAMES[3], "body", position_cost=0.0, orientation_cost=1.0, gain=1.0)
    limits: list[Any] = [
        mink.ConfigurationLimit(model),
        mink.VelocityLimit(model, {FRAMES[i]: float(rig.max_rate[i]) for i in range(4)}),
    ]
    dt = 1.0 / RATE_HZ
    targets = [mink.SE3.from_rotation(mink.SO3.from_matrix(np.ascontiguousarray(F.T))) for F in C]
    times, angles = np.empty(len(flight_time)), np.empty((len(flight_time), 4))
    for k, target in enumerate(targets):
        begin = time.perf_counter()
        task.set_target(target)
        rate = mink.solve_ik(configuration, [task], dt, SOLVER, limits=limits)
        configuration.integrate_inplace(rate, dt)
        times[k] = time.perf_counter() - begin
        angles[k] = configuration.q
    return times, angles


def _cold(method: str) -> float:
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        done = subprocess.run(
            [sys.executable, "-c", COLD, method], env=environment, check=True, capture_output=True, text=True
        )
    return float(done.stdout)


def _machine() -> str:
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.split(":")[1].strip() for line in cpuinfo.read_text().splitlines() if "model name" in line]
        model = names[0] if names else model
    return f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}"


if __name__ == "__main__":
    main()
