"""The planner against a search over all pairs of nodes, every range cut: python -m bench.numerics.plan_exhaustive

No windows, no turn bookkeeping: every node is repeated for every turn its ranges hold, and every pair of neighbouring
stages is tried under the rate limits. A flight with a chain that `plan` does not fly would be a miss.
"""

import sys

import numpy as np

from bench.machine import machine
from bench.numerics.flights import rigs
from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import PlanOptions, plan
from fullpose.rig import Rig
from fullpose.scenarios import random_flight
from fullpose.trajectory.nodes import lattice
from fullpose.trajectory.shortest_path import Programme
from fullpose.trajectory.windows import stage_samples

GRID = np.radians(3.0)
DURATION = 20.0


def lifted(nodes: Array, rig: Rig) -> Array:
    """The nodes (k, 4) in every turn that the ranges hold."""
    for frame in range(4):
        span = [nodes + 2.0 * np.pi * turn * np.eye(4)[frame] for turn in (-1, 0, 1)]
        nodes = np.concatenate(span)
        nodes = nodes[(nodes[:, frame] >= rig.position_min[frame]) & (nodes[:, frame] <= rig.position_max[frame])]
    return nodes


def chain_exists(time: Array, attitude: Array, rig: Rig) -> bool:
    """Whether any chain of nodes obeys ranges and rates."""
    programme = Programme(time, attitude, rig, lattice(rig, GRID), PlanOptions())
    nodes, _, alive = programme.nodes(0)
    here = lifted(nodes[alive], rig)
    for k in range(1, len(time)):
        nodes, _, alive = programme.nodes(k)
        ahead = lifted(nodes[alive], rig)
        reach = rig.max_rate * (time[k] - time[k - 1])
        joined = np.ones((len(here), len(ahead)), bool)
        for frame in range(4):
            joined &= np.abs(ahead[None, :, frame] - here[:, None, frame]) <= reach[frame]
        here = ahead[joined.any(axis=0)]
        if not len(here):
            return False
    return True


def main(seeds: int) -> None:
    """Print the counts."""
    rig = rigs()["narrow"]
    print(machine())
    for rate in (30.0, 60.0, 120.0):
        counts = {(chain, flown): 0 for chain in (True, False) for flown in (True, False)}
        for seed in range(seeds):
            t, q = random_flight(1000 + seed, DURATION, 500.0, np.radians(rate))
            C = dcm_from_quaternion(q)
            stages = stage_samples(t, 0.05)
            flown = plan(t, C, rig, options=PlanOptions(best_effort=False)).verdict.feasible
            counts[chain_exists(t[stages], C[stages], rig), flown] += 1
        print(
            f"{rate:4.0f} deg/s, {seeds} flights: chain and flown {counts[True, True]}, chain but not flown "
            f"{counts[True, False]}, no chain on this grid but flown {counts[False, True]}, "
            f"neither {counts[False, False]}",
            flush=True,
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 12)
