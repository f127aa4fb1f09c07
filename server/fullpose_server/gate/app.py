"""What the gate serves: POST stop and estop, either as a command too, and the stop channel, a WebSocket."""

import asyncio

from msgspec import json
from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

from fullpose_server.api.close_codes import UNKNOWN
from fullpose_server.api.paths import API, STOP_CHANNEL
from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.api.stopping import CLIENT_HEADER, answer, status_of, who_stops
from fullpose_server.api.streams.stop_channel import StopChannel
from fullpose_server.gate.rigs import Rigs
from fullpose_server.gate.who import Who
from fullpose_server.session.states import Command

# What a client still sends of a body is taken for so long: it gets its answer then, and no reset before.
_LINGER_S = 2.0


def create_app(rigs: Rigs, who: Who) -> Starlette:
    """The gate as an ASGI app."""
    return Starlette(
        routes=[
            Route(f"{API}/rigs/{{rig}}/{{command}}", _Stop(rigs, who), methods=["POST"]),
            WebSocketRoute(f"{API}{STOP_CHANNEL}", _Channel(rigs, who)),
        ]
    )


class _Channel:
    """The stop channel of a page or program."""

    def __init__(self, rigs: Rigs, who: Who) -> None:
        self._rigs = rigs
        self._who = who

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        socket = WebSocket(scope, receive, send)

        def known() -> str | None:
            person = self._who.admit(socket.headers.get("authorization"), socket.headers.get("cookie"))
            return None if person is None else person.who

        try:
            known()
        except ApiError as error:
            await socket.close(UNKNOWN, error.problem.detail)
            return
        await StopChannel(socket, self._rigs.stop, socket.headers.get(CLIENT_HEADER), known).run()


class _Stop:
    """One stop by HTTP, answered before its body has come."""

    def __init__(self, rigs: Rigs, who: Who) -> None:
        self._rigs = rigs
        self._who = who

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        request = Request(scope, receive)
        word = request.path_params["command"]
        if word == "commands":  # whole, and looked into before it was given to us
            word = json.decode(await request.body())["command"]
        address = None if request.client is None else request.client.host
        try:
            person = self._who.admit(request.headers.get("authorization"), request.headers.get("cookie"))
            who = who_stops(request.headers.get(CLIENT_HEADER), address) if person is None else person.who
            done = answer(word, await self._rigs.stop(request.path_params["rig"], Command(word), who, address))
            response = Response(done.model_dump_json(), status_of(done), media_type="application/json")
        except ApiError as error:
            response = problem_response(error.problem, request)
        await _send_then_linger(response, request, send)


async def _send_then_linger(response: Response, request: Request, send: Send) -> None:
    await send({"type": "http.response.start", "status": response.status_code, "headers": response.raw_headers})
    await send({"type": "http.response.body", "body": bytes(response.body), "more_body": True})
    if "expect" not in request.headers:
        try:
            async with asyncio.timeout(_LINGER_S):
                async for _ in request.stream():
                    pass
        except (TimeoutError, ClientDisconnect, RuntimeError):
            pass  # RuntimeError: the body was taken before
    await send({"type": "http.response.body", "body": b""})
