"""Telemetry frames of one client: which samples, in JSON columns or as binary records."""

import struct
import time
from collections.abc import Iterator

import msgspec

from server.api.wire_stream import Record, RecordField, Subscribe
from server.runtime.host import RigHost
from server.runtime.telemetry import SAMPLE, Samples, dtype_description

HEADER = struct.Struct("<4sHHQdQ")
MAGIC, VERSION = b"FPT1", 1
MOST = 1000  # samples in one frame; a client that asks for more at its rate gets several
BEHIND = 20_000  # samples that are sent in one go to a client that has fallen back

_encode = msgspec.json.encode


def record() -> Record:
    """The binary record, for hello."""
    return Record(size=SAMPLE.itemsize, fields=[RecordField(**field) for field in dtype_description()])


class FrameMaker:
    """What to send next: the newest sample, or all since the last frame. Keeps one position in the ring."""

    def __init__(self, host: RigHost, wanted: Subscribe) -> None:
        self._host = host
        self._wanted = wanted
        newest = host.latest()
        now = 0 if newest is None else int(newest["seq"][0])
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
        newest = self._host.latest()
        if newest is not None and int(newest["seq"][0]) != self._position:
            self._position = int(newest["seq"][0])
            yield self._frame(newest)

    def _all(self) -> Iterator[str | bytes]:
        sent = 0
        while sent < BEHIND:
            rows, lost = self._host.samples(self._position, MOST)
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
