"""How many WebSockets are open at once, how large a message of one may be, and a client that leaves while refused."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.settings import Settings

TOO_LARGE = 1009  # close code of a message that is


class _LeftError(Exception):
    """The client has gone before it was let in: nobody is told why it was not, and nothing is wrong."""


class SocketLimit:
    """ASGI middleware."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._most_open = settings.max_websockets
        self._most_bytes = settings.max_message_bytes
        self._open = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let it through, or close it."""
        if scope["type"] != "websocket":
            await self._app(scope, receive, send)
            return
        if self._open >= self._most_open:
            full = ApiError(429, "sockets-full", f"{self._open} WebSockets are open: try again when some are closed")
            await problem_response(full.problem)(scope, receive, send)
            return
        self._open += 1
        begun = False

        async def answered(message: Message) -> None:
            nonlocal begun
            try:
                await send(message)
            except OSError as gone:
                if begun:
                    raise
                raise _LeftError from gone  # else it would be taken for an error of the app, which some OSErrors are
            begun = begun or message["type"] == "websocket.accept"

        async def bounded() -> Message:
            message = await receive()
            # In characters, as text: of a message that is larger in bytes the server has been kept by uvicorn.
            if len(message.get("bytes") or message.get("text") or "") <= self._most_bytes:
                return message
            reason = f"a message of more than {self._most_bytes} bytes"
            await send({"type": "websocket.close", "code": TOO_LARGE, "reason": reason})
            return {"type": "websocket.disconnect", "code": TOO_LARGE, "reason": reason}

        try:
            await self._app(scope, bounded, answered)
        except _LeftError as left:
            raise left.__cause__ or left from None  # the server that has the connection knows it
        finally:
            self._open -= 1
