"""The rig's scene: a plan's pose beside the rig, while someone scrubs through it. Nothing moves but the picture."""

import asyncio
import math

import numpy as np
from fastapi import APIRouter

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.scene import ScenePoseIn, ScenePoseOut
from fullpose_server.planning.scrub import open_plan

router = APIRouter(prefix="/rigs/{rig}/scene", tags=["scene"])


@router.post("/pose", responses={409: {"description": "The plan is not done, or is another rig's"}})
async def show_pose(rig: str, services: ServicesDep, body: ScenePoseIn | None = None) -> ScenePoseOut | None:
    """Show an instant of a plan as a ghost beside the rig, to all who look; null takes it away. Needs no lease."""
    return await asyncio.to_thread(_show, services, rig, body)


def _show(services: Services, rig: str, wanted: ScenePoseIn | None) -> ScenePoseOut | None:
    services.rigs.get(rig)
    if wanted is None:
        services.scenes.show_pose(rig, None)
        return None
    row = services.plans.get(wanted.plan_id)
    if row.rig != rig:
        raise ApiError(409, "other-rig", f"plan {row.id} is for rig {row.rig}, not {rig}")
    if row.status != "done":
        raise ApiError(409, "not-done", f"plan {row.id} is {row.status}: it has no poses")
    plan = open_plan(row.id, services.plans, services.quarantine)
    index = round(wanted.time_s * plan.info.rate_hz) + plan.info.lead_in_samples
    if not 0 <= index < plan.info.samples:
        first = -plan.info.lead_in_samples / plan.info.rate_hz
        last = first + (plan.info.samples - 1) / plan.info.rate_hz
        raise ApiError(422, "validation", f"time_s = {wanted.time_s:.9g}: the plan is from {first:.9g} to {last:.9g} s")
    target = plan.target[index]
    known = bool(np.isfinite(target).all())
    services.scenes.show_pose(rig, np.array(plan.angles[index]), np.array(target) if known else None)
    a, b, c, d = np.rad2deg(plan.angles[index]).tolist()
    error = math.degrees(plan.error[index])
    return ScenePoseOut(
        plan_id=row.id,
        time_s=(index - plan.info.lead_in_samples) / plan.info.rate_hz,
        angles_deg=(a, b, c, d),
        q=tuple(target.tolist()) if known else None,
        error_deg=error if math.isfinite(error) else None,
    )
