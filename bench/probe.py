"""Times one tree from inside, and prints JSON: `bench.report` runs it in this tree and in the one to compare with.

    python -P bench/probe.py PACKAGE FLIGHT.csv [--methods exact,alm:mode=open_loop,...]

PACKAGE is the library's name in that tree, whose folder is in PYTHONPATH. It uses what both have: `solve` and its
clock, the rigs, a flight's file. Step times are the median over the flight of blocks of 16 samples; of each figure the
quickest of a few runs, which other work on the machine disturbs least.
"""

import argparse
import importlib
import json
import time
from typing import Any

import numpy as np

RATE_HZ = 1000.0
REPEATS = 5
PLAN_S = 10.0
SEEDS = (1, 2)


def tree(package: str) -> dict[str, Any]:
    """What is used of the library."""
    wanted = {
        "solve": ("solve",),
        "rig": ("builtin_rigs",),
        "attitude": ("dcm_from_quaternion", "quaternion_from_ned"),
        "resample": ("resample",),
        "scenarios": ("random_flight",),
    }
    return {
        name: getattr(importlib.import_module(f"{package}.{module}"), name)
        for module, names in wanted.items()
        for name in names
    }


def options(package: str, text: str) -> tuple[str, Any]:
    """(method, its options or None) of "alm:mode=open_loop", by the tree's own reader of options."""
    method, *given = text.split(":")
    if not given:
        return method, None
    for module in ("registry", "method_options"):
        try:
            read = importlib.import_module(f"{package}.{module}").method_options
        except (ImportError, AttributeError):
            continue
        return method, read(method, dict(pair.split("=") for pair in given))
    raise LookupError(f"{package} has no reader of {text!r}")


def step_times(package: str, ours: dict[str, Any], methods: list[str], path: str) -> dict[str, float]:
    """Microseconds of a step of each method that flies `path` on the vertical four-axis rig."""
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    flight = ours["resample"](rows[:, 0], ours["quaternion_from_ned"](rows[:, 1:5]), RATE_HZ)
    attitude = ours["dcm_from_quaternion"](flight.q)
    found = {}
    for text in methods:
        method, chosen = options(package, text)
        rig = ours["builtin_rigs"]()["vertical-3" if method == "three_axis" else "vertical-4"]
        best = np.inf
        for _ in range(REPEATS + 1):  # the first compiles
            made = ours["solve"](flight.time, attitude, rig, method, chosen, clock=time.perf_counter)
            best = min(best, float(np.nanmedian(made.step_time)))
        found[f"step of {text} [us]"] = best * 1e6
    return found


def plan_times(ours: dict[str, Any]) -> dict[str, float]:
    """Processor seconds of planning random flights of ten seconds at 1 kHz with an inner frame of +-60 deg."""
    rig = ours["builtin_rigs"]()["vertical-limited"]
    found = {}
    for seed in SEEDS:
        at, q = ours["random_flight"](seed, PLAN_S, RATE_HZ, np.radians(60.0))
        attitude, best = ours["dcm_from_quaternion"](q), np.inf
        for _ in range(REPEATS + 1):
            begin = time.process_time()
            ours["solve"](at, attitude, rig, "plan")
            best = min(best, time.process_time() - begin)
        found[f"plan of 10 s, seed {seed} [s]"] = best
    return found


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("package")
    parser.add_argument("flight")
    parser.add_argument("--methods", required=True)
    given = parser.parse_args()
    ours = tree(given.package)
    print(json.dumps(step_times(given.package, ours, given.methods.split(","), given.flight) | plan_times(ours)))


if __name__ == "__main__":
    main()
