"""The record of one run: an MCAP file that is written as it happens and opens in Foxglove and Lichtblick.

Samples and events are JSON with their schema inside the file. Chunks are cut by time, so that a crash loses no more
than the last one; what is not yet on the disk when it fills up waits in a bounded buffer.
"""

import os
from pathlib import Path
from typing import Any

import msgspec
from mcap.writer import Writer

from fullpose_server.runtime.contract.telemetry import FIELDS, Samples
from fullpose_server.runtime.recording import channels
from fullpose_server.session.states import STATES

WAITING_BYTES = 8_000_000


class PatientFile:
    """A file whose bytes wait where the disk is full: `write` never fails, `push` says why it could not.

    `check` raises `BufferError` where more than `WAITING_BYTES` wait: then the record ends, readable as far as it is.
    """

    def __init__(self, path: Path) -> None:
        self._fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        self._waiting = bytearray()
        self.length = 0  # of what was given, written or not

    def write(self, data: bytes) -> int:
        """Take `data`."""
        self._waiting += data
        self.length += len(data)
        return len(data)

    def tell(self) -> int:
        """The offset of the next byte."""
        return self.length

    def flush(self) -> None:
        """Nothing: `push` writes."""

    def push(self) -> None:
        """Write what waits. Raises OSError where the disk refuses; what is left waits on."""
        while self._waiting:
            written = os.write(self._fd, self._waiting)
            del self._waiting[:written]

    def check(self) -> None:
        """Raise `BufferError` where too much waits."""
        if len(self._waiting) > WAITING_BYTES:
            raise BufferError(f"{len(self._waiting)} bytes could not be written")

    def close(self) -> None:
        """Close; what still waits is lost."""
        os.close(self._fd)


class RunRecord:
    """One run's file. `begun_ns` is the monotonic time that `wall_ns` was taken at: log times never step back."""

    def __init__(self, path: Path, run: dict[str, Any], wall_ns: int, begun_ns: int) -> None:
        self.path = path
        self._shift = wall_ns - begun_ns
        self.file = PatientFile(path)
        # Chunks are cut by time, in `cut`: never by size.
        self._writer = Writer(self.file, chunk_size=1 << 30)  # type: ignore[arg-type]  # it needs write, tell, flush
        self._writer.start(profile="", library="fullpose")
        self._samples = channels.register(self._writer, channels.TELEMETRY)
        self._events = channels.register(self._writer, channels.EVENTS)
        self._statistics = channels.register(self._writer, channels.STATISTICS)
        self._writer.add_metadata("run", {key: _text(value) for key, value in run.items()})
        self.chunks = 0
        self.samples = 0

    def add_samples(self, rows: Samples) -> None:
        """Add telemetry rows (n,)."""
        columns = {field.name: rows[field.name].tolist() for field in FIELDS}
        columns["state"] = [STATES[code] for code in columns["state"]]
        names = tuple(columns)
        times = columns["time_ns"]
        for time_ns, sequence, values in zip(times, columns["seq"], zip(*columns.values(), strict=True), strict=True):
            at = time_ns + self._shift
            data = msgspec.json.encode({name: v for name, v in zip(names, values, strict=True) if _is_told(v)})
            self._writer.add_message(self._samples, at, data, at, sequence & 0xFFFFFFFF)
        self.samples += len(rows)

    def add_event(self, event: dict[str, Any]) -> None:
        """Add one event of the loop."""
        at = event["time_ns"] + self._shift
        told = {name: value for name, value in event.items() if value is not None and _is_told(value)}
        self._writer.add_message(self._events, at, msgspec.json.encode(told), at)

    def add_statistics(self, time_ns: int, statistics: dict[str, Any]) -> None:
        """Add the loop's statistics."""
        at = time_ns + self._shift
        self._writer.add_message(self._statistics, at, msgspec.json.encode(statistics), at)

    def cut(self) -> None:
        """End the chunk and write it. Raises OSError where the disk refuses (it waits), BufferError where it waits
        for too long."""
        self._writer.flush()  # type: ignore[no-untyped-call]
        self.chunks += 1
        try:
            self.file.push()
        finally:
            self.file.check()

    def finish(self) -> None:
        """Write the index and close. Raises OSError where the disk refuses: the file is readable without index."""
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
            self.file.push()
        finally:
            self.file.close()


def _is_told(value: Any) -> bool:
    """False for what is not a number; of four numbers, where none is. A lone one among them becomes null."""
    if isinstance(value, list):
        return any(item == item for item in value)
    return bool(value == value)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()
