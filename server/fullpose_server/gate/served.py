"""How an app is served on connections that were accepted elsewhere: one request each, for the next may be a stop."""

import asyncio
from typing import Any

import uvicorn
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.server import ServerState


class Served(HttpToolsProtocol):
    """uvicorn's protocol on a connection of which the beginning has been read."""

    def __init__(self, begun: bytes, config: uvicorn.Config, state: ServerState) -> None:
        super().__init__(config=config, server_state=state, app_state={}, _loop=asyncio.get_running_loop())
        self._begun = begun

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as uvicorn has it
        """Go on from what was read."""
        super().connection_made(transport)
        self.data_received(self._begun)


class OneRequest:
    """ASGI middleware: a connection is closed after its answer, so that the gate sees every request."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have it answered."""

        async def closing(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), (b"connection", b"close")]
            await send(message)

        await self._app(scope, receive, closing if scope["type"] == "http" else send)


def served_by(app: ASGIApp, **options: Any) -> uvicorn.Config:
    """The settings of uvicorn for `app`."""
    config = uvicorn.Config(
        OneRequest(app),
        lifespan="off",  # whoever serves has it: its errors are for the person at the terminal
        log_config=None,
        access_log=False,
        server_header=False,
        ws_per_message_deflate=False,  # telemetry is small and frequent
        http=HttpToolsProtocol,
        **options,
    )
    config.load()
    return config
