"""The WebSocket /rigs/{rig}/stream: session and telemetry of a rig as it lives, each client at its own rate."""

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable
from contextlib import suppress

from fastapi import APIRouter, WebSocket

from fullpose_server.api.commanding import by_priority
from fullpose_server.api.deps import AddressDep, PersonDep, Services, ServicesDep, WhoDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.session import SessionOut
from fullpose_server.api.schemas.stream import Hello, Playback, SessionChanged, StopNow, Stopped
from fullpose_server.api.session_view import session_out
from fullpose_server.api.stopping import answer
from fullpose_server.api.streams.frame_source import FrameSource
from fullpose_server.api.streams.frames import record
from fullpose_server.api.streams.stream_client import StreamClient
from fullpose_server.runtime.contract.telemetry import FIELDS
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.states import Command

HEALTH_S = 1.0  # the session is told at least this often
router = APIRouter(tags=["stream"])


@router.websocket("/rigs/{rig}/stream")
async def stream(
    rig: str, socket: WebSocket, services: ServicesDep, person: PersonDep, who: WhoDep, address: AddressDep
) -> None:
    """hello, then what the client subscribes to."""
    await asyncio.to_thread(services.rigs.get, rig)
    await socket.accept()
    await StreamClient(socket, _Rig(rig, services, who, address, known=person is not None)).run()


class _Rig:
    def __init__(self, rig: str, services: Services, who: str, address: str | None, *, known: bool) -> None:
        self._rig = rig
        self._known = known  # who is signed in has no other name
        self._who = who
        self._address = address
        self._services = services

    def hello(self) -> Hello:
        return Hello(
            server_time=time.time(),
            rig=self._rig,
            session=self._session(),
            fields=[field.name for field in FIELDS],
            record=record(),
        )

    async def samples(self) -> FrameSource:
        return self._frames(await self._services.hosts.wait(self._rig))

    async def changes(self) -> AsyncIterator[str]:
        host = await self._services.hosts.wait(self._rig)
        frames = self._frames(host)
        while True:
            await frames.round_robin.turn()
            revision = host.revision
            yield frames.session(revision, self._changed)
            # Health is no change of the session, and no one should have to ask for it.
            with suppress(TimeoutError):
                await asyncio.wait_for(host.wait_change(revision), HEALTH_S)

    def control(self, message: Playback) -> Wire:
        raise ApiError(422, "not-a-replay", f"{message.type}: a rig as it lives can only be watched")

    def stop(self, message: StopNow) -> Awaitable[Wire]:
        who = self._who if self._known else message.client or self._who
        done = by_priority(self._services, self._rig, Command(message.type), who, self._address)

        async def answered() -> Wire:
            return Stopped.model_validate(answer(message.type, await done).model_dump())

        return answered()

    def _frames(self, host: RigHost) -> FrameSource:
        return self._services.frames.setdefault(self._rig, FrameSource(host))

    def _changed(self, revision: int) -> str:
        changed = SessionChanged(revision=revision, server_time=time.time(), session=self._session())
        return changed.model_dump_json()

    def _session(self) -> SessionOut:
        return session_out(self._services.hosts, self._rig, self._services.settings.rig_rate_hz)
