"""How much of a request's body is taken in: counted while it is received, before anything parses it.

An ASGI middleware, so that no route can forget it. Content-Length is believed where it is too large already; what is
received is counted all the same, for chunks announce nothing. Bodies of routes that read none are never received.
"""

import asyncio
from collections.abc import Mapping

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fullpose_server.api.errors import BodyError
from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.settings import Settings


class BodyLimit:
    """ASGI middleware. `larger`: the limits [bytes] of paths that take more than the rest."""

    def __init__(self, app: ASGIApp, settings: Settings, larger: Mapping[str, int]) -> None:
        self._app = app
        self._settings = settings
        self._larger = larger

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let it through; 413 where it is too large, 408 where nothing more comes of it."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        most = self._larger.get(scope["path"], self._settings.max_body_bytes)
        announced = Headers(scope=scope).get("content-length", "")
        if announced.isdecimal() and (len(announced) > 18 or int(announced) > most):
            await problem_response(too_large(most).problem)(scope, receive, send)
            return
        await self._app(scope, _Body(receive, most, self._settings.max_idle_s).next, send)


class _Body:
    """What a route receives, counted and waited for until it has all of it; later it waits for the client to leave."""

    def __init__(self, receive: Receive, most: int, longest_s: float) -> None:
        self._receive = receive
        self._most = most
        self._longest_s = longest_s
        self._taken = 0
        self._more = True

    async def next(self) -> Message:
        if not self._more:
            return await self._receive()
        try:
            message = await asyncio.wait_for(self._receive(), self._longest_s)
        except TimeoutError:
            raise BodyError(ApiError(408, "timeout", "the rest of the request did not come")) from None
        self._more = message.get("more_body", False)
        self._taken += len(message.get("body", b""))
        if self._taken > self._most:
            raise BodyError(too_large(self._most))
        return message


def too_large(most: int) -> ApiError:
    """413, with the limit in words."""
    size = f"{most / 1e6:.0f} MB" if most >= 1_000_000 else f"{most} bytes"
    return ApiError(413, "too-large", f"the request is larger than this server takes here, {size}")
