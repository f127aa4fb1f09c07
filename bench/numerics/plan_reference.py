"""Peaks of the plan beside a slower, denser one of the same cost: python -m bench.numerics.plan_reference [flights]

The reference: nodes every quarter degree, stages 25 ms apart, knots 12.5 ms apart, thirty iterations, no windows.
A peak is the largest share of its limit that any frame takes, rates and accelerations apart.
"""

import sys
import time as clock

import numpy as np

from bench.machine import machine
from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import PlanOptions, plan
from fullpose.rig import builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.trajectory.cost import cost_of, path_cost
from fullpose.verify import verify

REFERENCE = PlanOptions(grid=np.radians(0.25), stage=0.025, knot=0.0125, iterations=30, window=1e3)


def main(count: int) -> None:
    """Print the table."""
    rig = builtin_rigs()["vertical-limited"]
    print(machine())
    print("body rate  seed   plan s  reference s   rate share (ref)    acceleration share (ref)   cost ratio")
    ratios = []
    for rate in (60.0, 120.0):
        for seed in range(count):
            t, q = random_flight(seed, 10.0, 1000.0, np.radians(rate))
            C = dcm_from_quaternion(q)
            shares, costs, seconds = [], [], []
            for options in (PlanOptions(), REFERENCE):
                begin = clock.perf_counter()
                made = plan(t, C, rig, options=options)
                seconds.append(clock.perf_counter() - begin)
                peaks = verify(t, made.solution.angles, rig).peaks
                shares.append(((peaks[:, 1] / rig.max_rate).max(), (peaks[:, 2] / rig.max_acceleration).max()))
                costs.append(path_cost(t, made.solution.angles, cost_of(rig, PlanOptions()), 1))
            (v, a), (vr, ar) = shares
            ratios.append((v / vr, a / ar, costs[0] / costs[1]))
            print(
                f"{rate:9.0f}  {seed:4d}  {seconds[0]:7.2f}  {seconds[1]:11.2f}   {v:9.3f} ({vr:.3f})   "
                f"{a:15.3f} ({ar:.3f})   {costs[0] / costs[1]:15.4f}",
                flush=True,
            )
    r = np.array(ratios)
    for name, column in zip(("rate", "acceleration", "cost"), r.T, strict=True):
        print(f"{name:13} ratio plan / reference: median {np.median(column):.3f}, largest {column.max():.3f}, "
              f"within 10 %: {int((column <= 1.1).sum())} of {len(column)}")  # fmt: skip


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 6)
