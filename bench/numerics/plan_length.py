"""How the planner scales: seconds of planning and memory against the length of the flight.

    python -m bench.numerics.plan_length [seconds ...]

Memory is the process's largest resident size less what it had with the flight's arrays, and less the results'.
"""

import resource
import sys
import threading
import time as clock
from pathlib import Path

import numpy as np

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import plan
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight


def resident() -> float:
    """Resident size of this process [MiB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def main(lengths: list[float]) -> None:
    """Plan a random flight at 60 deg/s on `vertical-limited` for each length [s]."""
    rig = builtin_rigs()["vertical-limited"]
    t, q = random_flight(1, 2.0, 1000.0, np.radians(60.0))
    plan(t, dcm_from_quaternion(q), rig)  # compile
    for seconds in lengths:
        t, q = random_flight(1, seconds, 1000.0, np.radians(60.0))
        C = dcm_from_quaternion(q)
        del q
        before, peak, done = resident(), 0.0, threading.Event()

        def watch(done: threading.Event = done) -> None:
            nonlocal peak
            while not done.wait(0.05):
                peak = max(peak, resident())

        watcher = threading.Thread(target=watch)
        watcher.start()
        begin, cpu = clock.perf_counter(), clock.process_time()
        result = plan(t, C, rig)
        elapsed, cpu = clock.perf_counter() - begin, clock.process_time() - cpu
        done.set()
        watcher.join()
        s = result.solution
        arrays = (
            sum(a.nbytes for a in (s.angles, s.error, s.matrix_error, s.limited, s.iterations, s.step_time)) / 2**20
        )
        print(
            f"{seconds:7.0f} s  {len(t):8d} samples  planned in {elapsed:7.2f} s ({cpu:7.2f} s of processor)  "
            f"feasible {result.verdict.feasible}  matrix error {s.matrix_error.max():.1e}  "
            f"above input and results {peak - before - arrays:6.0f} MiB",
            flush=True,
        )


if __name__ == "__main__":
    main([float(a) for a in sys.argv[1:]] or [10.0, 60.0, 600.0, 3600.0])
