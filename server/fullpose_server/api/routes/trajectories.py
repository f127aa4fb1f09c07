"""Trajectories: uploaded as a file (CSV, Parquet) or as JSON columns, checked, stored by their hash."""

import asyncio
import shutil
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated
from uuid import uuid4

from fastapi import APIRouter, Query, Request, Response
from pydantic import TypeAdapter
from starlette.responses import FileResponse

from fullpose_server.api.answer_file import answered
from fullpose_server.api.changes import CHANGE
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.labels import WantedDep, changed
from fullpose_server.api.offload.work import DiagnoseRequest, ReadRequest, ToleranceRequest, Work
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.paging import LINKED, PageDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.reading import READING_FIELDS, reading_options
from fullpose_server.api.schemas.base import Name, Notice
from fullpose_server.api.schemas.diagnosis import DiagnosisOut
from fullpose_server.api.schemas.labels import LabelsIn
from fullpose_server.api.schemas.trajectories import ToleranceEffect, TrajectoryOut, TrajectoryPreview
from fullpose_server.api.thinned import thinned_flight
from fullpose_server.api.uploads import FORM, announced, receive_body, receive_form
from fullpose_server.errors import InUseError
from fullpose_server.formats.flight_folder import FlightFacts, read_arrays
from fullpose_server.store.keyset import Key
from fullpose_server.store.tables import TrajectoryRow

router = APIRouter(prefix="/trajectories", tags=["trajectories"])

_LIST = TypeAdapter(list[TrajectoryOut])
_FORM = {
    "type": "object",
    "required": ["file"],
    "properties": {
        "file": {"type": "string", "format": "binary", "description": "A log with one attitude"},
        "name": {"type": "string", "description": "Default: the file's name"},
        **READING_FIELDS,
    },
}
UPLOAD_BODY = {
    "requestBody": {
        "required": True,
        "content": {
            FORM: {"schema": _FORM},
            "application/json": {"schema": {"$ref": "#/components/schemas/TrajectoryIn"}},
        },
    }
}


@router.post(
    "",
    status_code=201,
    openapi_extra=UPLOAD_BODY,
    dependencies=CHANGE,
    responses={
        200: {"model": TrajectoryOut, "description": "The very same flight is stored already"},
        415: {"description": "Neither a form nor JSON"},
        **BUSY,
    },
)
async def add_trajectory(request: Request, response: Response, services: ServicesDep) -> TrajectoryOut:
    """Upload a flight. Refused as a whole where anything in it is wrong; the problem names line and column."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    settings = services.settings
    services.disk.check(announced(request))
    source = services.uploads / uuid4().hex
    folder = await asyncio.to_thread(services.trajectories.draft)
    try:
        if kind == FORM:
            upload = await receive_form(request, source, settings.max_upload_bytes)
            file = upload.filename or "upload"
            asked = _read_request(services, source, folder)
            asked = replace(asked, file=file, how=reading_options(upload.fields, services.profiles))
            made = await services.offload.run(Work.READ_FILE, asked.to_json())
            name = upload.fields.get("name", "").strip() or Path(file).stem or file
        elif kind == "application/json":
            upload = await receive_body(request, source, settings.max_json_bytes)
            made = await services.offload.run(Work.READ_JSON, _read_request(services, source, folder).to_json())
            name = made["name"]
        else:
            raise ApiError(415, "media-type", f"{kind or 'no content type'}: expected multipart/form-data or JSON")
        facts = FlightFacts.from_json(made["facts"])
        row, new = await asyncio.to_thread(
            services.trajectories.adopt, folder, facts, name[:200], source, upload.sha256, made["format"]
        )
    finally:
        await asyncio.to_thread(_clear, source, folder)
    response.status_code = 201 if new else 200
    response.headers["Location"] = f"{request.url.path}/{row.sha256}"
    return _out(row)


def _read_request(services: Services, source: Path, folder: Path) -> ReadRequest:
    settings = services.settings
    return ReadRequest(
        str(source), str(folder), settings.max_upload_rows, settings.max_upload_columns, settings.max_upload_bytes
    )


def _clear(source: Path, folder: Path) -> None:
    source.unlink(missing_ok=True)
    shutil.rmtree(folder, ignore_errors=True)


@router.get("", response_model=list[TrajectoryOut], responses=LINKED)
def list_trajectories(request: Request, services: ServicesDep, page: PageDep, wanted: WantedDep) -> Response:
    """Flights, newest first, a page at a time; all, or those that are searched for."""
    found = services.trajectories.all(page.before, page.wanted, wanted)
    rows = page.cut(found)
    last = Key(rows[-1].created, rows[-1].sha256) if rows else None
    return page.answer(request, _LIST.dump_json([_out(row) for row in rows]), len(found), last)


@router.get("/{sha256}")
def get_trajectory(sha256: str, services: ServicesDep) -> TrajectoryOut:
    """One flight."""
    return _out(services.trajectories.get(sha256))


@router.patch("/{sha256}", dependencies=CHANGE)
def label_trajectory(sha256: str, body: LabelsIn, services: ServicesDep) -> TrajectoryOut:
    """Put tags and notes to a flight, which stays what it is."""
    row = services.trajectories.get(sha256)
    return _out(services.trajectories.label(sha256, changed(body, row.tags, row.notes)))


@router.get("/{sha256}/preview")
def preview_trajectory(
    sha256: str, services: ServicesDep, points: Annotated[int, Query(ge=2, le=20_000)] = 1000
) -> TrajectoryPreview:
    """The flight thinned to about `points` samples, for plots."""
    row = services.trajectories.get(sha256)
    time_s, q = read_arrays(services.trajectories.folder(sha256), row.samples)
    shown = thinned_flight(time_s, q, points)
    return TrajectoryPreview.model_construct(sha256=sha256, samples=int(time_s.size), **shown)


@router.get("/{sha256}/tolerance", responses=BUSY)
async def tolerance_of_trajectory(
    sha256: str,
    services: ServicesDep,
    tolerance_deg: Annotated[float | None, Query(gt=0.0, le=90.0)] = None,
    points: Annotated[int, Query(ge=2, le=20_000)] = 1000,
) -> ToleranceEffect:
    """What a tolerance does to the flight: deviation and body accelerations. Without one, the one that is suggested."""
    await asyncio.to_thread(services.trajectories.get, sha256)
    folder = str(services.trajectories.folder(sha256))
    made = await services.offload.run(Work.TOLERANCE, ToleranceRequest(folder, tolerance_deg, points).to_json())
    return ToleranceEffect.model_validate(made)


@router.get("/{sha256}/diagnosis", response_model=DiagnosisOut, responses=BUSY)
async def diagnose_trajectory(sha256: str, services: ServicesDep, rig: Name | None = None) -> FileResponse:
    """What the flight is made of and what is wrong with it: noise, rounding, holds, stamps, gaps, outliers, each with a
    figure; with `rig`, what the noise costs its frames.
    """
    row = await asyncio.to_thread(services.trajectories.get, sha256)
    answer = services.uploads / uuid4().hex
    folder = services.trajectories.folder(sha256)
    asked = DiagnoseRequest(str(folder), row.samples, str(answer), str(services.rigs.folder), rig)
    return await answered(services, Work.DIAGNOSE, asked, answer)


@router.delete(
    "/{sha256}",
    status_code=204,
    responses={409: {"description": "A plan is made from it"}},
    dependencies=CHANGE,
)
def remove_trajectory(sha256: str, services: ServicesDep) -> None:
    """Remove a flight that no plan needs."""
    try:
        services.trajectories.remove(sha256)
    except InUseError as error:
        raise ApiError(409, "in-use", str(error)) from None


def _out(row: TrajectoryRow) -> TrajectoryOut:
    return TrajectoryOut.model_validate(
        {
            **{name: getattr(row, name) for name in TrajectoryOut.model_fields if hasattr(row, name)},
            "warnings": [Notice(**notice) for notice in row.warnings],
            "created_at": datetime.fromtimestamp(row.created, UTC),
        }
    )
