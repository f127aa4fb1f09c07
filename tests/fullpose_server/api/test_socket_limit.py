"""A WebSocket whose client leaves while it is refused: nothing is wrong, and nothing is logged."""

import asyncio
from pathlib import Path
from typing import Any

import pytest
from starlette.applications import Starlette
from starlette.responses import Response
from starlette.routing import WebSocketRoute
from starlette.types import Message
from starlette.websockets import WebSocket, WebSocketDisconnect

from fullpose_server.api.socket_limit import SocketLimit
from fullpose_server.settings import Settings

LEFT = OSError("the client has left")


async def refuse(_: WebSocket) -> None:
    raise ValueError


def send_after(accepted: bool, told: list[str]) -> Any:
    async def send(message: Message) -> None:
        told.append(message["type"])
        if not accepted or message["type"] != "websocket.accept":
            raise LEFT

    return send


async def connecting() -> Message:
    return {"type": "websocket.connect"}


def limited(endpoint: Any, handled: list[Exception], tmp_path: Path) -> SocketLimit:
    async def answer(_: object, error: Exception) -> Response:
        handled.append(error)
        return Response(status_code=404)

    app = Starlette(routes=[WebSocketRoute("/", endpoint)], exception_handlers={ValueError: answer, OSError: answer})
    return SocketLimit(app, Settings(data_dir=tmp_path))


SCOPE = {"type": "websocket", "path": "/", "headers": [], "extensions": {"websocket.http.response": {}}}


def test_a_client_that_leaves_while_it_is_refused_is_no_error_of_the_app(tmp_path: Path) -> None:
    handled: list[Exception] = []
    told: list[str] = []
    with pytest.raises(OSError, match="has left") as found:
        asyncio.run(limited(refuse, handled, tmp_path)(dict(SCOPE), connecting, send_after(False, told)))
    assert found.value is LEFT
    assert [type(error) for error in handled] == [ValueError]
    assert told == ["websocket.http.response.start"]


def test_one_that_leaves_later_is_told_to_the_route(tmp_path: Path) -> None:
    handled: list[Exception] = []

    async def speak(socket: WebSocket) -> None:
        await socket.accept()
        await socket.send_text("hello")

    with pytest.raises(WebSocketDisconnect):
        asyncio.run(limited(speak, handled, tmp_path)(dict(SCOPE), connecting, send_after(True, [])))
    assert handled == []
