"""An error of our own in a stream: the client is told and closed, the log says which, and no task is left."""

import asyncio
import json
import logging
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Any

import pytest
from starlette.websockets import WebSocket

from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.stream import Pong, StopNow
from fullpose_server.api.streams.stream_client import StreamClient


class Source:
    """A source that fails where it is told to; it says of itself what a stream needs, and no more."""

    def __init__(self, fails: str, error: Exception) -> None:
        self._fails, self._error = fails, error

    def _do(self, what: str) -> None:
        if what == self._fails:
            raise self._error

    def hello(self) -> Any:
        self._do("hello")
        return Pong(t=0.0, server_time=0.0)

    async def samples(self) -> Any:
        self._do("samples")
        await asyncio.Event().wait()

    async def changes(self) -> AsyncIterator[str]:
        yield json.dumps({"type": "session"})
        self._do("changes")
        await asyncio.Event().wait()

    def control(self, _message: Any) -> Wire:
        self._do("control")
        return Pong(t=1.0, server_time=0.0)

    def stop(self, _message: StopNow) -> Awaitable[Wire]:
        async def answered() -> Wire:
            self._do("stop")
            return Pong(t=2.0, server_time=0.0)

        return answered()


class Browser:
    """The other end of a WebSocket, by ASGI: what it sends, then nothing until it is closed."""

    def __init__(self, *messages: str | bytes, leaves: bool = False) -> None:
        self.sent: list[dict[str, Any]] = []
        self._incoming: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._incoming.put_nowait({"type": "websocket.connect"})
        for message in messages:
            kind = "text" if isinstance(message, str) else "bytes"
            self._incoming.put_nowait({"type": "websocket.receive", kind: message})
        if leaves:
            self._incoming.put_nowait({"type": "websocket.disconnect", "code": 1000})

    async def receive(self) -> dict[str, Any]:
        return await self._incoming.get()

    async def send(self, message: Any) -> None:
        self.sent.append(dict(message))
        if message["type"] == "websocket.close":
            self._incoming.put_nowait({"type": "websocket.disconnect", "code": message["code"]})

    @property
    def said(self) -> list[Any]:
        return [json.loads(m["text"]) for m in self.sent if m["type"] == "websocket.send"]


def talk(browser: Browser, source: Any) -> set[str]:
    """One connection from its beginning to its end; the names of the tasks that it left behind."""

    async def whole() -> set[str]:
        socket = WebSocket({"type": "websocket"}, browser.receive, browser.send)
        await socket.accept()
        await asyncio.wait_for(StreamClient(socket, source).run(), 30.0)
        return {task.get_name() for task in asyncio.all_tasks()} - {_name()}

    return asyncio.run(whole())


def _name() -> str:
    task = asyncio.current_task()
    assert task is not None
    return task.get_name()


SUBSCRIBE = json.dumps({"type": "subscribe"})
ERRORS: list[Callable[[str], Exception]] = [KeyError, RuntimeError, ValueError, OSError]


@pytest.mark.parametrize("error", ERRORS)
@pytest.mark.parametrize(
    ("fails", "messages"),
    [
        ("hello", []),
        ("samples", [SUBSCRIBE]),
        ("changes", [SUBSCRIBE]),
        ("control", [json.dumps({"type": "pause"})]),
        ("stop", [json.dumps({"type": "stop"})]),
    ],
)
def test_an_error_of_our_own_is_told_logged_and_closes(
    fails: str, messages: list[str], error: Callable[[str], Exception], caplog: pytest.LogCaptureFixture
) -> None:
    browser = Browser(*messages)
    with caplog.at_level(logging.ERROR):
        left = talk(browser, Source(fails, error("ours")))
    assert browser.said[-1]["type"] == "problem"
    assert browser.said[-1]["problem"]["status"] == 500
    assert browser.sent[-1]["type"] == "websocket.close"
    assert browser.sent[-1]["code"] == 1011
    assert [record.exc_info[1].args for record in caplog.records if record.exc_info and record.exc_info[1]] == [
        ("ours",)
    ]
    assert left == set()


def test_a_binary_message_is_a_problem_and_ends_the_stream() -> None:
    browser = Browser(b"\x00", json.dumps({"type": "ping", "t": 3.0}), leaves=True)
    assert talk(browser, Source("", ValueError())) == set()
    assert [message["type"] for message in browser.said] == ["pong", "problem"]
    assert [message["code"] for message in browser.sent if message["type"] == "websocket.close"] == [1003]


def test_a_client_that_leaves_is_no_error(caplog: pytest.LogCaptureFixture) -> None:
    browser = Browser(SUBSCRIBE, leaves=True)
    assert talk(browser, Source("", ValueError())) == set()
    assert not caplog.records
    assert "websocket.close" not in [message["type"] for message in browser.sent]
