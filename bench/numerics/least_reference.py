"""The slow reference of the least tolerance: all that is slow and shares nothing with the planner, the best of it.

Starts are the paths of the dense grid over all frames (`grid_search`) and random ones; all are shot at for a while
(`shooting`), and the best of them are brought to the end by linear programmes of every sample (`linear_descent`).
"""

import math

import numpy as np

from bench.numerics.grid_search import grid_paths
from bench.numerics.infeasible_flights import Case
from bench.numerics.linear_descent import descended_linearly
from bench.numerics.shooting import Reference, descended, path_of, pursuit, start_path
from fullpose._typing import Array
from fullpose.verify import verify

ON_THE_GRID = 5
SHOT, GO_ON = 3, 4  # powers that all starts are shot at with, and those that the best go through
FINALISTS = 3
APART = 0.05  # [rad] between two finalists in some frame


def reference(case: Case, restarts: int, seed: int = 0) -> Reference:
    """The least tolerance [rad] that is found, and how many of the finalists come inside the limits."""
    random = np.random.default_rng(seed)
    starts = [*grid_paths(case, ON_THE_GRID), *(start_path(case, random, number) for number in range(restarts))]
    pool: list[tuple[float, int, Array]] = []
    for number, path in enumerate(starts):
        unknowns, cost = pursuit(case, path), 0.0
        for stage in range(SHOT):
            unknowns, cost, _ = descended(case, unknowns, stage)
        pool.append((cost, number, unknowns))
    best, kept, taken = math.inf, 0, []
    for _, _, unknowns in sorted(pool, key=lambda each: each[:2]):
        if len(taken) == FINALISTS:
            break
        for stage in range(SHOT, GO_ON):
            unknowns, _, _ = descended(case, unknowns, stage)
        path = path_of(case, unknowns)
        if any(np.abs(path - other).max() < APART for other in taken):
            continue
        taken.append(path)
        found = descended_linearly(case, path, best)
        if found is not None and not verify(case.time, found.path, case.rig).violations:
            kept += 1
            best = min(best, found.tolerance)
    return Reference(best, kept)
