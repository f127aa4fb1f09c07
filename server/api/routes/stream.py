"""The WebSocket /rigs/{rig}/stream: session and telemetry, each client at its own rate.

A client costs a position in the rig's ring and the frame it is being sent, whatever its speed: no queue is kept for
it. One that reads too slowly finds, when it is ready again, the newest samples, and is told how many it missed.
"""

import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from pydantic import TypeAdapter

from server.api.frames import FrameMaker, record
from server.api.problems import problem_of
from server.api.services import Services, ServicesDep
from server.api.session_view import session_out
from server.api.wire_session import SessionOut
from server.api.wire_stream import Hello, Ping, Pong, SessionChanged, StreamIn, StreamProblem, Subscribe
from server.runtime.telemetry import SAMPLE

router = APIRouter(tags=["stream"])
_INCOMING: TypeAdapter[StreamIn] = TypeAdapter(StreamIn)


@router.websocket("/rigs/{rig}/stream")
async def stream(rig: str, socket: WebSocket, services: ServicesDep) -> None:
    """hello, then what the client subscribes to."""
    await asyncio.to_thread(services.rigs.get, rig)
    await socket.accept()
    client = _Client(rig, socket, services)
    with contextlib.suppress(WebSocketDisconnect, RuntimeError):  # RuntimeError: starlette's word for a closed socket
        await client.run()


class _Client:
    def __init__(self, rig: str, socket: WebSocket, services: Services) -> None:
        self._rig = rig
        self._socket = socket
        self._services = services
        self._tasks: list[asyncio.Task[None]] = []

    async def run(self) -> None:
        hello = Hello(
            server_time=time.time(),
            rig=self._rig,
            session=self._session(),
            fields=list(SAMPLE.names or ()),
            record=record(),
        )
        await self._socket.send_text(hello.model_dump_json(by_alias=True))
        try:
            while True:
                await self._take(await self._socket.receive_text())
        finally:
            await self._end_tasks()

    async def _take(self, text: str) -> None:
        try:
            message = _INCOMING.validate_json(text)
        except ValueError as error:
            await self._socket.send_text(StreamProblem(problem=problem_of(error)).model_dump_json())
            return
        if isinstance(message, Ping):
            await self._socket.send_text(Pong(t=message.t, server_time=time.time()).model_dump_json())
            return
        await self._end_tasks()
        # Control and data have a task each: a session's change never waits for telemetry to be read.
        if "session" in message.topics:
            self._tasks.append(asyncio.create_task(self._guarded(self._sessions)))
        if "telemetry" in message.topics:
            self._tasks.append(asyncio.create_task(self._guarded(lambda: self._telemetry(message))))

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

    def _session(self) -> SessionOut:
        return session_out(self._services.hosts, self._rig, self._services.settings.rig_rate_hz)

    async def _sessions(self) -> None:
        host = await self._services.hosts.wait(self._rig)
        while True:
            revision = host.revision
            changed = SessionChanged(revision=revision, server_time=time.time(), session=self._session())
            await self._socket.send_text(changed.model_dump_json())
            await host.wait_change(revision)

    async def _telemetry(self, wanted: Subscribe) -> None:
        host = await self._services.hosts.wait(self._rig)
        frames = FrameMaker(host, wanted)
        loop = asyncio.get_running_loop()
        period = 1.0 / wanted.rate_hz
        due = loop.time()
        while True:
            for frame in frames.take():
                if isinstance(frame, bytes):
                    await self._socket.send_bytes(frame)
                else:
                    await self._socket.send_text(frame)
            due += period
            now = loop.time()
            if due < now:
                # Sending took longer than the period: the frames in between are not made up for.
                frames.missed(int((now - due) / period))
                due = now
            await asyncio.sleep(max(0.0, due - now))
