"""One client of a stream: what it subscribed to, each topic sent by a task of its own.

A client costs a position in its source and the frame it is being sent, whatever its speed: no queue is kept for it. One
that reads too slowly finds, when it is ready again, the newest samples, and is told how many it missed.
"""

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Protocol

from fastapi import WebSocket, WebSocketDisconnect
from pydantic import TypeAdapter

from fullpose_server.api.errors import ApiError, problem_of
from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.stream import (
    Hello,
    Playback,
    Pong,
    StopNow,
    StreamIn,
    StreamProblem,
    Subscribe,
)
from fullpose_server.api.streams.frame_source import FrameSource
from fullpose_server.api.streams.frames import FrameMaker

_INCOMING: TypeAdapter[StreamIn] = TypeAdapter(StreamIn)


class Source(Protocol):
    """What is streamed: a rig as it lives, or a run as it was."""

    def hello(self) -> Hello:
        """The first message."""

    async def samples(self) -> FrameSource:
        """Where the samples are, once there are some."""

    def changes(self) -> AsyncIterator[str]:
        """The session as it is now, then each change of it: messages, encoded."""

    def control(self, message: Playback) -> Wire:
        """Do what only a replay can, and answer. Raises `ApiError`."""

    def stop(self, message: StopNow) -> Awaitable[Wire]:
        """Stop or E-stop, now; the answer is to be awaited, which may raise `ApiError` too. Raises `ApiError`."""


class StreamClient:
    """Talks with one client until it leaves."""

    def __init__(self, socket: WebSocket, source: Source) -> None:
        self._socket = socket
        self._source = source
        self._wanted: Subscribe | None = None
        self._tasks: list[asyncio.Task[None]] = []
        self._answers: set[asyncio.Task[None]] = set()

    async def run(self) -> None:
        """hello, then what the client subscribes to."""
        # RuntimeError: starlette's word for a closed socket.
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            await self._socket.send_text(self._source.hello().model_dump_json(by_alias=True))
            try:
                while True:
                    await self._take(await self._socket.receive_text())
            finally:
                await self._end_tasks()

    async def _take(self, text: str) -> None:
        try:
            message = _INCOMING.validate_json(text)
            if isinstance(message, Playback):
                answer: Wire = self._source.control(message)
                if message.type == "seek":
                    await self._begin(again=True)  # the position in the samples has moved
            elif isinstance(message, Subscribe):
                self._wanted = message
                await self._begin()
                return
            elif isinstance(message, StopNow):
                # The answer waits for the rig's loop; what the client says next does not wait for the answer.
                answering = asyncio.create_task(self._answer(self._source.stop(message)))
                self._answers.add(answering)
                answering.add_done_callback(self._answers.discard)
                return
            else:
                answer = Pong(t=message.t, server_time=time.time())
        except (ValueError, ApiError) as error:
            answer = StreamProblem(problem=problem_of(error))
        await self._socket.send_text(answer.model_dump_json())

    async def _answer(self, work: Awaitable[Wire]) -> None:
        try:
            answer = await work
        except ApiError as error:
            answer = StreamProblem(problem=problem_of(error))
        with contextlib.suppress(WebSocketDisconnect, RuntimeError, OSError):  # done and audited, whoever listens
            await self._socket.send_text(answer.model_dump_json())

    async def _begin(self, *, again: bool = False) -> None:
        await self._end_tasks()
        wanted = self._wanted
        if wanted is None:
            return
        # Control and data have a task each: a session's change never waits for telemetry to be read.
        if "session" in wanted.topics:
            self._tasks.append(asyncio.create_task(self._guarded(self._sessions)))
        if "telemetry" in wanted.topics:
            self._tasks.append(asyncio.create_task(self._guarded(lambda: self._telemetry(wanted, again=again))))

    async def _guarded(self, work: Callable[[], Awaitable[None]]) -> None:
        try:
            await work()
        except (WebSocketDisconnect, RuntimeError, OSError):
            with contextlib.suppress(RuntimeError):
                await self._socket.close()  # wakes the reader, which ends the client

    async def _end_tasks(self) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._tasks = []

    async def _sessions(self) -> None:
        async for change in self._source.changes():
            await self._socket.send_text(change)

    async def _telemetry(self, wanted: Subscribe, *, again: bool) -> None:
        source = await self._source.samples()
        frames = FrameMaker(source, wanted, from_newest=again)
        loop = asyncio.get_running_loop()
        period = 1.0 / wanted.rate_hz
        due = loop.time()
        while True:
            await source.round_robin.turn()
            for frame in frames.take():
                if isinstance(frame, bytes):
                    await self._socket.send_bytes(frame)
                else:
                    await self._socket.send_text(frame)
            due += period
            late = loop.time() - due
            if late > period:
                # Sending took longer than that: the frames in between are not made up for. The phase is kept: clients
                # that were all held up by the same thing must not all be due at once from then on.
                skipped = int(late / period)
                frames.missed(skipped)
                due += skipped * period
            await asyncio.sleep(max(0.0, due - loop.time()))
