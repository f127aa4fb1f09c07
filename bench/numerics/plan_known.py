"""Flights that are flyable by construction, at a share of the limits.

    python -m bench.numerics.plan_known [seeds] [seconds]

The paths are those of `fullpose.flyable`. `plan` is told the flight alone and should fly it.
"""

import sys
import time as clock

from bench.machine import machine
from fullpose.flyable import RIGS, flyable_path, rig_of
from fullpose.plan import PlanOptions, plan
from fullpose.rig import Geometry
from fullpose.verify import payload_attitudes, verify


def main(seeds: int, duration: float) -> None:
    """Print the counts and the processor time."""
    print(machine())
    for name in RIGS:
        for share in (0.5, 0.7, 0.9):
            flown, known, longest = 0, 0, 0.0
            for geometry in (Geometry.VERTICAL_4, Geometry.HORIZONTAL_4):
                rig = rig_of(name, geometry)
                for seed in range(seeds):
                    t, x = flyable_path(seed, rig, share, duration, 500.0)
                    if verify(t, x, rig).violations:  # the ends of the sums of sines are not scaled to
                        continue
                    known += 1
                    begin = clock.process_time()
                    made = plan(t, payload_attitudes(rig, x), rig, options=PlanOptions(best_effort=False))
                    longest = max(longest, clock.process_time() - begin)
                    flown += made.verdict.feasible
            print(
                f"{name:9s} {share:.1f} of the limits: flown {flown} of {known}, {longest:.1f} s at the longest",
                flush=True,
            )


if __name__ == "__main__":
    arguments = sys.argv[1:]
    main(int(arguments[0]) if arguments else 6, float(arguments[1]) if len(arguments) > 1 else 4.0)
