"""The contract: FastAPI's own, with problem documents for every error and the WebSocket messages beside the rest."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, get_args

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIWebSocketRoute
from pydantic.json_schema import models_json_schema
from starlette.routing import BaseRoute

from fullpose_server.api.access import needed
from fullpose_server.api.problems import MEDIA_TYPE
from fullpose_server.api.schemas.base import Problem, Wire
from fullpose_server.api.schemas.live import LiveOpened, LiveProblem, LiveReplyOut, LiveSampleIn, OpenLive
from fullpose_server.api.schemas.solve import Opened, OpenSolve, Solved, SolveIn, SolveProblem, SolveSamples
from fullpose_server.api.schemas.stop import STOP_IN, STOP_OUT
from fullpose_server.api.schemas.stream import STREAM_IN, STREAM_OUT
from fullpose_server.api.schemas.trajectories import TrajectoryIn
from fullpose_server.people.admitted import COOKIE
from fullpose_server.runtime.contract.telemetry import Flag

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
# Which of them each WebSocket speaks, by the name of its route.
SPOKEN = {
    "stream": "Stream",
    "replay_stream": "Stream",
    "solve_stream": "Solve",
    "live": "Live",
    "stop_channel": "Stop",
}
MESSAGES = (*chain.from_iterable(SENT.values()), TrajectoryIn, SolveIn)
REFUSALS = {
    "400": "The body is not what its type says",
    "401": "Nobody signed in, where people are configured",
    "403": "A foreign page, a foreign name of this server, or a role that is not enough",
    "404": "No such thing",
    "408": "The rest of the request did not come",
    "413": "Larger than a bound of this server",
    "422": "Validation Error",
    "503": "The database or a process that it takes does not answer",
    "507": "No room on the disk",
}
# How a request shows who asks, where people are configured.
SIGNED_IN = {
    "token": {"type": "http", "scheme": "bearer"},
    "session": {"type": "apiKey", "in": "cookie", "name": COOKIE},
}
BUSY: dict[int | str, dict[str, Any]] = {429: {"description": "Too many at once: try again later"}}
ANSWERS = (Problem, *chain.from_iterable(ANSWERED.values()))


def contract(app: FastAPI, routes: Iterable[BaseRoute], prefix: str) -> dict[str, Any]:
    """The OpenAPI document of the app, whose API has these `routes` below `prefix`."""
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
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            for status in _statuses(path, method, operation):
                operation["responses"].setdefault(status, {"description": REFUSALS[status]})
            if needed({"type": "http", "method": method.upper(), "path": path}) is not None:
                operation["responses"].setdefault("401", {"description": REFUSALS["401"]})
                operation["security"] = [{name: []} for name in SIGNED_IN]
            _problems(operation["responses"])
    document["components"]["securitySchemes"] = SIGNED_IN
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    document["x-websockets"] = _sockets(routes, prefix)
    document["x-telemetry-flags"] = {flag.name.lower(): flag.value for flag in Flag if flag.name}
    return document


def _statuses(path: str, method: str, operation: Mapping[str, Any]) -> Iterator[str]:
    """The refusals that an operation shares with all of its kind; those of its own are at its route."""
    yield from ("403", "503")
    if "{" in path:
        yield "404"
    if "requestBody" in operation:  # which may name a thing that is not there
        yield from ("400", "404", "408", "413", "422")
    if method != "get":
        yield "507"


def _union(models: Sequence[type[Wire]]) -> dict[str, Any]:
    """One of these messages, by its `type`: for clients whose types are made from the contract."""
    refs = {model: f"#/components/schemas/{model.__name__}" for model in models}
    mapping = {word: ref for model, ref in refs.items() for word in get_args(model.model_fields["type"].annotation)}
    return {
        "oneOf": [{"$ref": ref} for ref in refs.values()],
        "discriminator": {"propertyName": "type", "mapping": mapping},
    }


def _sockets(routes: Iterable[BaseRoute], prefix: str) -> dict[str, Any]:
    """The API's WebSockets by path, which OpenAPI has no place for: what each is sent, and what it answers."""
    named = {prefix + route.path: SPOKEN[route.name] for route in routes if isinstance(route, APIWebSocketRoute)}
    ends = {"sent": "In", "answered": "Out"}
    return {
        path: {end: {"$ref": f"#/components/schemas/{spoken}Message{sense}"} for end, sense in ends.items()}
        for path, spoken in sorted(named.items())
    }


def _problems(responses: dict[str, Any]) -> None:
    body = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for status, response in responses.items():
        page = "text/html" in response.get("content", ())  # for a browser that was sent here
        if status.startswith(("4", "5")) and not page:
            response["content"] = body
    responses["default"] = {"description": "Any error, as a problem document", "content": body}
