"""Samples of one client into the rig process and its replies back, without a queue of our own.

The rig's socket takes what it has room for; where it is full, the client is not read from until there is room. Replies
that nobody fetches stay in the socket and then are not sent: who does not read them does not get them.
"""

import asyncio
import socket
import time
from collections import OrderedDict
from types import TracebackType
from typing import Self

from fullpose_server.runtime.live.packets import (
    REPLY_SIZE,
    SAMPLE_SIZE,
    LiveReply,
    decode_reply,
    decode_sample,
)
from fullpose_server.runtime.live.provenance import digest_of

PENDING = 4096  # samples whose arrival is remembered: as many as four seconds at 1 kHz


class LinkLostError(Exception):
    """The rig process is gone."""


class LiveLink:
    """A live socket of a rig (`RigHost.live_socket`), for one client. Use `with`."""

    def __init__(self, link: socket.socket) -> None:
        self._link = link
        self._loop = asyncio.get_running_loop()
        self._readable = asyncio.Event()
        self._arrived: OrderedDict[int, float] = OrderedDict()
        self._digest = b""

    def __enter__(self) -> Self:
        self._loop.add_reader(self._link, self._readable.set)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._loop.remove_reader(self._link)
        self._loop.remove_writer(self._link)
        self._link.close()

    def prove(self, key: str) -> None:
        """Hand samples on as those of the source that has `key`."""
        self._digest = digest_of(key)

    async def send(self, sample: bytes) -> bool:
        """Hand one datagram on, waiting for room; False where it is no sample. Raises `LinkLostError`."""
        decoded = decode_sample(sample)
        if decoded is None:
            return False
        self._arrived[decoded.sequence] = time.monotonic()
        if len(self._arrived) > PENDING:
            self._arrived.popitem(last=False)
        while True:
            try:
                self._link.send(sample + self._digest)
            except BlockingIOError:
                await self._room()
            except OSError as cause:
                raise LinkLostError(str(cause)) from cause
            else:
                return True

    async def replies(self) -> list[bytes]:
        """The datagrams that have come, at least one. Raises `LinkLostError`."""
        found: list[bytes] = []
        while not found:
            await self._readable.wait()
            self._readable.clear()
            try:
                while True:
                    found.append(self._link.recv(REPLY_SIZE + 1))
            except BlockingIOError:
                continue
            except OSError as cause:
                raise LinkLostError(str(cause)) from cause
        return found

    def read(self, datagram: bytes) -> tuple[LiveReply, float | None]:
        """The reply, and how long ago [s] its sample came in; None where that was forgotten."""
        reply = decode_reply(datagram)
        if reply is None:
            raise LinkLostError(f"the rig process answered with {len(datagram)} bytes that are no reply")
        arrived = self._arrived.pop(reply.sequence, None)
        return reply, None if arrived is None else time.monotonic() - arrived

    async def _room(self) -> None:
        ready = asyncio.Event()
        self._loop.add_writer(self._link, ready.set)
        try:
            await ready.wait()
        finally:
            self._loop.remove_writer(self._link)


def split(message: bytes) -> list[bytes] | None:
    """The datagrams of a binary message; None where its length is no multiple of theirs."""
    if not message or len(message) % SAMPLE_SIZE:
        return None
    return [message[k : k + SAMPLE_SIZE] for k in range(0, len(message), SAMPLE_SIZE)]
