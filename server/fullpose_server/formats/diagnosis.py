"""A diagnosis as values for JSON: the figures, the sentences, and the plots of it. Degrees and seconds."""

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.attitude import dcm_from_quaternion
from fullpose.recorded.diagnosis import Diagnosis, diagnose
from fullpose.recorded.divided_differences import residuals, window_starts
from fullpose.recorded.frame_noise import frame_noise_acceleration
from fullpose.recorded.motion import Peak
from fullpose.recorded.noise import ORDER
from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.diagnosis_sentences import OnRig, findings

MOST_LISTED = 100  # gaps, outliers and near-duplicates; their number is never cut
POSES = 60  # of a flight at which a rig's share of the noise is worked out
PLOT_POINTS = 1000
BINS = 41  # odd: no edge is at the middle, where even steps are
EVEN = 1e-6  # of the median step
_WINDOWS_A_POINT = 8


def diagnosis_report(time: Array, q: Array, rig: Rig | None = None) -> dict[str, Any]:
    """The diagnosis of the flight (time (n,) [s], q (n, 4)) as JSON-ready values, on a rig where one is given."""
    return _report(diagnose(time, q), q, rig)


def diagnosis_document(time: Array, q: Array, rig: Rig | None = None) -> dict[str, Any]:
    """The report and the plots of it."""
    found = diagnose(time, q)
    return {**_report(found, q, rig), "plots": diagnosis_plots(time, q, found.stamps.regular_time_s)}


def _report(found: Diagnosis, q: Array, rig: Rig | None) -> dict[str, Any]:
    on_rig = None if rig is None else noise_on_rig(found, q, rig)
    return {
        **_figures(found),
        "rig": None if on_rig is None else _rig_figures(on_rig),
        "findings": [asdict(each) for each in findings(found, on_rig)],
    }


def diagnosis_plots(time: Array, q: Array, regular_time: Array | None) -> dict[str, Any]:
    """The noise over time, the largest of each stretch, and how often each step occurs."""
    clock = time if regular_time is None else regular_time
    first = window_starts(len(q), ORDER, PLOT_POINTS * _WINDOWS_A_POINT)
    noise = np.degrees(residuals(clock, q, first, ORDER))
    rows = _largest_of_each(noise)
    columns = np.nan_to_num(noise[rows].T)
    counts, edges = _histogram(np.diff(time))
    return {
        "noise": {
            "time_s": time[first[rows] + ORDER // 2].tolist(),
            **{f"{axis}_deg": column.tolist() for axis, column in zip("xyz", columns, strict=True)},
        },
        "steps": {"edge_s": edges.tolist(), "count": counts.tolist()},
    }


def noise_on_rig(found: Diagnosis, q: Array, rig: Rig) -> OnRig:
    """What the flight's noise costs the frames of the rig, at exact poses along the flight."""
    some = q[np.unique(np.linspace(0, len(q) - 1, POSES).astype(np.int64))]
    angles = _poses(dcm_from_quaternion(some), rig)
    cost = frame_noise_acceleration(rig, angles, found.noise_acceleration_rad_s2)
    return OnRig(rig, np.median(cost, axis=0), cost.max(axis=0))


def _poses(attitude: Array, rig: Rig) -> Array:
    """The exact pose (m, 4) [rad] of each attitude (m, 3, 3) nearest to the one before, the first nearest to home."""
    from fullpose.methods.start_pose import start_pose  # kernels of a second or so, for one who names a rig
    from fullpose.solve import solve

    if not rig.geometry.redundant:
        return solve(np.arange(len(attitude), dtype=float), attitude, rig, method="three_axis").angles
    poses, near = np.empty((len(attitude), 4)), None
    for k, C in enumerate(attitude):
        poses[k], _ = start_pose(rig, C, near)
        near = poses[k]
    return poses


def _figures(d: Diagnosis) -> dict[str, Any]:
    held, stamps, quantum = d.held, d.stamps, d.quantum
    return {
        "samples": d.samples,
        "duration_s": d.duration_s,
        "step_s": {"median": d.median_step_s, "min": d.smallest_step_s, "max": d.largest_step_s},
        "white_noise_deg": np.degrees(d.white_noise_rad).tolist(),
        "noise_measured": d.noise_measured,
        "noise_acceleration_deg_s2": np.degrees(d.noise_acceleration_rad_s2).tolist(),
        "quantum": None
        if quantum.of is None
        else {"deg": math.degrees(quantum.rad), "unit": quantum.unit, "of": quantum.of.value},
        "held": {"samples": held.count, "length": held.length, "rate_hz": held.rate_hz} if held.count else None,
        "stamps": {
            "jitter_rms_s": stamps.jitter_rms_s,
            "jitter_max_s": stamps.jitter_max_s,
            "quantum_s": stamps.quantum_s,
            "regular_rate_hz": 1.0 / stamps.median_step_s if stamps.explained else None,
        },
        "near_duplicate_samples": int(d.near_duplicates.size),
        "near_duplicates": [{"sample": int(k), "time_s": float(d.time_s[k])} for k in d.near_duplicates[:MOST_LISTED]],
        "gap_count": len(d.gaps),
        "gaps": [{"start_s": g.start_s, "end_s": g.end_s, "steps": g.steps} for g in d.gaps[:MOST_LISTED]],
        "outlier_samples": int(d.outliers.sample.size),
        "outliers": [
            {"sample": int(k), "time_s": float(d.time_s[k]), "size_deg": math.degrees(size), "sigmas": float(sigmas)}
            for k, size, sigmas in zip(d.outliers.sample, d.outliers.size_rad, d.outliers.sigmas, strict=True)
        ][:MOST_LISTED],
        "body_rate_deg_s": _peak(d.body_rate),
        "body_acceleration_deg_s2": _peak(d.body_acceleration),
    }


def _peak(peak: Peak) -> dict[str, Any]:
    return {
        "max": math.degrees(peak.norm),
        "time_s": peak.norm_time_s,
        "axes": np.degrees(peak.value).tolist(),
        "axes_time_s": peak.time_s.tolist(),
    }


def _rig_figures(on_rig: OnRig) -> dict[str, Any]:
    def limit(value: float) -> float | None:
        return math.degrees(value) if math.isfinite(value) else None

    frames = on_rig.rig.frames
    return {
        "name": on_rig.rig.name,
        "frames": {
            FRAMES[i]: {
                "noise_acceleration_deg_s2": {
                    "median": math.degrees(on_rig.typical[i]),
                    "max": math.degrees(on_rig.largest[i]),
                },
                "max_rate_deg_s": limit(frames[i].max_rate),
                "max_acceleration_deg_s2": limit(frames[i].max_acceleration),
            }
            for i in on_rig.rig.geometry.frames
        },
    }


def _histogram(steps: Array) -> tuple[Integers, Array]:
    """How many steps are in each bin, and the bins' edges [s]; steps that differ by rounding alone are in one bin."""
    if not steps.size:
        return np.zeros(0, np.int64), np.zeros(0)
    low, high, median = float(steps.min()), float(steps.max()), float(np.median(steps))
    if high - low < EVEN * median:
        low, high = 0.5 * median, 1.5 * median
    counts, edges = np.histogram(steps, bins=BINS, range=(low, high))
    return counts.astype(np.int64), edges


def _largest_of_each(noise: Array) -> Array:
    """Of every few neighbouring rows of noise (m, 3) the one with the largest entry: outliers stay in the plot."""
    if not len(noise):
        return np.empty(0, np.int64)
    size = np.nan_to_num(np.abs(noise)).max(axis=1)
    begins = np.arange(0, len(size), _WINDOWS_A_POINT)
    return np.array([k + int(np.argmax(size[k : k + _WINDOWS_A_POINT])) for k in begins])
