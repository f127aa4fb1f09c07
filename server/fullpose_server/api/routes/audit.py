"""The audit log."""

from datetime import UTC, datetime
from typing import Annotated

from fastapi import APIRouter, Query, Request
from pydantic import TypeAdapter
from starlette.responses import Response

from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.paging import LINKED, ROWS, listed
from fullpose_server.api.schemas.base import Cursor
from fullpose_server.api.schemas.records import AuditOut
from fullpose_server.store.tables import AuditRow

router = APIRouter(prefix="/audit", tags=["audit"])
_LIST = TypeAdapter(list[AuditOut])


@router.get("", response_model=list[AuditOut], responses=LINKED)
def list_audit(
    request: Request,
    services: ServicesDep,
    rig: str | None = None,
    before: Annotated[Cursor | None, Query(description="Id to go on from, backward")] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = ROWS,
) -> Response:
    """Every command and every change, accepted or refused, newest first, a page at a time."""
    services.trail.written()
    found = services.audit.all(rig, before, limit + 1)
    rows = found[:limit]
    more = str(rows[-1].id) if len(found) > limit else None
    return listed(request, _LIST.dump_json([_out(row) for row in rows]), more, limit)


def _out(row: AuditRow) -> AuditOut:
    values = {name: getattr(row, name) for name in AuditOut.model_fields}
    nobodys = {name: None for name in ("rig", "state_before", "state_after") if not values[name]}
    return AuditOut.model_validate({**values, **nobodys, "at": datetime.fromtimestamp(row.at, UTC)})
