"""The app factory: settings in, a FastAPI app out. What lives as long as the server is built by `wiring`."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from typing import Any

import anyio
from asgi_correlation_id import CorrelationIdMiddleware
from fastapi import Depends, FastAPI, Request, Response
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.routing import APIRoute
from starlette.requests import HTTPConnection

from fullpose_server.api import errors, openapi
from fullpose_server.api import uploads as uploading
from fullpose_server.api.admission import Admission
from fullpose_server.api.body_limit import BodyLimit
from fullpose_server.api.compression import Compression
from fullpose_server.api.console import API_PAGE, console
from fullpose_server.api.origin import OriginGuard
from fullpose_server.api.paths import API
from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.api.request_log import RequestLog, RequestTimes
from fullpose_server.api.routes import (
    alarms,
    audit,
    compare,
    curves,
    exports,
    health,
    live,
    login,
    login_provider,
    plane,
    plans,
    profiles,
    reading,
    replay,
    rigs,
    runs,
    scene,
    sessions,
    solve,
    stop,
    stream,
    tokens,
    trajectories,
    users,
)
from fullpose_server.api.socket_limit import SocketLimit
from fullpose_server.scene.errors import PayloadMeshError, SceneError, SceneSocketError
from fullpose_server.scene.on_demand import ScenesOnDemand
from fullpose_server.scene.proxy import router as scene_router
from fullpose_server.scene.scenes import SceneServer
from fullpose_server.settings import Settings
from fullpose_server.version import VERSION
from fullpose_server.wiring import serving

ROUTES = (
    rigs,
    trajectories,
    reading,
    profiles,
    plans,
    plane,
    compare,
    sessions,
    stop,
    scene,
    stream,
    live,
    replay,
    solve,
    runs,
    curves,
    exports,
    alarms,
    audit,
    login,
    login_provider,
    users,
    tokens,
    health,
)
DESCRIPTION = (
    "Flies attitude trajectories on four-axis flight motion simulators. Degrees and seconds; frames in the order base, "
    "outer, middle, inner; quaternions w, x, y, z from reference (north, up, east) to body (nose, up, right wing)."
)


def create_app(settings: Settings) -> FastAPI:
    """The server as an ASGI app. Its lifespan raises `DataDirInUseError` where another server has the data folder."""
    app = FastAPI(
        title="Fullpose",
        version=VERSION,
        description=DESCRIPTION,
        lifespan=_lifespan(settings),
        docs_url=None,  # FastAPI's page takes its scripts from the network
        redoc_url=None,
        openapi_url=f"{API}/openapi.json",
        separate_input_output_schemas=False,
    )
    app.state.scenes = SceneServer()
    app.state.requests = RequestTimes()
    errors.install(app)
    app.add_exception_handler(SceneError, _scene_problem)
    for module in ROUTES:
        app.include_router(module.router, prefix=API)
    app.include_router(health.scraped)
    app.add_route("/api/docs", _api_page)
    app.include_router(scene_router, dependencies=[Depends(_scene)])
    app.mount("/", console())
    uploads = settings.max_upload_bytes + uploading.ENVELOPE
    larger = {f"{API}/solve": settings.max_json_bytes} | dict.fromkeys(_taking_files(), uploads)
    app.add_middleware(Compression)
    app.add_middleware(BodyLimit, settings=settings, larger=larger)
    app.add_middleware(SocketLimit, settings=settings)
    app.add_middleware(Admission)
    app.add_middleware(OriginGuard, settings=settings)
    app.add_middleware(RequestLog, times=app.state.requests)
    app.add_middleware(CorrelationIdMiddleware)

    def contract() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = openapi.contract(
                app, [route for module in ROUTES for route in module.router.routes], API
            )
        return app.openapi_schema

    app.openapi = contract  # type: ignore[method-assign]  # FastAPI's documented way to extend it
    return app


async def _api_page(_request: Request) -> Response:
    """The API for people. The version is in the addresses since browsers may keep them for a year."""
    script, style = (f"{API_PAGE}{name}?{VERSION}" for name in ("swagger-ui-bundle.js", "swagger-ui.css"))
    return get_swagger_ui_html(
        openapi_url=f"{API}/openapi.json",
        title="Fullpose: the API",
        swagger_js_url=script,
        swagger_css_url=style,
        swagger_favicon_url="/icon.svg",
    )


def _lifespan(settings: Settings) -> Callable[[FastAPI], Any]:
    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with serving(settings, app.state.scenes) as served:
            app.state.on_demand = served.scenes
            app.state.services = served.services
            app.state.people = served.services.people
            _match_once(app)
            _load_once()
            yield

    return lifespan


def _match_once(app: FastAPI) -> None:
    """Let every router build what it builds at its first request, which would hold up the event loop (50 ms of CPU)."""
    nowhere = {"type": "http", "method": "GET", "path": f"{API}/", "root_path": "", "headers": [], "path_params": {}}
    for route in app.router.routes:
        route.matches(dict(nowhere))


def _load_once() -> None:
    """Let anyio load what sends a file, which it does at the first use: that would hold up the event loop (20 ms)."""
    _ = anyio.open_file


async def _scene(connection: HTTPConnection, rig: str) -> None:
    """Start a scene when it is first looked at."""
    scenes: ScenesOnDemand = connection.app.state.on_demand
    if not scenes.running(rig):
        await asyncio.to_thread(scenes.open, rig)


async def _scene_problem(request: Request, error: Exception) -> Response:
    match error:
        case PayloadMeshError():
            code, status = "payload-mesh", 422
        case SceneSocketError():
            code, status = "scene", 503
        case _:
            code, status = "scene", 404
    return problem_response(ApiError(status, code, str(error)).problem, request)


def _taking_files() -> Iterator[str]:
    """The paths of routes whose body is a form with a file."""
    for route in (route for module in ROUTES for route in module.router.routes if isinstance(route, APIRoute)):
        body = (route.openapi_extra or {}).get("requestBody", {})
        if uploading.FORM in body.get("content", {}):
            yield f"{API}{route.path}"
