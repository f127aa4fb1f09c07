"""The WebSocket /rigs/{rig}/live: a live source's attitudes in, angles, error and margin back for each of them.

It carries samples, never commands: what the session does with them (arm, go_live, stop) is commanded under the lease as
ever. A source that goes, closed or silent, is lost for the rig process, which stops the rig inside its limits.
"""

import asyncio
import math
from typing import Any

import msgspec
from fastapi import APIRouter, WebSocket
from pydantic import TypeAdapter

from fullpose_server.api.commanding import audit, with_rig_file
from fullpose_server.api.deps import AddressDep, PersonDep, Services, ServicesDep, WhoDep
from fullpose_server.api.errors import problem_of
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.live import (
    STATUS_NAMES,
    LiveIn,
    LiveOpened,
    LiveProblem,
    LiveSampleIn,
    OpenLive,
)
from fullpose_server.api.schemas.session import LiveLoad
from fullpose_server.api.stopping import answer
from fullpose_server.api.streams.live_link import LinkLostError, LiveLink, split
from fullpose_server.api.streams.tasks import GoneError, close_for, send_bytes, send_text
from fullpose_server.people.admitted import Credential
from fullpose_server.runtime.live.packets import Kind, LiveReply, LiveStatus, encode_sample
from fullpose_server.runtime.supervisor.errors import HostError
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.secret import new_secret

GONE = 4503
router = APIRouter(tags=["live"])
_INCOMING: TypeAdapter[LiveIn] = TypeAdapter(LiveIn)
_KINDS = {
    ("nue", True): Kind.QUATERNION,
    ("ned", True): Kind.QUATERNION_NED,
    ("nue", False): Kind.EULER,
    ("ned", False): Kind.EULER_NED,
}


@router.websocket("/rigs/{rig}/live")
async def live(
    rig: str, socket: WebSocket, services: ServicesDep, person: PersonDep, who: WhoDep, address: AddressDep
) -> None:
    """open, then samples; each is answered once the rig's loop has taken it. One source a rig."""
    await asyncio.to_thread(services.rigs.get, rig)
    if rig in services.live_sources:
        raise ApiError(409, "source-taken", f"a live source is connected to {rig} already")
    services.live_sources.add(rig)
    try:
        host = await services.hosts.ensure(rig)
        with LiveLink(host.live_socket()) as link:
            await socket.accept()
            await _Source(services, socket, host, link, person, who, address).run()
    except HostError as error:
        raise ApiError(503, "rig-process", str(error)) from None
    finally:
        services.live_sources.discard(rig)


class _Source:
    def __init__(
        self,
        services: Services,
        socket: WebSocket,
        host: RigHost,
        link: LiveLink,
        person: Credential | None,
        who: str,
        address: str | None,
    ) -> None:
        self._services = services
        self._person = person
        self._socket = socket
        self._host = host
        self._link = link
        self._who = who
        self._address = address
        self._convention: str | None = None
        self._sequence = 0
        self._binary = False

    async def run(self) -> None:
        tasks = [
            asyncio.create_task(self._take(), name="live samples"),
            asyncio.create_task(self._answer(), name="live replies"),
        ]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            ends = await asyncio.gather(*tasks, return_exceptions=True)
        for end in ends:
            if isinstance(end, LinkLostError):
                gone = ApiError(503, "rig-process", f"{self._host.name}: the rig process is gone ({end})")
                await close_for(self._socket, _problem(gone), GONE)
            elif isinstance(end, Exception) and not isinstance(end, GoneError):
                await close_for(self._socket, _problem(end))

    async def _take(self) -> None:
        while True:
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            try:
                data: bytes | None = message.get("bytes")
                if data is not None:
                    await self._datagrams(data)
                else:
                    await self._text(message["text"])
            except (ApiError, ValueError) as error:
                await self._tell(error)

    async def _datagrams(self, data: bytes) -> None:
        self._opened()
        samples = split(data)
        if samples is None:
            raise ApiError(422, "validation", f"{len(data)} bytes: expected samples of 80 bytes each")
        self._binary = True
        for sample in samples:
            if not await self._link.send(sample):
                raise ApiError(422, "validation", "expected a sample: FPA1, a kind, finite numbers, a unit quaternion")

    async def _text(self, text: str) -> None:
        message = _INCOMING.validate_json(text)
        if isinstance(message, OpenLive):
            await self._open(message)
            return
        self._binary = False
        datagram = self._datagram(message, self._opened())
        if not await self._link.send(datagram):
            raise ApiError(422, "validation", f"q = {message.q}: expected a unit quaternion")
        self._sequence += 1

    def _datagram(self, message: LiveSampleIn, convention: str) -> bytes:
        kind = _KINDS[convention, message.q is not None]
        numbers = message.q if message.q is not None else message.euler_deg or ()
        return encode_sample(kind, self._sequence, message.time_s, numbers, message.body_rate_deg_s or ())

    def _opened(self) -> str:
        if self._convention is None:
            raise ApiError(422, "not-open", "expected an open message before samples")
        return self._convention

    async def _open(self, message: OpenLive) -> None:
        key = message.key or new_secret()
        if message.lease is None:
            answer("live", await self._host.prove_live(self._who, key))  # raises the refusal
        else:
            settings = message.model_dump(include=set(LiveLoad.model_fields))
            args = await with_rig_file(self._services, self._host.name, {"live": settings})
            reply = await self._host.command("load", args, self._who, message.lease.shown(self._person), key)
            numbers = message.lease.epoch, message.lease.sequence
            made = {"live": settings}
            audit(self._services, self._host.name, self._who, "load", made, numbers, reply, self._address)
            answer("load", reply)  # raises the refusal
        self._convention = message.convention
        self._link.prove(key)
        snapshot = self._host.snapshot()
        await self._say(
            LiveOpened.model_validate(
                {
                    "rig": self._host.name,
                    "state": snapshot.state,
                    "rate_hz": self._host.rate_hz,
                    "loaded": snapshot.plan is not None and snapshot.plan.live,
                }
            )
        )

    async def _answer(self) -> None:
        while True:
            for datagram in await self._link.replies():
                reply, age = self._link.read(datagram)
                if self._binary:
                    await send_bytes(self._socket, datagram)
                else:
                    await send_text(self._socket, reply_json(reply, age))

    async def _say(self, message: Wire) -> None:
        await send_text(self._socket, message.model_dump_json())

    async def _tell(self, error: Exception) -> None:
        await send_text(self._socket, _problem(error))


def _problem(error: Exception) -> str:
    return LiveProblem(problem=problem_of(error)).model_dump_json()


def reply_json(reply: LiveReply, age_s: float | None) -> str:
    """A `LiveReplyOut`; not built as a model, which would take longer than all the rest at 1 kHz."""
    message: dict[str, Any] = {
        "type": "reply",
        "sequence": reply.sequence,
        "time_s": reply.time_s,
        "status": [name for bit, name in STATUS_NAMES.items() if reply.status & bit],
        "angles_deg": reply.angles,
        "error_deg": reply.error_deg,
        "lag_deg": reply.lag_deg,
        "margin": reply.margin if math.isfinite(reply.margin) else None,
        "latency_us": reply.latency_us,
        "server_latency_us": None if age_s is None else age_s * 1e6,
        "refused": None,
    }
    if reply.status & LiveStatus.IMPLAUSIBLE:
        message["refused"] = {"code": "implausible_rate", "value": reply.value, "limit": reply.limit, "unit": "deg/s"}
    return msgspec.json.encode(message).decode()
