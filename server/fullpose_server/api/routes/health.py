"""Health for people and load balancers, metrics for Prometheus."""

import asyncio
import platform
import time
from typing import Literal

from fastapi import APIRouter, Request, Response

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.metrics import exposition
from fullpose_server.api.paths import API
from fullpose_server.api.schemas.people import AliveOut
from fullpose_server.api.schemas.records import DiskOut, HealthOut, ServerLimits, VersionOut
from fullpose_server.api.session_view import health_out
from fullpose_server.store.database import HEAD
from fullpose_server.version import VERSION

router = APIRouter(tags=["health"])
scraped = APIRouter()  # at the root, where Prometheus looks unless told otherwise


@router.get("/health")
async def health(services: ServicesDep) -> HealthOut:
    """How the server, its planner and its rigs do. Always 200: `status` and `warnings` say what is wrong."""
    settings = services.settings
    rigs = {host.name: health_out(host.snapshot().health) for host in services.hosts.all()}
    wrong = _wrong(services) + await asyncio.to_thread(_stored, services)
    return HealthOut(
        status="degraded" if wrong else "ok",
        version=VERSION,
        server_time=time.time(),
        uptime_s=time.time() - services.started,
        authenticated=services.people.admitted.people,
        planner=services.queue.status,
        limits=ServerLimits(max_upload_bytes=settings.max_upload_bytes, max_solve_samples=settings.max_solve_samples),
        disk=DiskOut(free_bytes=services.disk.free_bytes(), alarm_bytes=services.disk.alarm_bytes),
        rigs=rigs,
        warnings=wrong + _notes(services),
    )


@router.get("/alive")
async def alive(services: ServicesDep) -> AliveOut:
    """Whether the server answers, and does well: for who looks after it from outside, and need not sign in."""
    wrong = _wrong(services) + await asyncio.to_thread(_stored, services)
    return AliveOut(status="degraded" if wrong else "ok", dead=_dead(services))


@router.get("/version")
async def version() -> VersionOut:
    """What runs here, and what it speaks."""
    return VersionOut(version=VERSION, api=API, python=platform.python_version(), database_revision=HEAD)


@scraped.get("/metrics", include_in_schema=False)
@router.get("/metrics", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
async def metrics(request: Request, services: ServicesDep) -> Response:
    """Prometheus text."""
    body, media_type = await asyncio.to_thread(exposition, services, request.app.state.requests)
    return Response(body, media_type=media_type)


def _stored(services: Services) -> list[str]:
    """What is wrong on the disk."""
    found = [f"not a rig: {error}" for error in services.rigs.broken()]
    return found + services.disk.findings() + services.quarantine.findings() + services.upkeep.findings()


def _dead(services: Services) -> list[Literal["planner", "rig", "recorder"]]:
    """Kinds of processes of which one does not live; which one is for those who sign in."""
    rigs = [host.snapshot().health for host in services.hosts.all()]
    found: list[Literal["planner", "rig", "recorder"]] = []
    if services.queue.status in ("stopped", "restarting"):
        found.append("planner")
    if not all(rig.rig_alive for rig in rigs):
        found.append("rig")
    if not all(rig.recorder.alive for rig in rigs if rig.rig_alive):
        found.append("recorder")
    return found


def _wrong(services: Services) -> list[str]:
    found = []
    if services.queue.status == "stopped":
        found.append("the planner has stopped")
    if services.queue.status == "restarting":
        found.append("the planner's process has ended: another is started, plans wait for it")
    if services.comparisons.status == "stopped":
        found.append("comparisons are made no more")
    found += services.trail.faults() + services.alarm_trail.faults() + services.alarm_watch.faults()
    found += services.front.faults() + services.people.faults()
    for host in services.hosts.all():
        state = host.snapshot().health
        if not state.rig_alive:
            found.append(f"rig {host.name}: its process does not answer")
        elif not state.recorder.alive:
            found.append(f"rig {host.name}: its recorder does not answer; where it ended, it is replaced at rest")
        found += [f"rig {host.name}: {fault}" for fault in host.faults()]
        if state.recorder.error:
            found.append(f"rig {host.name}: recorder: {state.recorder.error}")
    return found


def _notes(services: Services) -> list[str]:
    if services.people.admitted.people:
        return []
    return ["no users are configured: this server listens on this machine only, and whoever is on it may command"]
