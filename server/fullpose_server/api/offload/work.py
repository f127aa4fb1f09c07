"""What the offload process does: one upload made into a flight's arrays, one batch solved. Files in, files out.

Nothing of what a client sends is parsed in the server's own process: neither its memory nor its event loop is at stake.
"""

import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from fullpose.rig import Rig
from fullpose_server.api.attitudes import attitudes, limited_list
from fullpose_server.api.known_errors import known_problem
from fullpose_server.api.problems import ApiError, validation_problem
from fullpose_server.api.schemas.plans import ReportOut
from fullpose_server.api.schemas.solve import SolveIn, SolveOut
from fullpose_server.api.schemas.trajectories import ReadingPreview, TrajectoryIn
from fullpose_server.formats.flight_folder import read_arrays, write_flight
from fullpose_server.formats.importers.columns import Bounds, check_rows
from fullpose_server.formats.importers.table import table_of
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.formats.trajectory_file import flight_in, read_trajectory
from fullpose_server.planning.worker import Maker, Progress


class Work(StrEnum):
    """What can be asked for."""

    READ_FILE = "read_file"
    READ_JSON = "read_json"
    PREVIEW = "preview"
    SOLVE = "solve"
    TOLERANCE = "tolerance"
    DIAGNOSE = "diagnose"
    PLANE = "plane"
    PREWARM = "prewarm"  # nothing is made: what a diagnosis needs is compiled, or loaded


@dataclass(frozen=True)
class Request:
    """What the process is told of one piece of work."""

    def to_json(self) -> dict[str, Any]:
        """Values for `json`."""
        return asdict(self)


@dataclass(frozen=True)
class ReadRequest(Request):
    """An upload: where it is, what it is called, where its arrays go, and how many of them it may have."""

    source: str
    folder: str
    rows: int
    columns: int
    bytes: int = 0  # that a packed file may unpack to
    file: str = ""
    how: dict[str, Any] = field(default_factory=dict)  # the fields of `ReadOptions`

    @property
    def bounds(self) -> Bounds:
        """How much of it is read."""
        return Bounds(self.rows, self.columns, self.bytes)

    @property
    def options(self) -> ReadOptions:
        """How it is to be read."""
        convention = self.how.get("convention")
        return ReadOptions(**{**self.how, "convention": None if convention is None else Convention(convention)})


@dataclass(frozen=True)
class PreviewRequest(ReadRequest):
    """An upload that is looked at and not stored: `folder` is where the answer goes."""

    points: int = 0
    profiles: str = ""  # the folder of those that people have saved


@dataclass(frozen=True)
class SolveRequest(Request):
    """A batch: where its body is, where the answer goes, where the rigs are, and how many samples it may have."""

    body: str
    answer: str
    rigs: str
    samples: int


@dataclass(frozen=True)
class ToleranceRequest(Request):
    """What a tolerance does to a flight: the folder of its arrays, the tolerance or None for what is suggested."""

    folder: str
    tolerance_deg: float | None
    points: int


@dataclass(frozen=True)
class DiagnoseRequest(Request):
    """A stored flight: its folder and samples, where the answer goes, where the rigs are, and which one, if any."""

    folder: str
    samples: int
    answer: str
    rigs: str
    rig: str | None


@dataclass(frozen=True)
class PlaneRequest(Request):
    """A stored plan: its folder, where the answer goes, where the rigs are, which one, and the size of the map."""

    folder: str
    answer: str
    rigs: str
    rig: str
    columns: int
    rows: int


def _read_file(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    asked = ReadRequest(**values)
    flight = read_trajectory(Path(asked.source), name=asked.file, bounds=asked.bounds, options=asked.options)
    return _written(asked, flight, "")


def _preview(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    from fullpose_server.api.offload.reading import reading_preview  # pages' thinning, for those who look first

    asked = PreviewRequest(**values)
    document = reading_preview(
        Path(asked.source), asked.file, asked.bounds, asked.options, asked.points, asked.profiles
    )
    Path(asked.folder).write_text(ReadingPreview.model_validate(document).model_dump_json(), encoding="utf-8")
    return {}


def _read_json(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    asked = ReadRequest(**values)
    try:
        model = TrajectoryIn.model_validate_json(Path(asked.source).read_bytes())
    except ValidationError as error:
        found = validation_problem(error.errors(include_url=False))
        raise ApiError(422, "validation", found.detail, errors=found.errors) from None
    check_rows(len(model.time_s), Bounds(asked.rows, asked.columns), model.name)
    columns = {name: np.array(column, dtype=np.float64) for name, column in model.columns().items()}
    table = replace(table_of(model.name, "json", columns, row_word="sample"), line_of=lambda row: row)
    return _written(
        asked, flight_in((table,), ReadOptions(Convention(model.convention), bridge_gaps=model.bridge_gaps)), model.name
    )


def _written(asked: ReadRequest, flight: Trajectory, name: str) -> dict[str, Any]:
    return {"facts": write_flight(Path(asked.folder), flight).to_json(), "format": flight.taken.format, "name": name}


def _solve(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    asked = SolveRequest(**values)
    try:
        body = SolveIn.model_validate_json(Path(asked.body).read_bytes())
    except ValidationError as error:
        located = [{**one, "loc": ("body", *one["loc"])} for one in error.errors(include_url=False)]
        found = validation_problem(located)
        raise ApiError(422, "validation", found.detail, errors=found.errors) from None
    if len(body.time_s) > asked.samples:
        told = f"{len(body.time_s)} samples: this server solves up to {asked.samples} at once"
        raise ApiError(413, "too-large", told)
    # Rig files have many models: a quarter of a second that an upload need not wait for.
    from fullpose_server.formats.rig_file import RigStore

    rig = RigStore(Path(asked.rigs)).get(body.rig).rig
    Path(asked.answer).write_text(_solved(body, rig).model_dump_json(), encoding="utf-8")
    return {}


def _solved(body: SolveIn, rig: Rig) -> SolveOut:
    # Numba and SciPy: a second that an upload need not wait for.
    from fullpose.registry import method_options
    from fullpose.solve import solve
    from fullpose.verify import verify
    from fullpose_server.formats.report import make_report
    from fullpose_server.formats.start_pose import start_pose

    at, C = attitudes(body)
    solution = solve(
        at,
        C,
        rig,
        method=body.method,
        options=method_options(body.method, dict(body.options)),
        start=None if body.start_deg is None else np.array(start_pose(body.start_deg, rig, "start_deg")),
        clock=time.perf_counter,
    )
    report = make_report(solution, verify(at, solution.angles, rig, C))
    return SolveOut.model_construct(
        time_s=body.time_s,
        angles_deg=[tuple(row) for row in np.rad2deg(solution.angles).tolist()],
        error_deg=np.rad2deg(solution.error).tolist(),
        limited=limited_list(solution.limited),
        report=ReportOut(**report),
    )


def _tolerance(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    # Numba and SciPy: a second that an upload need not wait for.
    from fullpose_server.api.offload.tolerance import tolerance_effect

    asked = ToleranceRequest(**values)
    return tolerance_effect(Path(asked.folder), asked.tolerance_deg, asked.points)


def _diagnose(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    # Numba and SciPy, as for a solve.
    from fullpose_server.api.schemas.diagnosis import DiagnosisOut
    from fullpose_server.formats.diagnosis import diagnosis_document
    from fullpose_server.formats.rig_file import RigStore

    asked = DiagnoseRequest(**values)
    rig = None if asked.rig is None else RigStore(Path(asked.rigs)).get(asked.rig).rig
    document = diagnosis_document(*read_arrays(Path(asked.folder), asked.samples), rig)
    Path(asked.answer).write_text(DiagnosisOut.model_validate(document).model_dump_json(), encoding="utf-8")
    return {}


def _plane(values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    # Numba and SciPy, as for a solve.
    from fullpose_server.api.offload.plane import plan_plane
    from fullpose_server.api.schemas.plane import PlaneOut
    from fullpose_server.formats.rig_file import RigStore

    asked = PlaneRequest(**values)
    rig = RigStore(Path(asked.rigs)).get(asked.rig).rig
    document = plan_plane(Path(asked.folder), rig, asked.columns, asked.rows)
    Path(asked.answer).write_text(PlaneOut.model_validate(document).model_dump_json(), encoding="utf-8")
    return {}


def _prewarm(_values: Mapping[str, Any], _progress: Progress) -> dict[str, Any]:
    from fullpose_server.api.offload.prewarm import prewarm

    prewarm()
    return {}


MAKERS: dict[str, Maker] = {
    Work.READ_FILE: _read_file,
    Work.READ_JSON: _read_json,
    Work.PREVIEW: _preview,
    Work.SOLVE: _solve,
    Work.TOLERANCE: _tolerance,
    Work.DIAGNOSE: _diagnose,
    Work.PLANE: _plane,
    Work.PREWARM: _prewarm,
}


def failure(error: Exception, bound: int) -> dict[str, Any]:
    """The problem document of what went wrong, for `json`; `bound`: the memory there was [bytes]."""
    if isinstance(error, (MemoryError, SystemError)):  # the latter: an error that there was no memory to tell
        error = memory_needed(bound)
    problem = known_problem(error)
    if problem is None:  # for the server to log
        return {"unexpected": f"{type(error).__name__}: {error}"}
    document: dict[str, Any] = json.loads(problem.model_dump_json())
    return document


def memory_needed(bound: int) -> ApiError:
    """413 for what takes more memory than there is for one request."""
    return ApiError(413, "memory", f"it unpacks to more than this server gives one request, {bound / 1e6:.0f} MB")
