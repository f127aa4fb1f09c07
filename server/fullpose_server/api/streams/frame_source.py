"""What the clients of one stream share: newest sample and session, encoded once for many, and turns to be sent to.

Two hundred clients at 30 frames a second are 6000 frames a second: most of a frame is the same for all who are due
within a few milliseconds, and no request (an E-stop) may wait until all of them have been served.
"""

import asyncio
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

import msgspec

from fullpose_server.api.schemas.stream import Encoding
from fullpose_server.runtime.contract.telemetry import FIELDS, Samples

FRESH_S = 0.004  # how old a sample that is sent as the newest may be at most
SESSION_FRESH_S = 0.05  # the same of a session that has not changed
AT_ONCE = 4  # clients that are sent to in one round of the event loop; then it looks for requests

_encode = msgspec.json.encode


class SampleSource(Protocol):
    """A rig's ring, or a record that stands in for one."""

    def latest(self) -> Samples | None:
        """The newest sample (1,)."""

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Samples after `since_seq`, oldest first, at most `limit`, and how many were lost to the reader."""


class FrameSource:
    """A source of samples with its newest frame kept for `fresh_s`. Belongs to the event loop's thread."""

    def __init__(
        self, source: SampleSource, fresh_s: float = FRESH_S, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.latest = source.latest
        self.samples = source.samples
        self.round_robin = RoundRobin()
        self._fresh_s = fresh_s
        self._clock = clock
        self._until = -1.0
        self._rows: Samples | None = None
        self._seq = 0
        self._bodies: dict[Encoding, bytes] = {}
        self._session: tuple[int, float, str] | None = None  # revision, good until, message

    def newest(self, encoding: Encoding, after: int) -> tuple[int, bytes] | None:
        """Sequence and body of the newest sample in an encoding, read anew for who has had `after`; None before any."""
        now = self._clock()
        if now >= self._until or self._seq <= after:
            rows = self.latest()
            self._until = now + self._fresh_s
            if rows is None or self._rows is None or int(rows["seq"][0]) != self._seq:
                self._rows, self._bodies = rows, {}
                self._seq = 0 if rows is None else int(rows["seq"][0])
        if self._rows is None:
            return None
        body = self._bodies.get(encoding)
        if body is None:
            body = self._bodies[encoding] = encoded(self._rows, encoding)
        return self._seq, body

    def session(self, revision: int, make: Callable[[int], str]) -> str:
        """The message of the session's revision, made anew where it is not the last one or no longer fresh."""
        now = self._clock()
        if self._session is None or self._session[0] != revision or now >= self._session[1]:
            self._session = (revision, now + SESSION_FRESH_S, make(revision))
        return self._session[2]


def encoded(rows: Samples, encoding: Encoding) -> bytes:
    """The part of a frame that is the same for all clients: binary records, or the JSON columns after the envelope."""
    if encoding == "binary":
        return rows.tobytes()
    columns = {field.column: rows[field.name].tolist() for field in FIELDS}
    # msgspec writes nan and infinity as null, which is what JSON has for them.
    return _encode(columns)[1:]


class RoundRobin:
    """Lets `AT_ONCE` waiting clients go on in one round of the event loop, in the order they came."""

    def __init__(self) -> None:
        self._waiting: deque[asyncio.Future[None]] = deque()

    async def turn(self) -> None:
        """Wait for a turn."""
        loop = asyncio.get_running_loop()
        mine: asyncio.Future[None] = loop.create_future()
        self._waiting.append(mine)
        if len(self._waiting) == 1:
            loop.call_soon(self._next)
        await mine

    def _next(self) -> None:
        for _ in range(min(AT_ONCE, len(self._waiting))):
            waiting = self._waiting.popleft()
            if not waiting.done():  # its client may have left
                waiting.set_result(None)
        if self._waiting:
            asyncio.get_running_loop().call_soon(self._next)
