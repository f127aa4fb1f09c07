"""Trajectories: uploaded as a file (CSV, Parquet) or as JSON columns, checked, stored by their hash."""

import asyncio
import hashlib
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any
from uuid import uuid4

import numpy as np
from fastapi import APIRouter, Query, Request, Response
from pydantic import ValidationError

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.problems import ApiError, validation_problem
from fullpose_server.api.schemas.base import Notice
from fullpose_server.api.schemas.trajectories import TrajectoryIn, TrajectoryOut, TrajectoryPreview
from fullpose_server.api.uploads import Upload, receive, too_large
from fullpose_server.errors import InUseError
from fullpose_server.formats.trajectory import Convention, Trajectory, euler_deg, from_columns
from fullpose_server.formats.trajectory_file import read_trajectory, source_format
from fullpose_server.pages.thin import thin
from fullpose_server.store.tables import TrajectoryRow

router = APIRouter(prefix="/trajectories", tags=["trajectories"])

_FORM = {
    "type": "object",
    "required": ["file"],
    "properties": {
        "file": {"type": "string", "format": "binary", "description": "CSV or Parquet"},
        "name": {"type": "string", "description": "Default: the file's name"},
        "convention": {"type": "string", "enum": [c.value for c in Convention], "default": Convention.NUE.value},
    },
}
UPLOAD_BODY = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {"schema": _FORM},
            "application/json": {"schema": {"$ref": "#/components/schemas/TrajectoryIn"}},
        },
    }
}


@router.post(
    "",
    status_code=201,
    openapi_extra=UPLOAD_BODY,
    responses={200: {"model": TrajectoryOut, "description": "The very same flight is stored already"}},
)
async def add_trajectory(request: Request, response: Response, services: ServicesDep) -> TrajectoryOut:
    """Upload a flight. Refused as a whole where anything in it is wrong; the problem names line and column."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    folder = services.settings.data_dir / "uploads"
    folder.mkdir(parents=True, exist_ok=True)
    draft = folder / uuid4().hex
    try:
        if kind == "multipart/form-data":
            upload = await receive(request, draft, services.settings.max_upload_bytes)
            row, new = await asyncio.to_thread(_store_file, services, upload, draft)
        elif kind == "application/json":
            body = await _json(request, services.settings.max_upload_bytes)
            row, new = await asyncio.to_thread(_store_json, services, body, draft)
        else:
            raise ApiError(415, "media-type", f"{kind or 'no content type'}: expected multipart/form-data or JSON")
    finally:
        draft.unlink(missing_ok=True)
    response.status_code = 201 if new else 200
    response.headers["Location"] = f"{request.url.path}/{row.sha256}"
    return _out(row)


@router.get("")
def list_trajectories(services: ServicesDep) -> list[TrajectoryOut]:
    """All flights, newest first."""
    return [_out(row) for row in services.trajectories.all()]


@router.get("/{sha256}")
def get_trajectory(sha256: str, services: ServicesDep) -> TrajectoryOut:
    """One flight."""
    return _out(services.trajectories.get(sha256))


@router.get("/{sha256}/preview")
def preview_trajectory(
    sha256: str, services: ServicesDep, points: Annotated[int, Query(ge=2, le=20_000)] = 1000
) -> TrajectoryPreview:
    """The flight thinned to about `points` samples, for plots."""
    time_s, q = services.trajectories.arrays(sha256)
    euler = euler_deg(q)  # of all samples: between those that are kept, whole turns may be
    rows = thin(time_s.size, points, euler)
    yaw, pitch, roll = euler[rows].T
    return TrajectoryPreview.model_construct(
        sha256=sha256,
        samples=int(time_s.size),
        time_s=time_s[rows].tolist(),
        yaw_deg=yaw.tolist(),
        pitch_deg=pitch.tolist(),
        roll_deg=roll.tolist(),
        q=[tuple(row) for row in q[rows].tolist()],
    )


@router.delete("/{sha256}", status_code=204, responses={409: {"description": "A plan is made from it"}})
def remove_trajectory(sha256: str, services: ServicesDep) -> None:
    """Remove a flight that no plan needs."""
    try:
        services.trajectories.remove(sha256)
    except InUseError as error:
        raise ApiError(409, "in-use", str(error)) from None


def _store_file(services: Services, upload: Upload, draft: Path) -> tuple[TrajectoryRow, bool]:
    file = upload.filename or "upload"
    trajectory = read_trajectory(draft, _convention(upload.fields.get("convention")), file)
    name = upload.fields.get("name", "").strip() or Path(file).stem or file
    kind = source_format(draft)
    return services.trajectories.add(trajectory, name[:200], draft, upload.sha256, kind)


def _store_json(services: Services, body: bytes, draft: Path) -> tuple[TrajectoryRow, bool]:
    try:
        model = TrajectoryIn.model_validate_json(body)
    except ValidationError as error:
        found = validation_problem(error.errors(include_url=False))
        raise ApiError(422, "validation", found.detail, errors=found.errors) from None
    columns = {name: np.array(values) for name, values in model.columns().items()}
    trajectory = _from_json(columns, Convention(model.convention), model.name)
    draft.write_bytes(body)
    return services.trajectories.add(trajectory, model.name, draft, hashlib.sha256(body).hexdigest(), "json")


def _from_json(columns: dict[str, Any], convention: Convention, name: str) -> Trajectory:
    return from_columns(columns, convention, name, lambda row: row, unit="sample")


async def _json(request: Request, limit: int) -> bytes:
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > limit:
            raise too_large(limit)
    return bytes(body)


def _convention(text: str | None) -> Convention:
    if text is None or not text.strip():
        return Convention.NUE
    try:
        return Convention(text.strip())
    except ValueError:
        known = ", ".join(c.value for c in Convention)
        raise ApiError(422, "validation", f"convention: {text.strip()[:40]!r}: expected one of {known}") from None


def _out(row: TrajectoryRow) -> TrajectoryOut:
    return TrajectoryOut.model_validate(
        {
            **{name: getattr(row, name) for name in TrajectoryOut.model_fields if hasattr(row, name)},
            "warnings": [Notice(**notice) for notice in row.warnings],
            "created_at": datetime.fromtimestamp(row.created, UTC),
        }
    )
