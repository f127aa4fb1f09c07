"""The app factory: settings in, a FastAPI app out. What lives as long as the server is built in its lifespan."""

import asyncio
import fcntl
import os
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import Any

import numpy as np
from fastapi import Depends, FastAPI, Request, Response
from starlette.requests import HTTPConnection

from fullpose_server.api import errors, openapi
from fullpose_server.api.console import console
from fullpose_server.api.deps import Services
from fullpose_server.api.errors import ApiError, problem_response
from fullpose_server.api.origin import OriginGuard
from fullpose_server.api.routes import (
    audit,
    compare,
    health,
    live,
    plans,
    replay,
    rigs,
    runs,
    scene,
    sessions,
    solve,
    stream,
    trajectories,
)
from fullpose_server.errors import ServerError
from fullpose_server.formats.plan_folder import rig_hash
from fullpose_server.formats.rig_file import RigStore
from fullpose_server.operating import GuardConfig, OperatingConfig, Tolerance
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.planning.plan_queue import PlanQueue
from fullpose_server.planning.plan_request import PlanRequest
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.runtime.supervisor.registry import RigHosts
from fullpose_server.scene.errors import PayloadMeshError, SceneError
from fullpose_server.scene.on_demand import ScenesOnDemand
from fullpose_server.scene.proxy import router as scene_router
from fullpose_server.scene.scenes import SceneServer
from fullpose_server.settings import Settings
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.trajectories import TrajectoryStore
from fullpose_server.version import VERSION

API = "/api/v1"
ROUTES = (rigs, trajectories, plans, compare, sessions, scene, stream, live, replay, solve, runs, audit, health)
DESCRIPTION = (
    "Flies attitude trajectories on four-axis flight motion simulators. Degrees and seconds; frames in the order base, "
    "outer, middle, inner; quaternions w, x, y, z from reference (north, up, east) to body (nose, up, right wing)."
)


class DataDirInUseError(ServerError):
    """Another server works on this data folder."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            f"data folder {folder} is in use by another Fullpose server: stop it, or give another --data-dir"
        )


def create_app(settings: Settings) -> FastAPI:
    """The server as an ASGI app. Its lifespan raises `DataDirInUseError` where another server has the data folder."""
    app = FastAPI(
        title="Fullpose",
        version=VERSION,
        description=DESCRIPTION,
        lifespan=_lifespan(settings),
        docs_url="/api/docs",
        redoc_url=None,
        openapi_url=f"{API}/openapi.json",
        separate_input_output_schemas=False,
    )
    app.state.scenes = SceneServer()
    errors.install(app)
    app.add_exception_handler(SceneError, _scene_problem)
    for module in ROUTES:
        app.include_router(module.router, prefix=API)
    app.include_router(scene_router, dependencies=[Depends(_scene)])
    app.mount("/", console())
    app.add_middleware(OriginGuard, settings=settings)

    def contract() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.contract(app)
        return app.openapi_schema

    app.openapi = contract  # type: ignore[method-assign]  # FastAPI's documented way to extend it
    return app


def _lifespan(settings: Settings) -> Callable[[FastAPI], Any]:
    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            folder = settings.data_dir.resolve()
            stack.callback(os.close, await asyncio.to_thread(_lock, folder))
            database = await asyncio.to_thread(Database, folder / "fullpose.db")
            stack.callback(database.close)
            services = _build(settings, folder, database, app.state.scenes)
            stack.callback(app.state.scenes.close)
            app.state.on_demand = services.scenes
            await services.queue.start()
            stack.push_async_callback(services.queue.close)
            stack.push_async_callback(services.comparisons.close)
            stack.push_async_callback(services.hosts.close, stop_rigs=settings.stop_rigs_on_exit)
            await services.hosts.adopt()
            app.state.services = services
            yield

    return lifespan


def _build(settings: Settings, folder: Path, database: Database, scenes: SceneServer) -> Services:
    bridged_ms = settings.live_extrapolate_ms
    # It warns before the source is let go, and trips where it is not.
    guard = GuardConfig(stale_ms=Tolerance(0.4 * bridged_ms, 2.0 * bridged_ms))
    rig_store = RigStore(folder / "rigs", OperatingConfig(guard=guard))
    trajectory_store = TrajectoryStore(database, folder / "trajectories")
    plan_store = PlanStore(database, folder / "plans")
    run_folder = folder / "runs"
    run_folder.mkdir(exist_ok=True)

    def directory(rig: str) -> Path:
        return rig_store.folder / rig

    def latest(rig: str) -> Any:
        host = hosts.get(rig)
        rows = None if host is None else host.latest()
        return None if rows is None else rows[0]

    def config(rig: str) -> RigConfig:
        entry = rig_store.get(rig)
        return RigConfig(
            rig,
            entry.rig,
            directory(rig),
            run_folder,
            rate_hz=settings.rig_rate_hz,
            live=LiveConfig(
                udp_port=settings.live_udp_ports.get(rig),
                delay_ms=settings.live_delay_ms,
                extrapolate_ms=bridged_ms,
            ),
            **vars(entry.operating),
        )

    def request(plan: str) -> PlanRequest:
        row = plan_store.get(plan)
        rig = rig_store.get(row.rig).rig
        if rig_hash(rig) != row.rig_hash:
            raise ServerError(f"rig {row.rig} has been changed since this plan was asked for: ask again")
        start = None if row.start_deg is None else np.deg2rad(row.start_deg)
        return PlanRequest(
            plan_id=plan,
            folder=plan_store.folder(plan),
            trajectory=trajectory_store.folder(row.trajectory),
            trajectory_sha256=row.trajectory,
            name=trajectory_store.get(row.trajectory).name,
            rig=rig,
            rate_hz=row.rate_hz,
            method=row.method,
            options=row.options,
            start=None if start is None else (float(start[0]), float(start[1]), float(start[2]), float(start[3])),
            remedy=row.remedy,
        )

    hosts = RigHosts(rig_store, config, directory)
    return Services(
        settings=settings,
        database=database,
        rigs=rig_store,
        trajectories=trajectory_store,
        plans=plan_store,
        queue=PlanQueue(plan_store, request),
        comparisons=Comparisons(folder / "comparisons"),
        audit=AuditLog(database),
        hosts=hosts,
        runs=RunFiles(run_folder),
        scenes=ScenesOnDemand(scenes, rig_store, latest),
    )


def _lock(folder: Path) -> int:
    """Lock the data folder for the life of the returned file descriptor."""
    folder.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(folder / "server.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise DataDirInUseError(folder) from None
    return descriptor


async def _scene(connection: HTTPConnection, rig: str) -> None:
    """Start a scene when it is first looked at."""
    scenes: ScenesOnDemand = connection.app.state.on_demand
    if not scenes.running(rig):
        await asyncio.to_thread(scenes.open, rig)


async def _scene_problem(request: Request, error: Exception) -> Response:
    code, status = ("payload-mesh", 422) if isinstance(error, PayloadMeshError) else ("scene", 404)
    return problem_response(ApiError(status, code, str(error)).problem, request)
