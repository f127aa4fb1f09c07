"""The report of a comparison: each method's report of a solve and what sets it apart. Degrees and seconds."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fullpose.compare import EXACT_WITHIN, Failure, Figures, Row
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose_server.formats.report import make_report, verdict_report, why_infeasible, why_not_exact

SCHEMA = "fullpose.comparison/1"


def comparison_report(
    rows: tuple[Row, ...], rig: Rig, flight: str, time: NDArray[np.float64], resampling: str | None
) -> dict[str, Any]:
    """The report as JSON-ready values (no nan, no infinity); time (n,) [s] of the samples that were solved,
    `resampling`: what was done to them first, if anything.

    Each method has a `label` of its own. One that does not apply to the rig has `refusal` and none of the figures.
    """
    return {
        "schema": SCHEMA,
        "flight": flight,
        "rig": rig.name,
        "geometry": rig.geometry.value,
        "samples": int(time.size),
        "duration_s": float(time[-1] - time[0]),
        "resampling": resampling,
        "exact_within_deg": math.degrees(EXACT_WITHIN),
        "methods": [_method(row, rig) for row in rows],
    }


def _method(row: Row, rig: Rig) -> dict[str, Any]:
    head: dict[str, Any] = {
        "label": row.variant.label,
        "method": row.variant.method,
        "options": dict(row.variant.options),
        "source": row.source,
        "claims_limits": row.claims_limits,
        "refusal": row.refusal,
    }
    if row.solution is None or row.verification is None or row.figures is None:
        return head
    report = make_report(row.solution, row.verification)
    told = report if row.plan is None else report | verdict_report(row.plan)
    return {
        **head,
        **report,
        **_figures(row.figures, rig),
        "why": why_infeasible(told) or why_not_exact(told),
        "how_sure": None if row.plan is None else row.plan.verdict.how_sure,
    }


def _figures(figures: Figures, rig: Rig) -> dict[str, Any]:
    frames = [(index, FRAMES[index]) for index in rig.geometry.frames]
    return {
        "exact_share": figures.exact_share,
        "rms_error_deg": _degrees(figures.rms_error),
        "limit_violation_counts": {
            name: {limit: int(figures.violations[index, k]) for k, limit in enumerate(LIMITS)} for index, name in frames
        },
        "total_variation_deg": {name: _degrees(figures.total_variation[index]) for index, name in frames},
        "failures": [_failure(failure) for failure in figures.failures],
    }


def _failure(failure: Failure) -> dict[str, Any]:
    return {
        "reason": failure.reason,
        "samples": failure.samples,
        "first_s": failure.first,
        "max_error_deg": _degrees(failure.max_error),
    }


def _degrees(value: float) -> float | None:
    return math.degrees(value) if math.isfinite(value) else None
