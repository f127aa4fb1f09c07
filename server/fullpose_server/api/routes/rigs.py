"""Rigs."""

import asyncio

from fastapi import APIRouter

from fullpose.rig import FRAMES
from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.schemas.rigs import FramesOut, PayloadOut, RigOut
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_document import frame_values
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
        FRAMES[index]: frame_values(limits) if index in rig.geometry.frames else None
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
            "scene": f"/scene/{rig.name}/",
        }
    )
