"""One client of a stream: what it subscribed to, each topic sent by a task of its own.

A client costs a position in its source and the frame it is being sent, whatever its speed: no queue is kept for it. One
that reads too slowly finds, when it is ready again, the newest samples, and is told how many it missed.
"""

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable
from typing import Protocol

from fastapi import WebSocket
from pydantic import TypeAdapter, ValidationError

from fullpose_server.api.errors import problem_of
from fullpose_server.api.problems import ApiError
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
from fullpose_server.api.streams.tasks import (
    NOT_TEXT,
    UNSUPPORTED,
    GoneError,
    Tasks,
    close_for,
    send_bytes,
    send_text,
)

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
        self._sending = Tasks(self._failed)
        self._answers = Tasks(self._failed)

    async def run(self) -> None:
        """hello, then what the client subscribes to. An error nobody planned for is told and logged, and ends it."""
        try:
            await self._say(self._source.hello(), by_alias=True)
            while (frame := await self._socket.receive())["type"] != "websocket.disconnect":
                if frame.get("text") is None:
                    await close_for(
                        self._socket, StreamProblem(problem=NOT_TEXT.problem).model_dump_json(), UNSUPPORTED
                    )
                    break
                await self._take(frame["text"])
        except GoneError:
            pass
        except Exception as error:  # noqa: BLE001 - logged by problem_of
            await self._failed(error)
        finally:
            await self._sending.end()
            await self._answers.finished()  # done and audited, whoever listens

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
                stopping = self._source.stop(message)
                self._answers.start(lambda: self._answer(stopping), "answer to stop")
                return
            else:
                answer = Pong(t=message.t, server_time=time.time())
        except (ValidationError, ApiError) as error:
            answer = StreamProblem(problem=problem_of(error))
        await self._say(answer)

    async def _answer(self, work: Awaitable[Wire]) -> None:
        try:
            answer = await work
        except ApiError as error:
            answer = StreamProblem(problem=problem_of(error))
        await self._say(answer)

    async def _begin(self, *, again: bool = False) -> None:
        await self._sending.end()
        wanted = self._wanted
        if wanted is None:
            return
        # Control and data have a task each: a session's change never waits for telemetry to be read.
        if "session" in wanted.topics:
            self._sending.start(self._sessions, "stream of the session")
        if "telemetry" in wanted.topics:
            self._sending.start(lambda: self._telemetry(wanted, again=again), "stream of telemetry")

    async def _failed(self, error: Exception) -> None:
        """Tell why nothing more will come, and close: the reader wakes, and ends the client."""
        await close_for(self._socket, StreamProblem(problem=problem_of(error)).model_dump_json())

    async def _say(self, message: Wire, *, by_alias: bool = False) -> None:
        await send_text(self._socket, message.model_dump_json(by_alias=by_alias))

    async def _sessions(self) -> None:
        async for change in self._source.changes():
            await send_text(self._socket, change)

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
                    await send_bytes(self._socket, frame)
                else:
                    await send_text(self._socket, frame)
            due += period
            late = loop.time() - due
            if late > period:
                # Sending took longer than that: the frames in between are not made up for. The phase is kept: clients
                # that were all held up by the same thing must not all be due at once from then on.
                skipped = int(late / period)
                frames.missed(skipped)
                due += skipped * period
            await asyncio.sleep(max(0.0, due - loop.time()))
