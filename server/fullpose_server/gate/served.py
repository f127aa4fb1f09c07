"""How an app is served on connections that were accepted elsewhere: one request each, for the next may be a stop."""

import asyncio
import logging
import socket
from typing import Any

import uvicorn
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.server import ServerState

log = logging.getLogger(__name__)


class Served(HttpToolsProtocol):
    """uvicorn's protocol on a connection of which the beginning has been read."""

    def __init__(self, begun: bytes, config: uvicorn.Config, state: ServerState) -> None:
        super().__init__(config=config, server_state=state, app_state={}, _loop=asyncio.get_running_loop())
        self._begun = begun

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as uvicorn has it
        """Go on from what was read."""
        super().connection_made(transport)
        self.data_received(self._begun)


class Connections:
    """The connections that an app is served on, one after another given to `serve`."""

    def __init__(self, config: uvicorn.Config, state: ServerState) -> None:
        self._config = config
        self._state = state
        self._beginning = set[asyncio.Task[Any]]()

    def __len__(self) -> int:
        return len(self._state.connections) + len(self._beginning)

    def serve(self, connection: socket.socket, begun: bytes) -> None:
        """Serve the app on this one, of which `begun` has been read."""
        connection.setblocking(False)
        loop = asyncio.get_running_loop()
        made = loop.connect_accepted_socket(lambda: Served(begun, self._config, self._state), connection)
        task = asyncio.ensure_future(made)
        self._beginning.add(task)
        task.add_done_callback(self._has_begun)

    async def close(self, longest_s: float) -> None:
        """Close them all; what is being answered has so long."""
        await asyncio.gather(*self._beginning, return_exceptions=True)
        for connection in list(self._state.connections):
            connection.shutdown()
        if self._state.tasks:
            await asyncio.wait(set(self._state.tasks), timeout=longest_s)

    def _has_begun(self, task: "asyncio.Task[Any]") -> None:
        self._beginning.discard(task)
        if not task.cancelled() and task.exception() is not None:
            log.debug("a connection ended before it was served: %s", task.exception())


class OneRequest:
    """ASGI middleware: a connection is closed after its answer, so that the gate sees every request."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have it answered."""
        if scope["type"] == "websocket":
            await self._opened(scope, receive, send)
            return

        async def closing(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), (b"connection", b"close")]
            await send(message)

        await self._app(scope, receive, closing)

    async def _opened(self, scope: Scope, receive: Receive, send: Send) -> None:
        refused = False

        async def watched(message: Message) -> None:
            nonlocal refused
            refused = refused or message["type"] == "websocket.http.response.start"
            await send(message)

        await self._app(scope, receive, watched)
        if refused:
            raise ClientDisconnected  # uvicorn would call it an error where the client did not wait to hear it


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
