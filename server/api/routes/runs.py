"""Recorded runs: list, detail, export."""

from typing import Annotated, Literal

from fastapi import APIRouter, Query
from starlette.responses import FileResponse

from server.api.services import ServicesDep
from server.api.wire_records import RunOut

router = APIRouter(prefix="/runs", tags=["runs"])
Format = Literal["csv", "parquet", "mcap"]
MEDIA_TYPES = {"csv": "text/csv", "parquet": "application/vnd.apache.parquet", "mcap": "application/octet-stream"}


@router.get("")
def list_runs(services: ServicesDep, rig: str | None = None) -> list[RunOut]:
    """All runs, newest first."""
    raise NotImplementedError


@router.get("/{run}")
def get_run(run: str, services: ServicesDep) -> RunOut:
    """One run."""
    raise NotImplementedError


@router.get(
    "/{run}/export",
    response_class=FileResponse,
    responses={200: {"content": {kind: {} for kind in MEDIA_TYPES.values()}}},
)
async def export_run(
    run: str, services: ServicesDep, kind: Annotated[Format, Query(alias="format")] = "csv"
) -> FileResponse:
    """The whole run as a file."""
    raise NotImplementedError
