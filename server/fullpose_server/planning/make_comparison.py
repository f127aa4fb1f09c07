"""One comparison from a flight: solved with each method, measured, reported, drawn."""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.compare import compare, variants
from fullpose.errors import MethodError
from fullpose.registry import Variant
from fullpose.resample import resample
from fullpose.rig import Rig
from fullpose_server.formats.compare_report import comparison_report
from fullpose_server.formats.flight_folder import read_arrays
from fullpose_server.formats.output_file import write_text
from fullpose_server.formats.tolerance_report import without_tolerance
from fullpose_server.pages.compare_page import compare_page
from fullpose_server.planning.compare_length import check_length, check_samples
from fullpose_server.planning.compare_request import PAGE, REPORT, read_request
from fullpose_server.planning.flown_within import Within, flown_within

Progress = Callable[[str, int, int], None]  # label, done, total


@dataclass(frozen=True)
class Comparison:
    """The report, JSON-ready, and the page."""

    report: dict[str, Any]
    page: str


def make_comparison(
    name: str,
    flight: Within,
    rig: Rig,
    methods: Sequence[str | Variant],
    start: Array | None = None,
    rate_hz: float | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """Compare `methods` on the flight `name`, as it is solved; start (4,) [rad]. Errors are to what was solved.

    With `rate_hz` the flight is first brought to that rate, as a plan is; else its own samples are solved.
    Raises `fullpose.errors.SolverError`: `InputError` for more samples than `compare_length` allows,
    `MethodError` where no method applies to the rig.
    """
    asked = variants(methods)
    at, q = flight.time, flight.q
    resampling = None
    if rate_hz is None:
        check_samples(at.size, len(asked))
    else:
        check_length(float(at[-1] - at[0]), rate_hz, len(asked))
        again = resample(at, q, rate_hz)
        at, q, resampling = again.time, again.q, again.sentence
    attitude = dcm_from_quaternion(q)
    rows = compare(at, attitude, rig, asked, start=start, clock=time.perf_counter, progress=progress)
    if all(row.refusal is not None for row in rows):
        reasons = "; ".join(f"{row.variant.label}: {row.refusal}" for row in rows)
        raise MethodError(f"no method that is asked for applies to {rig.name}: {reasons}")
    report = comparison_report(rows, rig, name, at, resampling)
    flown = any(method.get("feasible") for method in report["methods"])
    report |= flight.keys() or without_tolerance(flight.given_time, flight.given_q, {"feasible": flown})
    return Comparison(report, compare_page(report, rows, rig, attitude))


def make_comparison_folder(values: Mapping[str, str], report_progress: Progress) -> dict[str, str]:
    """Make the comparison that a job's folder asks for, and put report and page there.

    Raises as `make_comparison` does. The report is written last: a folder with a report is done.
    """
    folder = Path(values["folder"])
    request = read_request(folder)
    at, q = read_arrays(Path(request.trajectory))
    order = {variant.label: k for k, variant in enumerate(request.methods)}

    def progress(label: str, done: int, total: int) -> None:
        report_progress(label, order[label] * total + done, len(order) * total)

    start = None if request.start is None else np.array(request.start)
    told = flown_within(np.array(at), np.array(q), request.tolerance_deg)
    made = make_comparison(request.name, told, request.rig, request.methods, start, request.rate_hz, progress)
    write_text(folder / PAGE, made.page)
    write_text(folder / REPORT, json.dumps(made.report))
    return {}
