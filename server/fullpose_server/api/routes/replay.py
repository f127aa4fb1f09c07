"""The WebSocket /runs/{run}/stream: a recorded run through the protocol of the live stream, with a scene of its own.

It plays from the first subscription on, unless the client has said pause before.
"""

import asyncio
import secrets
import time
from collections.abc import AsyncIterator, Awaitable
from pathlib import Path
from typing import Any

from fastapi import APIRouter, WebSocket

from fullpose_server.api.deps import Services, ServicesDep
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.session import SessionOut
from fullpose_server.api.schemas.stream import Hello, Playback, Replayed, ReplayOf, SessionChanged, StopNow
from fullpose_server.api.session_view import replayed_session
from fullpose_server.api.streams.frame_source import FrameSource
from fullpose_server.api.streams.frames import record
from fullpose_server.api.streams.stream_client import StreamClient
from fullpose_server.errors import FileError
from fullpose_server.runtime.contract.telemetry import FIELDS
from fullpose_server.runtime.recording.mcap_reader import RecordError
from fullpose_server.runtime.recording.playback import PlaybackError, RunPlayback
from fullpose_server.runtime.recording.run_index import is_being_written

MOST_REPLAYS = 8  # one that is still written is in memory: ten minutes at 1 kHz are some 200 MB
LOOK_S = 1.0 / 30.0
router = APIRouter(tags=["stream"])


@router.websocket("/runs/{run}/stream")
async def replay_stream(run: str, socket: WebSocket, services: ServicesDep) -> None:
    """hello, then what the client subscribes to; seek, speed, pause and play move the clock of this client alone."""
    path = await asyncio.to_thread(services.runs.path, run)
    if len(services.replays) >= MOST_REPLAYS:
        raise ApiError(503, "too-many-replays", f"{MOST_REPLAYS} records are being played: each is held in memory")
    # Of this client alone: others replay the same run at other times. No rig has a ~ in its name.
    scene = f"run-{run}~{secrets.token_hex(4)}"
    services.replays.add(scene)
    try:
        await _play(run, scene, path, socket, services)
    finally:
        services.replays.discard(scene)


async def _play(run: str, scene: str, path: Path, socket: WebSocket, services: Services) -> None:
    rig = (await asyncio.to_thread(services.runs.get, run)).rig
    try:
        playback = await _playback(run, path, services)
    except RecordError as error:
        raise FileError(path.name, f"a record ({error})") from None
    source = _Run(playback, rig, scene)
    await asyncio.to_thread(services.scenes.add, source.scene, rig, source.newest)
    try:
        await socket.accept()
        await StreamClient(socket, source).run()
    finally:
        await asyncio.to_thread(services.scenes.remove, source.scene)


async def _playback(run: str, path: Path, services: Services) -> RunPlayback:
    """Of a record that is still being written what is there now, in memory; of any other by its curves."""
    if await asyncio.to_thread(is_being_written, path):
        return await asyncio.to_thread(RunPlayback, path)
    curves = await services.curves.made(run)
    return await asyncio.to_thread(RunPlayback, path, curves=curves)


class _Run:
    def __init__(self, playback: RunPlayback, rig: str, scene: str) -> None:
        self._playback = playback
        self._rig = rig
        self._begun = False
        self.scene = scene

    def hello(self) -> Hello:
        first = self._playback.latest()
        return Hello(
            server_time=time.time(),
            rig=self._rig,
            session=self._session(),
            fields=[field.name for field in FIELDS],
            record=record(),
            replay=ReplayOf(
                run=self._playback.run,
                duration_s=self._playback.duration_s,
                started=None if first is None else float(first["wall_ns"][0]) / 1e9,
                scene=f"/scene/{self.scene}/",
            ),
        )

    def newest(self) -> Any:
        """The sample for the scene."""
        rows = self._playback.latest()
        return None if rows is None else rows[0]

    async def samples(self) -> FrameSource:
        self._begin()
        return FrameSource(self._playback, fresh_s=0.0)

    async def changes(self) -> AsyncIterator[str]:
        self._begin()
        shown: tuple[int, str] | None = None
        told: tuple[bool, float] | None = None
        while True:
            status = self._status()
            if (now := (status.playing, status.factor)) != told:
                told = now
                yield status.model_dump_json()
            session = self._session()
            if (state := (session.revision, session.state)) != shown:
                shown = state
                changed = SessionChanged(revision=session.revision, server_time=time.time(), session=session)
                yield changed.model_dump_json()
            await asyncio.sleep(LOOK_S)

    def control(self, message: Playback) -> Wire:
        try:
            match message.type:
                case "seek":
                    self._playback.seek(message.time_s)
                case "speed":
                    self._playback.speed(message.factor)
                case "pause":
                    self._begun = True
                    self._playback.pause()
                case "play":
                    self._begun = True
                    self._playback.play()
        except PlaybackError as error:
            raise ApiError(422, "validation", str(error)) from None
        return self._status()

    def stop(self, message: StopNow) -> Awaitable[Wire]:
        raise ApiError(422, "not-a-rig", f"{message.type}: a record cannot be stopped")

    def _begin(self) -> None:
        if not self._begun:
            self._begun = True
            self._playback.play()

    def _status(self) -> Replayed:
        time_s, playing, factor = self._playback.position
        return Replayed(time_s=time_s, playing=playing, factor=factor)

    def _session(self) -> SessionOut:
        rows = self._playback.latest()
        return replayed_session(self._rig, self._playback, None if rows is None else rows[0])
