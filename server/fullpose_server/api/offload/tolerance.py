"""What a tolerance does to a stored flight, before a rig is asked: deviation and body accelerations, for a slider."""

import math
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.recorded import Diagnosis, Smoothed, diagnose, effect_of, smooth
from fullpose.recorded.motion import Motion
from fullpose_server.formats.flight_folder import read_arrays
from fullpose_server.formats.tolerance_report import statement, tolerance_radians, tolerance_report
from fullpose_server.pages.thin import thin

MOST_KEPT = 4  # flights
LONGEST_KEPT = 200_000  # samples of one, or the bounded memory would go to what nobody asks about


def tolerance_effect(folder: Path, tolerance_deg: float | None, points: int) -> dict[str, Any]:
    """The values of a `ToleranceEffect`. Without a tolerance: the one that is suggested, where one is.

    Raises `InputError` for a tolerance that is none.
    """
    time_s, q = (np.array(column) for column in read_arrays(folder))
    attitude = dcm_from_quaternion(q)
    asked = None if tolerance_deg is None else tolerance_radians(tolerance_deg)
    smoothed = smooth(time_s, attitude, asked, diagnosis_of(folder) if len(time_s) <= LONGEST_KEPT else None)
    effect = effect_of(time_s, q, smoothed)
    told = tolerance_report(smoothed, tolerance_deg or 0.0)
    if tolerance_deg is None:
        told["tolerance_deg"] = told["suggested_tolerance_deg"]
    rows = thin(len(time_s), points, np.degrees(smoothed.deviation))
    return {
        **told,
        "samples": len(time_s),
        "needed": bool(smoothed.suggested) and effect.matters,
        "within_tolerance": smoothed.inside,
        "cut_off_hz": smoothed.cut_off_hz if math.isfinite(smoothed.cut_off_hz) else None,
        "smoothing": statement(smoothed),
        "recorded": _peaks(effect.recorded),
        "flown": _peaks(effect.flown),
        "time_s": _relative(smoothed)[rows].tolist(),
        "deviation_at_deg": np.degrees(smoothed.deviation)[rows].tolist(),
    }


@lru_cache(maxsize=MOST_KEPT)
def diagnosis_of(folder: Path) -> Diagnosis:
    """The flight's diagnosis, the same at every place of the slider; a flight's folder is named by its hash."""
    return diagnose(*read_arrays(folder))


def _relative(smoothed: Smoothed) -> Array:
    return np.asarray(smoothed.time - smoothed.time[0])


def _peaks(motion: Motion) -> dict[str, float]:
    return {
        "rate_deg_s": math.degrees(motion.rate.norm),
        "acceleration_deg_s2": math.degrees(motion.acceleration.norm),
    }
