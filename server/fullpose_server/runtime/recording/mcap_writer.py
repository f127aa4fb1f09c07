"""The record of one run: an MCAP file that is written as it happens and opens in Foxglove and Lichtblick.

Samples and events are JSON with their schema inside the file. Chunks are cut by time, so that a crash loses no more
than the last one; what is not yet on the disk when it fills up waits in a bounded buffer.
"""

import os
from pathlib import Path
from typing import Any

import msgspec
from mcap.writer import Writer

from fullpose_server.runtime.contract.telemetry import SAMPLE, Samples
from fullpose_server.session.states import STATES

WAITING_BYTES = 8_000_000
# One plain type a field, and no null: Foxglove and Lichtblick refuse a channel whose schema has more than they know.
# What is not a number, or has no value, is left out of its message.
_NUMBER, _INTEGER, _STRING, _TRUTH = ({"type": kind} for kind in ("number", "integer", "string", "boolean"))
_INTEGERS = ("seq", "time_ns", "wall_ns", "flags", "revision", "tick")


def sample_schema() -> dict[str, Any]:
    """JSON schema of a telemetry message: `SAMPLE`'s fields, the state by name."""
    properties: dict[str, Any] = {}
    for name in SAMPLE.names or ():
        kind = _INTEGER if name in _INTEGERS else _NUMBER
        properties[name] = {"type": "array", "items": _NUMBER} if SAMPLE[name].shape else kind
    properties["state"] = _STRING | {"enum": list(STATES)}
    return {"title": "fullpose.Sample", "type": "object", "properties": properties}


# Of the events of every kind: commands, transitions, alarms, runs.
EVENT_SCHEMA = {
    "title": "fullpose.Event",
    "type": "object",
    "properties": {
        **dict.fromkeys(
            ("kind", "who", "command", "before", "after", "refused", "trigger", "run_id", "rig", "state"), _STRING
        ),
        **dict.fromkeys(("code", "severity", "message", "frame", "unit"), _STRING),
        **dict.fromkeys(("time_ns", "wall_ns", "epoch", "head", "number", "count", "pid"), _INTEGER),
        **dict.fromkeys(("value", "limit", "time_s"), _NUMBER),
        "first": _TRUTH,
    },
}
STATISTICS_SCHEMA = {
    "title": "fullpose.LoopStatistics",
    "type": "object",
    "properties": {
        "ticks": _INTEGER,
        "deadline_misses": _INTEGER,
        "busy_us": _NUMBER,
        "lateness_us": {"type": "object", "properties": dict.fromkeys(("p50", "p99", "p999", "max"), _NUMBER)},
        "free_bytes": _INTEGER,
    },
}


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


class _Chunks(Writer):
    """The library's writer, with chunks cut when we say so (it cuts by size alone)."""

    def cut(self) -> None:
        self._Writer__finalize_chunk()  # type: ignore[attr-defined]  # the library's name for it


class RunRecord:
    """One run's file. `begun_ns` is the monotonic time that `wall_ns` was taken at: log times never step back."""

    def __init__(self, path: Path, run: dict[str, Any], wall_ns: int, begun_ns: int) -> None:
        self.path = path
        self._shift = wall_ns - begun_ns
        self.file = PatientFile(path)
        self._writer = _Chunks(self.file, chunk_size=1 << 30)  # type: ignore[arg-type]  # it needs write, tell, flush
        self._writer.start(profile="", library="fullpose")
        self._samples = self._channel("/telemetry", "fullpose.Sample", sample_schema())
        self._events = self._channel("/events", "fullpose.Event", EVENT_SCHEMA)
        self._statistics = self._channel("/statistics", "fullpose.LoopStatistics", STATISTICS_SCHEMA)
        self._writer.add_metadata("run", {key: _text(value) for key, value in run.items()})
        self.chunks = 0
        self.samples = 0

    def _channel(self, topic: str, title: str, schema: dict[str, Any]) -> int:
        number = self._writer.register_schema(title, "jsonschema", msgspec.json.encode(schema))
        return self._writer.register_channel(topic, "json", number)

    def add_samples(self, rows: Samples) -> None:
        """Add telemetry rows (n,)."""
        columns = {name: rows[name].tolist() for name in SAMPLE.names or ()}
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
        self._writer.cut()
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
