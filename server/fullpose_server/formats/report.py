"""The report of a solve: what DESIGN's contract names, from a solution and its verification. Degrees and seconds."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fullpose.bounds import limited_name
from fullpose.compare import EXACT_WITHIN
from fullpose.rig import FRAMES, Rig
from fullpose.solution import Blocking, Solution
from fullpose.verify import Verification
from fullpose_server.formats.reason_text import UNITS, reason_report

if TYPE_CHECKING:
    from fullpose.plan import Plan  # the planner is heavy; who has a plan or margins has loaded it
    from fullpose.plan.verdict import Margins

# A report is read by people and sent over the wire: the list of violations is cut, their number is not.
MOST_VIOLATIONS = 1000


def make_report(solution: Solution, verification: Verification) -> dict[str, Any]:
    """The report as JSON-ready values (no nan, no infinity). `feasible`: inside every limit, nothing limited.

    `feasible` does not say that the attitude is met: a method that knows no limits, or that drifts, may miss it with
    nothing limited. `exact_samples` does.
    """
    exact = int(np.count_nonzero(solution.error <= EXACT_WITHIN))
    steps = solution.step_time[np.isfinite(solution.step_time)]
    blocking = solution.blocking
    return {
        "method": solution.method,
        "rig": solution.rig.name,
        "samples": int(solution.time.size),
        "feasible": blocking is None and not solution.limited_samples and not verification.violations,
        "exact_samples": exact,
        "exact_percent": exact_percent(exact, int(solution.time.size)),
        "max_error_deg": _finite(math.degrees(verification.max_error)),
        "max_matrix_error": _finite(verification.max_matrix_error),
        "iterations": {"median": float(np.median(solution.iterations)), "max": int(np.max(solution.iterations))},
        "step_us": {"median": float(np.median(steps) * 1e6), "p99": float(np.percentile(steps, 99) * 1e6)}
        if steps.size
        else None,
        "solve_s": _finite(solution.solve_time),
        "peak": {
            FRAMES[index]: {
                "position_deg": math.degrees(verification.peaks[index, 0]),
                "rate_deg_s": math.degrees(verification.peaks[index, 1]),
                "acceleration_deg_s2": math.degrees(verification.peaks[index, 2]),
                "jerk_deg_s3": math.degrees(verification.peaks[index, 3]),
                "jerk_percent": _percent(verification.peaks[index, 3], solution.rig.frames[index].max_jerk),
            }
            for index in solution.rig.geometry.frames
        },
        "limit_violations": [
            {
                "time_s": float(v.time),
                "frame": v.frame,
                "limit": v.limit,
                "value": math.degrees(v.value),
                "samples": v.samples,
            }
            for v in verification.violations[:MOST_VIOLATIONS]
        ],
        "limit_violation_samples": sum(v.samples for v in verification.violations),
        "limited_samples": solution.limited_samples,
        "limited_by": _limited_by(solution),
        "blocking": _blocking(blocking),
    }


def _blocking(blocking: Blocking | None) -> dict[str, Any] | None:
    if blocking is None:
        return None
    return {"time_s": float(blocking.time), "frame": blocking.frame, "limit": blocking.limit}


def exact_percent(exact: int, samples: int) -> float:
    """Per cent of the samples, in hundredths rounded down: never more than is so, and 100 only of all."""
    return exact * 10_000 // samples / 100


def exact_text(report: dict[str, Any]) -> str:
    """The share of exact samples as every table has it: "100 %", "99.99 %", "< 0.01 %", "0 %"."""
    percent: float = report["exact_percent"]
    if report["exact_samples"] and not percent:
        return "< 0.01 %"
    return f"{percent:.0f} %" if percent in (0.0, 100.0) else f"{percent:.2f} %"


def verdict_report(plan: "Plan") -> dict[str, Any]:
    """`verdict`: what it rests on; `leads`: the ways from rest and to rest, or why there are none."""
    solution, verdict = plan.solution, plan.verdict
    first, last = (
        float(np.diff(ends)[0]) if len(ends) == 2 else 0.0 for ends in (solution.time[:2], solution.time[-2:])
    )
    return {
        "verdict": {
            "decided_by": verdict.decided_by,
            "statement": verdict.statement,
            **reason_report(verdict),
            "closed": _blocking(verdict.closed),
            "certainty": verdict.certainty,
            "how_sure": verdict.how_sure,
            "grid_deg": _finite(math.degrees(verdict.grid)),
            "least_tolerance_deg": _finite(math.degrees(verdict.least_tolerance)),
            "max_matrix_error_between_samples": _finite(verdict.between),
        },
        "leads": {
            "lead_in_s": len(plan.lead_in) * first,
            "lead_out_s": len(plan.lead_out) * last,
            "refusal": plan.lead_refusal or None,
        },
    }


def margins_report(margins: "Margins", rig: Rig) -> dict[str, Any]:
    """The smallest distance to each limit and to the singularity, and when; null where there is no limit."""
    kinds = {
        "position_deg": margins.position, "rate_deg_s": margins.rate, "acceleration_deg_s2": margins.acceleration,
        "jerk_deg_s3": margins.jerk,
    }  # fmt: skip

    def margin(value: float, when: float) -> dict[str, float] | None:
        return {"value": value, "time_s": when} if math.isfinite(value) else None

    rows: dict[str, Any] = {
        FRAMES[index]: {
            kind: margin(math.degrees(table[index, 0]), float(table[index, 1])) for kind, table in kinds.items()
        }
        for index in rig.geometry.frames
    }
    return rows | {"singularity": margin(*margins.singularity)}


def why_infeasible(report: dict[str, Any]) -> str | None:
    """In one sentence why a flight is not feasible; None where it is."""
    if report["feasible"]:
        return None
    blocking, violations = report["blocking"], report["limit_violations"]
    if (
        not report.get("within_tolerance", True)
        and blocking is None
        and not violations
        and not report["limited_samples"]
    ):
        return (
            f"it misses the attitude by up to {report['max_error_deg']:.3g} deg, more than the tolerance of "
            f"{report['tolerance_deg']:g} deg"
        )
    if blocking is not None and (told := report.get("verdict", {}).get("what_happens")) is not None:
        return str(told)
    if blocking is not None:
        limit = f"{blocking['limit']} limit of the {blocking['frame']} frame"
        return f"at {blocking['time_s']:.3f} s the {limit} closes the way"
    if report["limited_samples"]:
        first = report["limited_by"][0]
        return (
            f"{report['limited_samples']} of {report['samples']} samples miss the attitude (up to "
            f"{report['max_error_deg']:.3g} deg) because of limits, most of them the {first['limit']} limit of the "
            f"{first['frame']} frame"
        )
    first = violations[0]
    told = exceeds(first["time_s"], first["frame"], first["limit"], first["value"])
    return f"{told}; {report['limit_violation_samples']} such samples"


def exceeds(time_s: float, frame: str, limit: str, value: float) -> str:
    """That a frame is beyond a limit, and by which value [deg and seconds]."""
    return f"at {time_s:.3f} s the {frame} frame exceeds its {limit} limit ({value:.4g} {UNITS[limit]})"


def why_not_exact(report: dict[str, Any]) -> str | None:
    """In one sentence how far and how often a flight misses the attitude; None where every sample is exact."""
    missed = report["samples"] - report["exact_samples"]
    if not missed:
        return None
    return (
        f"{missed} of {report['samples']} samples miss the attitude by more than {math.degrees(EXACT_WITHIN):.0e} deg, "
        f"up to {report['max_error_deg']:.3g} deg"
    )


def _limited_by(solution: Solution) -> list[dict[str, Any]]:
    """How many samples each limit took, the most first."""
    codes, counts = np.unique(solution.limited[solution.limited > 0], return_counts=True)
    rows = []
    for code, count in sorted(zip(codes, counts, strict=True), key=lambda pair: -int(pair[1])):
        if name := limited_name(int(code)):
            rows.append({"frame": name[0], "limit": name[1], "samples": int(count)})
    return rows


def _percent(value: float, limit: float) -> float | None:
    """Of a limit; null where there is none."""
    return 100.0 * float(value) / limit if math.isfinite(limit) else None


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
