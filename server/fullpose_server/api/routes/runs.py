"""Recorded runs: list, detail, export."""

import asyncio
from datetime import UTC, datetime
from typing import Annotated, Literal
from uuid import uuid4

from fastapi import APIRouter, Query
from starlette.background import BackgroundTask
from starlette.responses import FileResponse

from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.schemas.records import RunOut
from fullpose_server.runtime.recording.export import write_export
from fullpose_server.runtime.recording.mcap_reader import is_complete
from fullpose_server.runtime.recording.run_index import RunSummary

router = APIRouter(prefix="/runs", tags=["runs"])
Format = Literal["csv", "parquet", "mcap"]
MEDIA_TYPES = {"csv": "text/csv", "parquet": "application/vnd.apache.parquet", "mcap": "application/octet-stream"}


@router.get("")
def list_runs(services: ServicesDep, rig: str | None = None) -> list[RunOut]:
    """All runs and incidents, newest first; a record that cannot be read is listed with its error."""
    return [_out(run) for run in services.runs.all(rig)]


@router.get("/{run}")
def get_run(run: str, services: ServicesDep) -> RunOut:
    """One run."""
    return _out(services.runs.get(run))


@router.get(
    "/{run}/export",
    response_class=FileResponse,
    responses={200: {"content": {kind: {} for kind in MEDIA_TYPES.values()}}},
)
async def export_run(
    run: str, services: ServicesDep, kind: Annotated[Format, Query(alias="format")] = "csv"
) -> FileResponse:
    """The whole run as a file: every sample of the record; as MCAP always with an index, repaired where need be."""
    record = services.runs.path(run)
    if kind == "mcap" and await asyncio.to_thread(is_complete, record):
        return FileResponse(record, media_type=MEDIA_TYPES[kind], filename=record.name)
    folder = services.settings.data_dir / "exports"
    folder.mkdir(exist_ok=True)
    draft = folder / uuid4().hex
    try:
        await asyncio.to_thread(write_export, record, draft, kind)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
    done = BackgroundTask(draft.unlink, missing_ok=True)
    return FileResponse(draft, media_type=MEDIA_TYPES[kind], filename=f"{run}.{kind}", background=done)


def _out(run: RunSummary) -> RunOut:
    return RunOut(
        id=run.id,
        rig=run.rig,
        incident=run.incident,
        error=run.error,
        plan_id=run.plan_id,
        plan_hash=run.plan_hash,
        who=run.who,
        started_at=_time(run.started),
        ended_at=_time(run.ended),
        duration_s=None if run.started is None or run.ended is None else run.ended - run.started,
        samples=run.samples,
        lost_samples=run.lost_samples,
        bytes=run.bytes,
        complete=run.complete,
        max_solve_error_deg=run.max_solve_error_deg,
        max_tracking_error_deg=run.max_tracking_error_deg,
        max_lateness_us=run.max_lateness_us,
    )


def _time(seconds: float | None) -> datetime | None:
    return None if seconds is None else datetime.fromtimestamp(seconds, UTC)
