"""Plans and runs as files of other programs."""

import asyncio
from functools import partial
from typing import Annotated, Any

from fastapi import APIRouter, Query
from starlette.responses import FileResponse

from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.exports import exported
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.exports import ExportKindOut
from fullpose_server.formats.exporters.registry import EXPORTERS, ExportKind, check_installed, write_table
from fullpose_server.formats.plan_export import plan_table
from fullpose_server.planning.scrub import open_plan
from fullpose_server.runtime.recording.export import write_export
from fullpose_server.runtime.recording.mcap_reader import is_complete
from fullpose_server.store.jobs import JobStatus

router = APIRouter()
Format = Annotated[ExportKind, Query(alias="format")]
_FILE: dict[int | str, dict[str, Any]] = {200: {"content": {row.media_type: {} for row in EXPORTERS.values()}}}


@router.get("/exports", tags=["runs"])
def list_exports() -> list[ExportKindOut]:
    """The kinds of file that plans and runs are exported as, and which of them this server has the library for."""
    return [
        ExportKindOut(format=row.kind, label=row.label, available=row.available, install=row.install)
        for row in EXPORTERS.values()
    ]


@router.get("/runs/{run}/export", response_class=FileResponse, responses=_FILE, tags=["runs"])
async def export_run(run: str, services: ServicesDep, kind: Format = ExportKind.CSV) -> FileResponse:
    """The whole run as a file: every sample of the record; as MCAP always with an index, repaired where need be."""
    record = services.runs.path(run)
    if kind is ExportKind.MCAP and await asyncio.to_thread(is_complete, record):
        return FileResponse(record, media_type=EXPORTERS[kind].media_type, filename=record.name)
    return await exported(services, run, kind, partial(write_export, record, kind=kind))


@router.get(
    "/plans/{plan}/export",
    response_class=FileResponse,
    responses={**_FILE, 409: {"description": "The plan is not done"}},
    tags=["plans"],
)
async def export_plan(plan: str, services: ServicesDep, kind: Format = ExportKind.CSV) -> FileResponse:
    """The whole plan as a file: what is flown at the rig's rate, leads included, every sample."""
    row = await asyncio.to_thread(services.plans.get, plan)
    if row.status != JobStatus.DONE:
        raise ApiError(409, "not-done", f"plan {plan} is {row.status}: it has no samples")
    check_installed(kind, plan)
    made = await asyncio.to_thread(open_plan, plan, services.plans, services.quarantine)
    return await exported(
        services, plan, kind, lambda draft: write_table(plan_table(made), draft, kind, f"plan {plan}")
    )
