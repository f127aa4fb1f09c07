"""A solve as one HTML page that needs nothing else: frames against their limits, the error on a log axis, the plane of
time and base angle."""

import html
import json
import math
from importlib import resources
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.errors import SolverError
from fullpose.rig import FRAMES
from fullpose.solution import Solution
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.formats.plane_document import plane_document
from fullpose_server.formats.report import why_infeasible
from fullpose_server.pages.thin import thin

POINTS = 4000


def plot_page(solution: Solution, attitude: Array, report: dict[str, Any], name: str) -> str:
    """The page; `name` and attitude (n, 3, 3) are those of the flight that was solved."""
    angles = np.rad2deg(solution.angles)
    rates, accelerations = _derivatives(solution.time, angles)
    error = np.rad2deg(solution.error)
    rows = thin(solution.time.size, POINTS, angles, rates, accelerations, error)
    plots = [
        _plot("Angles", "deg", solution, angles[rows], lambda frame: (frame.min, frame.max)),
        _plot("Rates", "deg/s", solution, rates[rows], lambda frame: (-frame.max_rate, frame.max_rate)),
        _plot(
            "Accelerations",
            "deg/s²",
            solution,
            accelerations[rows],
            lambda frame: (-frame.max_acceleration, frame.max_acceleration),
        ),
        {
            "title": "Attitude error",
            "unit": "deg, geodesic",
            "log": True,
            "lines": [{"name": "error", "values": _values(error[rows]), "limits": []}],
        },
    ]
    frames = [FRAMES[index] for index in solution.rig.geometry.frames]
    data = json.dumps(
        {
            "time_s": solution.time[rows].tolist(),
            "frames": frames,
            "plots": plots,
            "plane": _plane(solution, attitude),
        }
    )
    page = resources.files("fullpose_server.pages").joinpath("plot_page.html").read_text(encoding="utf-8")
    title = html.escape(f"{name} on {report['rig']}, {report['method']}")
    # The data goes last: a name that holds a placeholder's text must not be replaced in turn.
    return (
        page.replace("__TITLE__", title)
        .replace("__SUMMARY__", _summary(report))
        .replace("__DATA__", data.replace("<", "\\u003c"))
    )


def _plane(solution: Solution, attitude: Array) -> dict[str, Any]:
    """The plane of time and base angle, or why there is none."""
    try:
        return plane_document(solution.time, attitude, solution.angles, solution.rig)
    except SolverError as refusal:
        return {"none": str(refusal)}


def _summary(report: dict[str, Any]) -> str:
    verdict = "inside every limit"
    why = why_infeasible(report)
    if why is not None:
        verdict = f'<span class="bad">not feasible: {html.escape(why)}</span>'
    return f"{report['samples']} samples, largest error {report['max_error_deg']:.3g} deg, {verdict}."


def _plot(title: str, unit: str, solution: Solution, table: Array, limits: Any) -> dict[str, Any]:
    lines = []
    for index in solution.rig.geometry.frames:
        bounds = [written_degrees(v) for v in limits(solution.rig.frames[index]) if math.isfinite(v)]
        lines.append({"name": FRAMES[index], "values": _values(table[:, index]), "limits": bounds})
    return {"title": title, "unit": unit, "log": False, "lines": lines}


def _values(column: Array) -> list[float | None]:
    return [float(f"{value:.7g}") if math.isfinite(value) else None for value in column.tolist()]


def _derivatives(time: Array, angles: Array) -> tuple[Array, Array]:
    if time.size < 3:
        return np.zeros_like(angles), np.zeros_like(angles)
    rates = np.gradient(angles, time, axis=0)
    return rates, np.gradient(rates, time, axis=0)
