"""The contract: FastAPI's own, with problem documents for every error and the WebSocket messages beside the rest."""

from collections.abc import Sequence
from itertools import chain
from typing import Any, get_args

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic.json_schema import models_json_schema

from fullpose_server.api.problems import MEDIA_TYPE
from fullpose_server.api.schemas.base import Problem, Wire
from fullpose_server.api.schemas.live import LiveOpened, LiveProblem, LiveReplyOut, LiveSampleIn, OpenLive
from fullpose_server.api.schemas.solve import Opened, OpenSolve, Solved, SolveIn, SolveProblem, SolveSamples
from fullpose_server.api.schemas.stop import STOP_IN, STOP_OUT
from fullpose_server.api.schemas.stream import STREAM_IN, STREAM_OUT
from fullpose_server.api.schemas.trajectories import TrajectoryIn

# The messages of each WebSocket, what a client sends and what the server answers; each tagged by its `type`.
SENT = {
    "StreamMessageIn": STREAM_IN,
    "StopMessageIn": STOP_IN,
    "SolveMessageIn": (OpenSolve, SolveSamples),
    "LiveMessageIn": (OpenLive, LiveSampleIn),
}
ANSWERED = {
    "StreamMessageOut": STREAM_OUT,
    "StopMessageOut": STOP_OUT,
    "SolveMessageOut": (Opened, Solved, SolveProblem),
    "LiveMessageOut": (LiveOpened, LiveReplyOut, LiveProblem),
}
MESSAGES = (*chain.from_iterable(SENT.values()), TrajectoryIn, SolveIn)
ANSWERS = (Problem, *chain.from_iterable(ANSWERED.values()))


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
    for union, models in (SENT | ANSWERED).items():
        schemas[union] = _union(models)
    schemas.pop("HTTPValidationError", None)
    schemas.pop("ValidationError", None)
    for path in document["paths"].values():
        for operation in path.values():
            _problems(operation["responses"])
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    return document


def _union(models: Sequence[type[Wire]]) -> dict[str, Any]:
    """One of these messages, by its `type`: for clients whose types are made from the contract."""
    refs = {model: f"#/components/schemas/{model.__name__}" for model in models}
    mapping = {word: ref for model, ref in refs.items() for word in get_args(model.model_fields["type"].annotation)}
    return {
        "oneOf": [{"$ref": ref} for ref in refs.values()],
        "discriminator": {"propertyName": "type", "mapping": mapping},
    }


def _problems(responses: dict[str, Any]) -> None:
    body = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for status, response in responses.items():
        if status.startswith(("4", "5")):
            response["content"] = body
    responses["default"] = {"description": "Any error, as a problem document", "content": body}
