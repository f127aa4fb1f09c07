"""Reading records back: whole files, files that a crash cut off, and telemetry rows as the stream has them."""

import struct
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Chunk, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import Writer

from server.runtime.telemetry import SAMPLE, Samples
from server.session.states import STATES

# What the library raises at the end of a file that was cut off.
_CUT = (McapError, EOFError, ValueError, struct.error)
_CODES = {str(state): code for code, state in enumerate(STATES)}
_BATCH = 4096
_DECODE = msgspec.json.Decoder().decode


class RecordError(Exception):
    """A file that is no record: which, and why."""


def recover_messages(path: Path) -> Iterator[tuple[str, Message]]:
    """(topic, message) of every message that can be read, up to where the file was cut off. Raises `RecordError`."""
    topics: dict[int, str] = {}
    with path.open("rb") as file:
        records = StreamReader(file, emit_chunks=True, validate_crcs=False).records
        try:
            for record in records:
                inner = breakup_chunk(record, True) if isinstance(record, Chunk) else [record]
                for item in inner:
                    if isinstance(item, Channel):
                        topics[item.id] = item.topic
                    elif isinstance(item, Message):
                        yield topics[item.channel_id], item
        except _CUT as cause:
            # A cut in the last chunk is what a crash leaves; a file without a single channel is something else.
            if not topics:
                raise RecordError(f"{path}: not a record ({cause!r})") from cause


def run_of(path: Path) -> dict[str, str]:
    """The run's metadata: run_id, who, plan. Raises `RecordError` where there is none."""
    with path.open("rb") as file:
        try:
            for record in StreamReader(file, emit_chunks=True, validate_crcs=False).records:
                if isinstance(record, Metadata) and record.name == "run":
                    return dict(record.metadata)
        except _CUT as cause:
            raise RecordError(f"{path}: not a record ({cause!r})") from cause
    raise RecordError(f"{path}: no run in it")


def is_whole(path: Path) -> bool:
    """Whether the file was completed: it has its index."""
    with path.open("rb") as file:
        try:
            return make_reader(file).get_summary() is not None
        except (*_CUT, OSError):
            return False


def read_samples(path: Path, since_seq: int = 0, limit: int | None = None) -> Samples:
    """Telemetry rows (n,) of a record after `since_seq`, in order, as the live ring gives them."""
    wanted = (
        _row(raw)
        for topic, message in recover_messages(path)
        if topic == "/telemetry" and (raw := _DECODE(message.data))["seq"] > since_seq
    )
    # As arrays soon: a row is ten times as large while its numbers are objects.
    parts = []
    while batch := list(islice(wanted, _BATCH if limit is None else min(_BATCH, limit))):
        parts.append(np.array(batch, dtype=SAMPLE))
        if limit is not None:
            limit -= len(batch)
    rows = np.empty(sum(len(part) for part in parts), SAMPLE)  # np.concatenate would leave the padding out
    if parts:
        np.concatenate(parts, out=rows)
    return rows


def read_events(path: Path) -> list[dict[str, Any]]:
    """The events of a record: commands, transitions, alarms."""
    return [_DECODE(message.data) for topic, message in recover_messages(path) if topic == "/events"]


def repair(path: Path, to: Path) -> int:
    """Write a whole file `to` from what can be read of `path`; returns the messages kept. Raises `RecordError`."""
    kept = 0
    schemas: dict[str, int] = {}
    with to.open("xb") as file:
        writer = Writer(file)
        writer.start(profile="", library="fullpose recovery")
        writer.add_metadata("run", run_of(path))
        for topic, message in recover_messages(path):
            if topic not in schemas:
                schemas[topic] = writer.register_channel(topic, "json", _schema(writer, topic))
            writer.add_message(schemas[topic], message.log_time, message.data, message.publish_time, message.sequence)
            kept += 1
        writer.finish()  # type: ignore[no-untyped-call]
    return kept


def _schema(writer: Writer, topic: str) -> int:
    from server.runtime.record import EVENT_SCHEMA, STATISTICS_SCHEMA, sample_schema

    schema = {"/telemetry": sample_schema(), "/events": EVENT_SCHEMA, "/statistics": STATISTICS_SCHEMA}[topic]
    return int(writer.register_schema(str(schema["title"]), "jsonschema", msgspec.json.encode(schema)))


def _row(raw: dict[str, Any]) -> tuple[Any, ...]:
    values = []
    for name in SAMPLE.names or ():
        value = raw.get(name)
        if name == "state":
            value = _CODES[raw[name]]
        elif value is None:  # not a number, or four that are none
            value = (np.nan,) * 4 if SAMPLE[name].shape else np.nan
        elif isinstance(value, list):
            value = [np.nan if item is None else item for item in value]
        values.append(value)
    return tuple(values)


class Replay:
    """A record in place of a live ring: the same `since` and `latest`, moved along by `seek`."""

    def __init__(self, path: Path) -> None:
        self._rows = read_samples(path)
        self._head = 0

    @property
    def duration_s(self) -> float:
        """From the first row to the last [s]."""
        return float(self._rows["time_ns"][-1] - self._rows["time_ns"][0]) / 1e9 if len(self._rows) else 0.0

    def seek(self, time_s: float) -> None:
        """To `time_s` after the first row."""
        if len(self._rows):
            at = self._rows["time_ns"][0] + int(time_s * 1e9)
            self._head = int(np.searchsorted(self._rows["time_ns"], at, side="right"))

    def since(self, sequence: int, limit: int) -> tuple[Samples, int]:
        """Rows after `sequence` up to where the replay stands, at most `limit`; nothing is ever lost."""
        first = int(np.searchsorted(self._rows["seq"], sequence, side="right"))
        return self._rows[first : min(self._head, first + limit)], 0

    def latest(self) -> Samples | None:
        """The row where the replay stands (1,)."""
        return self._rows[self._head - 1 : self._head] if self._head else None
