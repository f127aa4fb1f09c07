"""What a report says of a tolerance: what was asked for, what it took, what would be enough. Degrees and seconds."""

import math
from typing import Any

from numpy.typing import NDArray

from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import InputError
from fullpose.recorded import Smoothed, effect_of, smooth
from fullpose.recorded.tube import WIDEST, rounded_up

WIDEST_DEG = math.degrees(WIDEST)
HAIR = 1.02  # times a least tolerance that is suggested: the search for it may come to a hair more


def tolerance_radians(tolerance_deg: float, name: str = "tolerance_deg") -> float:
    """The tolerance [rad]. Raises `InputError` where it is none."""
    if not 0.0 < tolerance_deg <= WIDEST_DEG:
        raise InputError(name, None, tolerance_deg, f"an angle above zero, at most {WIDEST_DEG:g} deg")
    return min(math.radians(tolerance_deg), WIDEST)


def tolerance_report(smoothed: Smoothed, tolerance_deg: float) -> dict[str, Any]:
    """The keys of a flight that is flown within a tolerance."""
    return {
        "tolerance_deg": tolerance_deg,
        "deviation_deg": {
            "max": math.degrees(smoothed.max_deviation),
            "rms": math.degrees(smoothed.rms_deviation),
        },
        **_suggestion(smoothed),
        "smoothing": statement(smoothed),
    }


def without_tolerance(time: NDArray[Any], q: NDArray[Any], report: dict[str, Any]) -> dict[str, Any]:
    """The keys of a flight that is flown as it is; a suggestion where it is refused or limited for its recording.

    time (n,) [s], q (n, 4), and the report so far.
    """
    none = {"tolerance_deg": None, "deviation_deg": None, "suggested_tolerance_deg": None, "tolerance_floor_deg": None}
    if report["feasible"]:
        return none
    smoothed = smooth(time, dcm_from_quaternion(q))
    if not smoothed.suggested or not effect_of(time, q, smoothed).matters:
        return none
    return none | _suggestion(smoothed)


def _suggestion(smoothed: Smoothed) -> dict[str, float | None]:
    return {
        "suggested_tolerance_deg": round(math.degrees(smoothed.suggested), 12) or None,
        "tolerance_floor_deg": math.degrees(smoothed.floor) or None,
    }


def judged(report: dict[str, Any]) -> dict[str, Any]:
    """The report of a flight within a tolerance: feasible where every sample is within it and inside every limit."""
    within = report["max_error_deg"] is not None and report["max_error_deg"] <= report["tolerance_deg"]
    return report | {"feasible": within and not report["limit_violations"], "within_tolerance": within}


def statement(smoothed: Smoothed) -> str:
    """What was done to the flight, in one sentence."""
    done = []
    if smoothed.largest_shift > 0.0:
        done.append(f"stamps moved by up to {1e3 * smoothed.largest_shift:.3g} ms, onto the clock that explains them")
    if held := smoothed.diagnosis.held.count:
        done.append(f"{held} held samples filled in")
    if math.isfinite(smoothed.cut_off_hz):
        done.append(
            f"what is faster than {smoothed.cut_off_hz:.3g} Hz taken away, up to "
            f"{math.degrees(smoothed.max_deviation):.3g} deg"
        )
    return "; ".join(done) or "nothing to take away"


def _enough(report: dict[str, Any]) -> float | None:
    """The least tolerance [deg] of a flight that is refused, with a hair more, in two digits; None: none is known."""
    least = report.get("verdict", {}).get("least_tolerance_deg")
    if report.get("feasible") or not least or least * HAIR > WIDEST_DEG:
        return None
    return min(WIDEST_DEG, math.degrees(rounded_up(math.radians(least * HAIR))))


def advice(report: dict[str, Any]) -> str | None:
    """The suggestion in one sentence; None where there is none."""
    if report.get("suggested_tolerance_deg") is None and (enough := _enough(report)) is not None:
        return f"a tolerance of {enough:g} deg is enough for every limit"
    suggested, floor = report.get("suggested_tolerance_deg"), report.get("tolerance_floor_deg")
    if suggested is None or (report.get("tolerance_deg") or 0.0) >= suggested:
        return None
    below = "" if floor is None else f", and below {floor:.2g} deg none helps"
    return f"a tolerance of {suggested:g} deg takes away what the recording added{below}"
