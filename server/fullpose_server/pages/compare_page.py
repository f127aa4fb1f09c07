"""A comparison as one HTML page that needs nothing else: a table of figures, and the plots of every method.

The plots are drawn as SVG by the page's own script, so that a method can be taken out and the axes follow, and each
figure can be saved as it stands.
"""

import html
import json
import math
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.attitude import euler_from_dcm
from fullpose.bounds import POSITION_TOLERANCE, TOLERANCE
from fullpose.compare import Row
from fullpose.rig import FRAMES, Rig
from fullpose.solution import Solution
from fullpose.verify import differences, jerks
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.pages.compare_table import metrics_table
from fullpose_server.pages.thin import thin

POINTS = 1200
FLIGHT_POINTS = 600
# Okabe and Ito's colours, told apart by the colour-blind; the second round is dashed.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
DASHES = ("", "6 3", "2 2")


def compare_page(report: dict[str, Any], rows: tuple[Row, ...], rig: Rig, attitude: Array) -> str:
    """The page of a comparison: its report, its rows, and the flight's attitude (n, 3, 3) body from reference."""
    methods = [
        _method(row.variant.label, row.solution, COLOURS[k % len(COLOURS)], DASHES[k // len(COLOURS) % len(DASHES)])
        for k, row in enumerate(rows)
        if row.solution is not None
    ]
    frames = rig.geometry.frames
    data = {
        "frames": [FRAMES[index] for index in frames],
        "limits": [_limits(rig, index) for index in frames],
        "flight": _flight(rows, attitude),
        "methods": methods,
    }
    page = resources.files("fullpose_server.pages").joinpath("compare_page.html").read_text(encoding="utf-8")
    # The data goes last: a name that holds a placeholder's text must not be replaced in turn.
    return (
        page.replace("__TITLE__", html.escape(f"{report['flight']} on {report['rig']}"))
        .replace("__SUMMARY__", html.escape(_summary(report)))
        .replace("__TABLE__", metrics_table(report, {m["name"]: (m["colour"], m["dash"]) for m in methods}))
        .replace("__DATA__", json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))
    )


def _summary(report: dict[str, Any]) -> str:
    parts = [f"{report['samples']} samples over {report['duration_s']:.6g} s", f"{report['geometry']} rig"]
    if report["resampling"]:
        parts.append(report["resampling"])
    return (
        "; ".join(parts)
        + f". A sample is exact where its attitude error is at most {report['exact_within_deg']:g} deg."
    )


def _limits(rig: Rig, index: int) -> dict[str, float | None]:
    frame = rig.frames[index]
    bounds = {"min": frame.min, "max": frame.max, "rate": frame.max_rate, "acceleration": frame.max_acceleration}
    return {name: written_degrees(value) if math.isfinite(value) else None for name, value in bounds.items()}


def _flight(rows: tuple[Row, ...], attitude: Array) -> dict[str, Any]:
    time = next((row.solution.time for row in rows if row.solution is not None), np.zeros(0))
    if not time.size:
        return {"t": [], "euler": [[], [], []]}
    euler = np.rad2deg(np.stack(euler_from_dcm(attitude), axis=-1))
    keep = thin(time.size, FLIGHT_POINTS, euler)
    return {"t": _values(time[keep]), "euler": [_values(column) for column in euler[keep].T]}


def _method(name: str, solution: Solution, colour: str, dash: str) -> dict[str, Any]:
    frames = list(solution.rig.geometry.frames)
    angles = np.rad2deg(solution.angles[:, frames])
    rates, accelerations = np.zeros_like(angles), np.zeros_like(angles)
    if solution.time.size > 1:
        rates[1:], accelerations[1:-1] = differences(solution.time, angles)
        rates[0] = rates[1]
    error = np.rad2deg(solution.error)
    keep = thin(solution.time.size, POINTS, angles, rates, accelerations, error)
    return {
        "name": name,
        "colour": colour,
        "dash": dash,
        "t": _values(solution.time[keep]),
        "angle": [_values(column) for column in angles[keep].T],
        "rate": [_values(column) for column in rates[keep].T],
        "acceleration": [_values(column) for column in accelerations[keep].T],
        "error": _values(error[keep]),
        "limited": _spans(solution.time, solution.limited > 0),
        "beyond": _spans(solution.time, beyond_limits(solution)),
    }


def beyond_limits(solution: Solution) -> NDArray[np.bool_]:
    """Which samples are beyond any limit, with the tolerances of `fullpose.verify`. (n,)"""
    rig, angles = solution.rig, solution.angles
    outside = np.maximum(rig.position_min - angles, angles - rig.position_max)
    beyond: NDArray[np.bool_] = np.any(outside > POSITION_TOLERANCE, axis=1)
    if len(angles) > 1:
        rates, accelerations = differences(solution.time, angles)
        beyond[1:] |= (np.abs(rates) > rig.max_rate * (1.0 + TOLERANCE)).any(axis=1)
        beyond[1:-1] |= (np.abs(accelerations) > rig.max_acceleration * (1.0 + TOLERANCE)).any(axis=1)
        if rig.jerk_limited and len(angles) > 3:
            beyond[2:-1] |= (np.abs(jerks(solution.time, accelerations)) > rig.max_jerk * (1.0 + TOLERANCE)).any(axis=1)
    return beyond


def _spans(time: Array, where: NDArray[np.bool_]) -> list[list[float]]:
    """[first, last] time of each run of true samples."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(np.int8)))
    return [[float(time[a]), float(time[b - 1])] for a, b in edges.reshape(-1, 2)]


def _values(column: Array) -> list[float | None]:
    return [float(f"{value:.6g}") if math.isfinite(value) else None for value in column.tolist()]
