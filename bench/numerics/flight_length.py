"""Cost against the length of the flight: is it linear, and is memory bounded?

    python -m bench.numerics.flight_length [--methods exact,alm,...] [--seconds 10,100,1000] [--rig vertical-4]

Each case is a process of its own, so that its peak memory is its own: random flight at 1 kHz, solve, and what was there
before the solve taken off. A method that holds a fixed number of arrays grows by a fixed number of bytes a sample.
"""

import argparse
import json
import resource
import subprocess
import sys
import time

from bench.machine import machine


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--methods", default="exact,alm,dwln,lagrange,clamped")
    parser.add_argument("--seconds", default="10,100,1000")
    parser.add_argument("--rig", default="vertical-4")
    parser.add_argument("--case", nargs=2, metavar=("METHOD", "SECONDS"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.case:
        print(json.dumps(case(arguments.case[0], float(arguments.case[1]), arguments.rig)))
        return
    print(machine())
    print(f"{'':22}{'seconds':>9}{'samples':>10}{'solve s':>10}{'us/sample':>11}{'MB more':>10}{'B/sample':>10}")
    for method in arguments.methods.split(","):
        for seconds in arguments.seconds.split(","):
            command = [
                sys.executable,
                "-m",
                "bench.numerics.flight_length",
                "--rig",
                arguments.rig,
                "--case",
                method,
                seconds,
            ]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            found = json.loads(done.stdout)
            n = found["samples"]
            print(
                f"{method:22}{float(seconds):9g}{n:10}{found['solve_s']:10.3f}{1e6 * found['solve_s'] / n:11.2f}"
                f"{found['bytes'] / 1e6:10.1f}{found['bytes'] / n:10.0f}"
            )


def case(method: str, seconds: float, rig_name: str) -> dict[str, float]:
    """Solve one flight in this process."""
    from fullpose.attitude import dcm_from_quaternion
    from fullpose.rig import builtin_rigs
    from fullpose.scenarios import random_flight
    from fullpose.solve import solve

    rig = builtin_rigs()[rig_name]
    at, q = random_flight(1, seconds, 1000.0, 0.5)
    C = dcm_from_quaternion(q)
    solve(at[:64], C[:64], rig, method)  # kernels loaded
    before = _peak()
    begin = time.perf_counter()
    solve(at, C, rig, method)
    taken = time.perf_counter() - begin
    return {"samples": at.size, "solve_s": taken, "bytes": max(0.0, _peak() - before)}


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0


if __name__ == "__main__":
    main()
