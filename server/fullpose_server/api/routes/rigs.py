"""Rigs."""

import asyncio
import math

from fastapi import APIRouter

from fullpose.rig import FRAMES, FrameLimits
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.schemas.rigs import FrameOut, FramesOut, PayloadOut, RigOut
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_file import RigEntry

router = APIRouter(prefix="/rigs", tags=["rigs"])


@router.get("")
async def list_rigs(services: ServicesDep) -> list[RigOut]:
    """All rigs, the built-in ones first."""
    return [_rig(services, entry) for entry in await asyncio.to_thread(services.rigs.all)]


@router.get("/{rig}")
async def get_rig(rig: str, services: ServicesDep) -> RigOut:
    """One rig."""
    return _rig(services, await asyncio.to_thread(services.rigs.get, rig))


def _rig(services: Services, entry: RigEntry) -> RigOut:
    rig = entry.rig
    frames = {
        FRAMES[index]: _frame(limits) if index in rig.geometry.frames else None
        for index, limits in enumerate(rig.frames)
    }
    return RigOut.model_validate(
        {
            "name": rig.name,
            "geometry": rig.geometry.value,
            "redundant": rig.geometry.redundant,
            "builtin": entry.builtin,
            "rig_hash": rig_hash(rig),
            "frames": FramesOut.model_validate(frames),
            "payload": PayloadOut(size_m=entry.payload.size_m, mesh=entry.payload.mesh),
            "state": services.hosts.state(rig.name),
        }
    )


def _frame(limits: FrameLimits) -> FrameOut:
    def deg(value: float) -> float | None:
        return written_degrees(value) if math.isfinite(value) else None

    return FrameOut(
        min_deg=deg(limits.min),
        max_deg=deg(limits.max),
        max_rate_deg_s=deg(limits.max_rate),
        max_acceleration_deg_s2=deg(limits.max_acceleration),
        weight=limits.weight,
        home_deg=written_degrees(limits.home),
    )
