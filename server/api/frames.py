"""Telemetry frames of one client: which samples, in JSON columns or as binary records."""

import struct
import time
from collections.abc import Iterator
from typing import Protocol

import msgspec

from server.api.wire_stream import Record, RecordField, Subscribe
from server.runtime.telemetry import SAMPLE, Samples, dtype_description

HEADER = struct.Struct("<4sHHQdQ")
MAGIC, VERSION = b"FPT1", 1
MOST = 1000  # samples in one frame; a client that asks for more at its rate gets several
BEHIND = 20_000  # samples that are sent in one go to a client that has fallen back

_encode = msgspec.json.encode


def record() -> Record:
    """The binary record, for hello."""
    return Record(size=SAMPLE.itemsize, fields=[RecordField(**field) for field in dtype_description()])


class SampleSource(Protocol):
    """A rig's ring, or a record that stands in for one."""

    def latest(self) -> Samples | None:
        """The newest sample (1,)."""

    def samples(self, since_seq: int, limit: int) -> tuple[Samples, int]:
        """Samples after `since_seq`, oldest first, at most `limit`, and how many were lost to the reader."""


class FrameMaker:
    """What to send next: the newest sample, or all since the last frame. Keeps one position in the source."""

    def __init__(self, source: SampleSource, wanted: Subscribe, *, from_newest: bool = False) -> None:
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
        newest = self._source.latest()
        if newest is not None and int(newest["seq"][0]) != self._position:
            self._position = int(newest["seq"][0])
            yield self._frame(newest)

    def _all(self) -> Iterator[str | bytes]:
        sent = 0
        while sent < BEHIND:
            rows, lost = self._source.samples(self._position, MOST)
            self.dropped += lost
            if not len(rows):
                return
            self._position = int(rows["seq"][-1])
            sent += len(rows)
            yield self._frame(rows)

    def _frame(self, rows: Samples) -> str | bytes:
        if self._wanted.encoding == "binary":
            header = HEADER.pack(MAGIC, VERSION, len(rows), self._position, time.time(), self.dropped)
            return header + rows.tobytes()
        return telemetry_json(rows, self._position, self.dropped)


def telemetry_json(rows: Samples, seq: int, dropped: int) -> str:
    """A `Telemetry` message; what is not a number is null."""
    message: dict[str, object] = {
        "type": "telemetry",
        "seq": seq,
        "server_time": time.time(),
        "dropped": dropped,
        "sample_seq": rows["seq"].tolist(),
    }
    for name in SAMPLE.names or ():
        if name != "seq":
            message[name] = rows[name].tolist()
    # msgspec writes nan and infinity as null, which is what JSON has for them.
    return _encode(message).decode()
