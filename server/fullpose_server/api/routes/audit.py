"""The audit log."""

from datetime import UTC, datetime
from typing import Annotated

from fastapi import APIRouter, Query

from fullpose_server.api.deps import ServicesDep
from fullpose_server.api.schemas.base import Cursor
from fullpose_server.api.schemas.records import AuditOut

WRITTEN_S = 1.0
router = APIRouter(prefix="/audit", tags=["audit"])


@router.get("")
def list_audit(
    services: ServicesDep,
    rig: str | None = None,
    before: Annotated[Cursor | None, Query(description="Id to go on from, backward")] = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> list[AuditOut]:
    """Every command, accepted or refused, newest first."""
    services.trail.written(WRITTEN_S)  # what was done before is in it, unless nothing can be written
    return [
        AuditOut.model_validate(
            {
                **{name: getattr(row, name) for name in AuditOut.model_fields if name != "at"},
                "at": datetime.fromtimestamp(row.at, UTC),
            }
        )
        for row in services.audit.all(rig, before, limit)
    ]
