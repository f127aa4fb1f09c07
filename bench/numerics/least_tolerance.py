"""The least tolerance against a slow reference of another kind: python -m bench.numerics.least_tolerance [options]

    python -m bench.numerics.least_tolerance --restarts 40 --json least_tolerance.json

60 flights of 2 to 2.5 s that cannot be flown, for eight causes (`bench.numerics.infeasible_flights`); the reference is
shooting from random starts (`bench.numerics.shooting`). Times are the processor's, [s]: of the plan that refuses the
flight without an answer, of the least tolerance, of the reference. `--cause` takes those of one cause, `--reference`
reads the tolerances of an earlier run's JSON in place of running it.
"""

import argparse
import json
import math
import time as clock
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

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
SMALL = 0.01  # [deg] and so does less than this beyond it


def measured(case: Case, restarts: int, known: dict[str, Any] | None) -> dict[str, Any]:
    """One row."""
    begin = clock.process_time()
    refused = plan(
        case.time, case.attitude, case.rig, case.start, case.start_rate, options=PlanOptions(best_effort=False)
    )
    planned = clock.process_time()
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
        "ours_deg": math.degrees(found.tolerance), "plan_s": planned - begin, "ours_s": answered - planned,
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


def met(row: dict[str, Any]) -> bool:
    """Whether a row is within the reference."""
    return bool(row["ours_deg"] <= max(WITHIN * row["reference_deg"], row["reference_deg"] + SMALL))


def printed(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows, each printed as it comes."""
    print("cause         flight        ours deg  reference deg  ratio  kept   plan s  ours s  reference s")
    every = []
    for row in rows:
        ratio = row["ours_deg"] / row["reference_deg"]
        print(
            f"{row['cause']:12}  {row['name']:12}  {row['ours_deg']:8.3f}  {row['reference_deg']:13.3f}  {ratio:5.3f}  "
            f"{row['reference_kept']:4}  {row['plan_s']:7.2f}  {row['ours_s']:6.2f}  {row['reference_s']:11.2f}"
            f"{'' if met(row) else '  missed'}{'  feasible' if row['feasible'] else ''}",
            flush=True,
        )
        every.append(row)
    return every


def main() -> None:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--restarts", type=int, default=40)
    parser.add_argument("--cause")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--reference", type=Path)
    asked = parser.parse_args()
    known = {}
    if asked.reference:
        known = {(r["cause"], r["name"]): r for r in json.loads(asked.reference.read_text())["rows"]}
    chosen = [case for case in cases() if asked.cause in (None, case.cause)]
    rows = printed(measured(case, asked.restarts, known.get((case.cause, case.name))) for case in chosen)
    told = [row for row in rows if not row["feasible"]]
    inside = sum(met(row) for row in told)
    better = sum(row["ours_deg"] < row["reference_deg"] / WITHIN for row in told)
    times = np.array([(row["plan_s"], row["ours_s"], row["reference_s"]) for row in told])
    print(
        f"{len(told)} infeasible flights: within 5 % of the reference {inside}, more than 5 % below {better}; limits "
        f"exceeded on {sum(row['violations'] > 0 for row in told)}. Median s: plan {np.median(times[:, 0]):.2f}, ours "
        f"{np.median(times[:, 1]):.2f}, reference {np.median(times[:, 2]):.2f}. {machine()}"
    )
    if asked.json:
        asked.json.write_text(json.dumps({"machine": machine(), "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
