"""The least tolerance against a slow reference of another kind: python -m bench.numerics.least_tolerance [options]

    python -m bench.numerics.least_tolerance --restarts 4 --json least_tolerance.json

60 flights of 2 to 2.5 s that cannot be flown, for eight causes (`bench.numerics.infeasible_flights`); the reference is
the best of dense dynamic programming over all frames and random starts, brought to the end by linear programmes
(`bench.numerics.least_reference`). Times are the processor's, [s]: of the search that refuses the flight without an
answer, of a plan of the same rig and length that is flown (the first third of the flight in the whole of its time), of
the least tolerance, of the reference. `--cause` takes those of one cause, `--every N` each N-th; `--reference` reads
the tolerances of an earlier run's JSON in place of running it.
"""

import argparse
import json
import math
import time as clock
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from bench.machine import machine
from bench.numerics.infeasible_flights import Case, cases
from bench.numerics.least_reference import reference
from fullpose.plan import PlanOptions, plan
from fullpose.plan.fallback import Fallback
from fullpose.plan.least_tolerance import least_tolerance
from fullpose.plan.three_axis import three_axis_path
from fullpose.trajectory.problem import Problem
from fullpose.verify import verify

WITHIN = 1.05  # of the reference counts as found
MOST = 10.0  # times a plan's time
SMALL = 0.01  # [deg] and so does less than this beyond it


def measured(case: Case, restarts: int, known: dict[str, Any] | None) -> dict[str, Any]:
    """One row."""
    begin = clock.process_time()
    refused = plan(
        case.time, case.attitude, case.rig, case.start, case.start_rate, options=PlanOptions(best_effort=False)
    )
    planned = clock.process_time()
    flown = flown_in(case)
    begin_ours = clock.process_time()
    problem = Problem(case.time, case.attitude, case.rig, start=case.start, start_rate=case.start_rate)
    if case.rig.geometry.redundant:
        path = Fallback(problem).exact
    else:
        path = three_axis_path(case.time, case.attitude, case.rig, None)
    found = least_tolerance(problem, [path])
    answered = clock.process_time()
    broken = len(verify(case.time, found.angles, case.rig).violations)
    row = {
        "cause": case.cause, "name": case.name, "feasible": refused.verdict.feasible, "violations": broken,
        "ours_deg": math.degrees(found.tolerance), "plan_s": planned - begin, "flown_s": flown,
        "ours_s": answered - begin_ours,
    }  # fmt: skip
    if known is not None:
        kept = {key: known[key] for key in ("reference_deg", "reference_kept", "reference_s")}
    else:
        other = reference(case, restarts)
        kept = {
            "reference_deg": math.degrees(other.tolerance), "reference_kept": other.kept,
            "reference_s": clock.process_time() - answered,
        }  # fmt: skip
    return row | kept


def flown_in(case: Case) -> float | None:
    """[s] that a plan of the flight's first third takes, flown in all of its time; None where that is not flown."""
    at = case.time[0] + (case.time - case.time[0]) / 3.0
    slow = Slerp(case.time, Rotation.from_matrix(case.attitude))(at).as_matrix()
    begin = clock.process_time()
    made = plan(case.time, slow, case.rig, options=PlanOptions(best_effort=False))
    return clock.process_time() - begin if made.verdict.feasible else None


def met(row: dict[str, Any]) -> bool:
    """Whether a row is within the reference."""
    return bool(row["ours_deg"] <= max(WITHIN * row["reference_deg"], row["reference_deg"] + SMALL))


def printed(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows, each printed as it comes."""
    print("cause         flight        ours deg  reference deg  ratio  kept  refusal s  flown s  ours s  reference s")
    every = []
    for row in rows:
        ratio = row["ours_deg"] / row["reference_deg"]
        print(
            f"{row['cause']:12}  {row['name']:12}  {row['ours_deg']:8.3f}  {row['reference_deg']:13.3f}  {ratio:5.3f}  "
            f"{row['reference_kept']:4}  {row['plan_s']:9.3f}  {row['flown_s'] or math.nan:7.3f}  "
            f"{row['ours_s']:6.2f}  {row['reference_s']:11.2f}"
            f"{'' if met(row) else '  missed'}{'  feasible' if row['feasible'] else ''}",
            flush=True,
        )
        every.append(row)
    return every


def summary(told: list[dict[str, Any]]) -> str:
    """Both ways: who is within 5 % of whom, and the times."""
    inside = sum(met(row) for row in told)
    better = sum(row["ours_deg"] < row["reference_deg"] / WITHIN - SMALL for row in told)
    flown = [row for row in told if row["flown_s"] is not None]
    quick = sum(row["ours_s"] <= MOST * row["flown_s"] for row in flown)
    refusals = sum(row["ours_s"] <= MOST * row["plan_s"] for row in told)
    times = np.array([(row["plan_s"], row["ours_s"], row["reference_s"]) for row in told])
    return (
        f"{len(told)} infeasible flights: within 5 % of the reference {inside}, more than 5 % below it {better}; "
        f"limits exceeded on {sum(row['violations'] > 0 for row in told)}. Within {MOST:g} times a plan that is flown: "
        f"{quick} of {len(flown)}; within {MOST:g} times the refusal: {refusals} of {len(told)}. Median s: refusal "
        f"{np.median(times[:, 0]):.3f}, ours {np.median(times[:, 1]):.2f}, reference {np.median(times[:, 2]):.2f}. "
        f"{machine()}"
    )


def main() -> None:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--restarts", type=int, default=4)
    parser.add_argument("--cause")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--reference", type=Path)
    asked = parser.parse_args()
    known = {}
    if asked.reference:
        known = {(r["cause"], r["name"]): r for r in json.loads(asked.reference.read_text())["rows"]}
    chosen = [case for case in cases() if asked.cause in (None, case.cause)][:: asked.every]
    measured(chosen[0], 1, {"reference_deg": 0.0, "reference_kept": 0, "reference_s": 0.0})  # kernels are compiled
    rows = printed(measured(case, asked.restarts, known.get((case.cause, case.name))) for case in chosen)
    print(summary([row for row in rows if not row["feasible"]]))
    if asked.json:
        asked.json.write_text(json.dumps({"machine": machine(), "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
