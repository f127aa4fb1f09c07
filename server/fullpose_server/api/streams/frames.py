"""Telemetry frames of one client: which samples, in JSON columns or as binary records."""

import struct
import time
from collections.abc import Iterator

from fullpose_server.api.schemas.stream import Record, RecordField, Subscribe
from fullpose_server.api.streams.frame_source import FrameSource, encoded
from fullpose_server.runtime.contract.telemetry import SAMPLE, dtype_description

HEADER = struct.Struct("<4sHHQdQ")
MAGIC, VERSION = b"FPT1", 1
MOST = 1000  # samples in one frame; a client that asks for more at its rate gets several
BEHIND = 20_000  # samples that are sent in one go to a client that has fallen back


def record() -> Record:
    """The binary record, for hello."""
    return Record(size=SAMPLE.itemsize, fields=[RecordField(**field) for field in dtype_description()])


class FrameMaker:
    """What to send next: the newest sample, or all since the last frame. Keeps one position in the source."""

    def __init__(self, source: FrameSource, wanted: Subscribe, *, from_newest: bool = False) -> None:
        """Begin after the newest sample, or after `wanted.since_seq`; with `from_newest` with the newest itself."""
        self._source = source
        self._wanted = wanted
        newest = source.latest()
        now = 0 if newest is None else int(newest["seq"][0])
        if from_newest:
            self._position, self._every = max(0, now - 1), wanted.every_sample
            self.dropped = 0
            return
        self._position = now if wanted.since_seq is None else wanted.since_seq
        self._every = wanted.every_sample or wanted.since_seq is not None
        self.dropped = 0

    def missed(self, frames: int) -> None:
        """Count frames that were due and could not be sent; with `every_sample` the ring tells what is lost."""
        if not self._wanted.every_sample:
            self.dropped += frames

    def take(self) -> Iterator[str | bytes]:
        """The frames due now."""
        if self._every:
            yield from self._all()
            # After a resume the client has caught up, and gets the newest only unless it asked for all.
            self._every = self._wanted.every_sample
            return
        newest = self._source.newest(self._wanted.encoding, self._position)
        if newest is not None and newest[0] != self._position:
            self._position, body = newest
            yield self._frame(body, 1)

    def _all(self) -> Iterator[str | bytes]:
        sent = 0
        while sent < BEHIND:
            rows, lost = self._source.samples(self._position, MOST)
            self.dropped += lost
            if not len(rows):
                return
            self._position = int(rows["seq"][-1])
            sent += len(rows)
            yield self._frame(encoded(rows, self._wanted.encoding), len(rows))

    def _frame(self, body: bytes, count: int) -> str | bytes:
        """`body` in this client's own envelope."""
        if self._wanted.encoding == "binary":
            return HEADER.pack(MAGIC, VERSION, count, self._position, time.time(), self.dropped) + body
        own = f'"seq":{self._position},"server_time":{time.time()!r},"dropped":{self.dropped}'
        return f'{{"type":"telemetry",{own},{body.decode()}'
