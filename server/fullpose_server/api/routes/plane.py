"""A plan in the plane of time and base angle: how much of the limits a path can leave, on its way and beside it."""

import asyncio
from typing import Annotated, Any
from uuid import uuid4

from fastapi import APIRouter, Query, Response

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.offload.work import PlaneRequest, Work
from fullpose_server.api.openapi import BUSY
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.plane import PlaneOut
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.planning.scrub import open_plan
from fullpose_server.store.jobs import JobStatus
from fullpose_server.store.tables import PlanRow

router = APIRouter(tags=["plans"])
_NONE: dict[int | str, dict[str, Any]] = {
    409: {"description": "The plan is not done, its rig has three axes, or its rig is another by now"}
}


@router.get("/plans/{plan}/plane", response_model=PlaneOut, responses={**_NONE, **BUSY})
async def plan_plane(
    plan: str,
    services: ServicesDep,
    columns: Annotated[int, Query(ge=2, le=800)] = 400,
    rows: Annotated[int, Query(ge=2, le=400)] = 180,
) -> Response:
    """The plane of time and base angle of a plan: the share of the limits that a path can leave at most, the needles,
    the plan's own path and where it is tightest. Of a plan that is not feasible the map is the flight's.
    """
    row = await asyncio.to_thread(_checked, plan, services)
    info = (await asyncio.to_thread(open_plan, plan, services.plans, services.quarantine)).info
    key = f"{info.plan_hash}-{columns}-{rows}"
    body = services.planes.get(key)
    if body is None:
        body = await _made(row, services, columns, rows)
        services.planes.put(key, body)
    return Response(body, media_type="application/json")


def _checked(plan: str, services: Services) -> PlanRow:
    """The plan's row, where there is a map of it."""
    row = services.plans.get(plan)
    if row.status != JobStatus.DONE:
        raise ApiError(409, "not-done", f"plan {plan} is {row.status}: there is no map of it")
    rig = services.rigs.get(row.rig).rig
    if not rig.geometry.redundant:
        told = f"rig {row.rig} has three axes: an attitude leaves it no choice, so there is no plane of base angles"
        raise ApiError(409, "no-plane", told)
    if rig_hash(rig) != row.rig_hash:
        raise ApiError(
            409, "rig-changed", f"rig {row.rig} is another than plan {plan} was made for: make the plan again"
        )
    return row


async def _made(row: PlanRow, services: Services, columns: int, rows: int) -> bytes:
    answer = services.uploads / uuid4().hex
    folder = str(services.plans.folder(row.id))
    asked = PlaneRequest(folder, str(answer), str(services.rigs.folder), row.rig, columns, rows)
    try:
        await services.offload.run(Work.PLANE, asked.to_json())
        return await asyncio.to_thread(answer.read_bytes)
    finally:
        await asyncio.to_thread(answer.unlink, missing_ok=True)
