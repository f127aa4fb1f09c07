"""The tasks of one connection: each has an owner, a name and an end that somebody hears of."""

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from fullpose_server.api.problems import ApiError

Work = Callable[[], Coroutine[Any, Any, None]]
FAULT = 1011  # the WebSocket close code of an error of the server
UNSUPPORTED = 1003  # of data that the socket does not take: a binary frame where messages are JSON
NOT_TEXT = ApiError(422, "validation", "expected a JSON message in a text frame, this one is binary")


class GoneError(Exception):
    """The client has left; nothing can be sent to it."""


async def send_text(socket: WebSocket, text: str) -> None:
    """Send, or raise `GoneError` where the client has left."""
    await _sent(socket, socket.send_text(text))


async def send_bytes(socket: WebSocket, data: bytes) -> None:
    """Send, or raise `GoneError` where the client has left."""
    await _sent(socket, socket.send_bytes(data))


async def _sent(socket: WebSocket, sending: Coroutine[Any, Any, None]) -> None:
    try:
        await sending
    except (WebSocketDisconnect, OSError) as error:
        raise GoneError(repr(error)) from error
    except RuntimeError as error:  # starlette's and uvicorn's word for a socket that is closed
        if socket.application_state is WebSocketState.CONNECTING:
            raise  # ours: nothing was accepted yet
        raise GoneError(str(error)) from error


async def close_for(socket: WebSocket, problem: str, code: int = FAULT) -> None:
    """Send the problem and close with `code`; a client that has left is not told."""
    with suppress(GoneError):
        await send_text(socket, problem)
        await _sent(socket, socket.close(code, "the problem says why"))


class Tasks:
    """A group of tasks of one connection. `failed` is awaited with what ended one of them and is not `GoneError`."""

    def __init__(self, failed: Callable[[Exception], Coroutine[Any, Any, None]]) -> None:
        self._failed = failed
        self._running: set[asyncio.Task[None]] = set()

    def start(self, work: Work, name: str) -> None:
        """Run `work()` until it ends or the group does."""
        task = asyncio.create_task(self._guarded(work), name=name)
        self._running.add(task)
        task.add_done_callback(self._running.discard)

    async def end(self) -> None:
        """Cancel all of them and wait until they are gone."""
        mine = asyncio.current_task()
        others = [task for task in self._running if task is not mine]
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

    async def finished(self) -> None:
        """Wait until all of them have ended by themselves."""
        await asyncio.gather(*self._running, return_exceptions=True)

    async def _guarded(self, work: Work) -> None:
        try:
            await work()
        except GoneError:
            return  # the reader sees it too, and ends the connection
        except Exception as error:  # noqa: BLE001 - told to the client and logged, by `failed`
            await self._failed(error)
