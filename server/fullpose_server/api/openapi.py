"""The contract: FastAPI's own, with problem documents for every error and the WebSocket messages beside the rest."""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic.json_schema import models_json_schema

from fullpose_server.api.errors import MEDIA_TYPE
from fullpose_server.api.schemas.base import Problem
from fullpose_server.api.schemas.live import LiveOpened, LiveProblem, LiveReplyOut, LiveSampleIn, OpenLive
from fullpose_server.api.schemas.solve import Opened, OpenSolve, Solved, SolveProblem, SolveSamples
from fullpose_server.api.schemas.stream import (
    Hello,
    Pause,
    Ping,
    Play,
    Pong,
    Replayed,
    Seek,
    SessionChanged,
    Speed,
    StopNow,
    Stopped,
    StreamProblem,
    Subscribe,
    Telemetry,
)
from fullpose_server.api.schemas.trajectories import TrajectoryIn

MESSAGES = (
    *(Subscribe, Ping, StopNow, Seek, Speed, Pause, Play),
    *(OpenSolve, SolveSamples),
    *(OpenLive, LiveSampleIn),
    TrajectoryIn,
)
ANSWERS = (
    Problem,
    *(Hello, Telemetry, SessionChanged, Replayed, Pong, Stopped, StreamProblem),
    *(Opened, Solved, SolveProblem),
    *(LiveOpened, LiveReplyOut, LiveProblem),
)


def contract(app: FastAPI) -> dict[str, Any]:
    """The OpenAPI document of the app."""
    document = get_openapi(
        title=app.title,
        version=app.version,
        description=app.description,
        routes=app.routes,
        separate_input_output_schemas=False,
    )
    schemas: dict[str, Any] = document["components"]["schemas"]
    _, extra = models_json_schema(
        [*((m, "validation") for m in MESSAGES), *((m, "serialization") for m in ANSWERS)],
        by_alias=True,
        ref_template="#/components/schemas/{model}",
    )
    for name, schema in extra["$defs"].items():
        schemas.setdefault(name, schema)
    schemas.pop("HTTPValidationError", None)
    schemas.pop("ValidationError", None)
    for path in document["paths"].values():
        for operation in path.values():
            _problems(operation["responses"])
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    return document


def _problems(responses: dict[str, Any]) -> None:
    body = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for status, response in responses.items():
        if status.startswith(("4", "5")):
            response["content"] = body
    responses["default"] = {"description": "Any error, as a problem document", "content": body}
