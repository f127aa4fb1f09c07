"""Reading records back: whole files, files that a crash cut off, and telemetry rows as the stream has them.

Of a damaged file everything that is still as it was written is read: what is cut off or fails its checksum is left out.
"""

import os
import struct
from collections.abc import Callable, Iterator
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import msgspec
import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Channel, Chunk, Message, Metadata
from mcap.stream_reader import breakup_chunk, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC

from fullpose_server.runtime.contract.telemetry import FIELDS, SAMPLE, Samples
from fullpose_server.runtime.recording.channels import EVENTS, TELEMETRY
from fullpose_server.session.states import STATES

_CODES = {str(state): code for code, state in enumerate(STATES)}
_BATCH = 4096
_DECODE = msgspec.json.Decoder(dict[str, Any]).decode
_FRAME = struct.Struct("<BQ")  # before each record: its opcode, and the length of its content
_T = TypeVar("_T")


class RecordError(Exception):
    """A file that is no record: which, and why."""

    def __init__(self, path: Path, why: str) -> None:
        super().__init__(f"{path}: {why}")
        self.path = path
        self.why = why


class _Exact(BytesIO):
    """Of a record's content. The library takes what there is where less is left than a length in it says."""

    def read(self, size: int | None = -1, /) -> bytes:
        data = super().read(size)
        if size is not None and len(data) < size:
            raise EndOfFile
        return data


def stream_of(content: bytes) -> ReadDataStream:
    """A record's content for the library to read; what is cut off raises `EndOfFile`."""
    return ReadDataStream(_Exact(content))


def recover_messages(path: Path) -> Iterator[tuple[str, Message]]:
    """(topic, message) of every message that is as it was written. Raises `RecordError`.

    A chunk that cannot be decoded or fails its checksum is passed over; the file ends where it was cut off.
    """
    topics: dict[int, str] = {}
    begun = False
    with path.open("rb") as file:
        for opcode, content in contents(path, file):
            begun = begun or opcode == Opcode.METADATA
            if opcode == Opcode.CHUNK:
                for item in decoded(content, breakup_chunk) or ():
                    if isinstance(item, Channel):
                        topics[item.id] = item.topic
                    elif isinstance(item, Message) and item.channel_id in topics:
                        yield topics[item.channel_id], item
    # A run that was cut off before its first chunk is a run; a file that never began as one is something else.
    if not topics and not begun:
        raise RecordError(path, "not a record: nothing in it can be read")


def run_of(path: Path) -> dict[str, str]:
    """The run's metadata: run_id, rig, who, plan; of an incident its alarm's code. Raises `RecordError`."""
    with path.open("rb") as file:
        for opcode, content in contents(path, file):
            if opcode == Opcode.METADATA:
                try:
                    found = Metadata.read(stream_of(content))
                except Exception as cause:  # see `decoded`
                    raise RecordError(path, f"its run's description is damaged ({cause!r})") from cause
                if found.name == "run":
                    return dict(found.metadata)
    raise RecordError(path, "no run in it")


def is_complete(path: Path) -> bool:
    """Whether the file was completed (it has its index), and every chunk is as it was written."""
    with path.open("rb") as file:
        try:
            summary = make_reader(file).get_summary()
        except Exception:  # noqa: BLE001 - see `decoded`
            return False
        if summary is None or summary.statistics is None:
            return False
        file.seek(0)
        chunks = 0
        try:
            for opcode, content in contents(path, file):
                if opcode == Opcode.CHUNK:
                    if decoded(content, get_chunk_data_stream) is None:
                        return False
                    chunks += 1
        except RecordError:
            return False
        return chunks == summary.statistics.chunk_count


def contents(path: Path, file: BinaryIO) -> Iterator[tuple[int, bytes]]:
    """(opcode, content) of the file's records, up to where it was cut off. Raises `RecordError`."""
    if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
        raise RecordError(path, "not a record: it does not begin as one")
    size = os.fstat(file.fileno()).st_size
    while len(frame := file.read(_FRAME.size)) == _FRAME.size:
        opcode, length = _FRAME.unpack(frame)
        # No record has opcode 0: a power cut leaves zeros where the data had not reached the disk.
        if opcode == 0 or length > size - file.tell():
            return
        yield opcode, file.read(length)


def decoded(content: bytes, how: Callable[[Chunk, bool], _T]) -> _T | None:
    """What `how` finds in a chunk, its checksum compared; None where the chunk is damaged."""
    try:
        return how(Chunk.read(stream_of(content)), True)
    except Exception:  # noqa: BLE001 - damaged bytes may be anything, and each decoder has errors of its own for them
        return None


def read_record(path: Path) -> tuple[Samples, list[dict[str, Any]]]:
    """Telemetry rows (n,), and the events, of a record, in order. Raises `RecordError`."""
    events: list[dict[str, Any]] = []

    def telemetry() -> Iterator[dict[str, Any]]:
        for topic, message in recover_messages(path):
            if topic == TELEMETRY:
                yield _DECODE(message.data)
            elif topic == EVENTS:
                events.append(_DECODE(message.data))

    return _rows(path, telemetry(), None), events


def read_samples(path: Path, since_seq: int = 0, limit: int | None = None) -> Samples:
    """Telemetry rows (n,) of a record after `since_seq`, in order, as the live ring gives them.

    Raises `RecordError`.
    """
    messages = (_DECODE(message.data) for topic, message in recover_messages(path) if topic == TELEMETRY)
    return _rows(path, (raw for raw in messages if raw["seq"] > since_seq), limit)


def _rows(path: Path, messages: Iterator[dict[str, Any]], limit: int | None) -> Samples:
    wanted = (row_of(raw) for raw in messages)
    # As arrays soon: a row is ten times as large while its numbers are objects.
    parts = []
    try:
        while batch := list(islice(wanted, _BATCH if limit is None else min(_BATCH, limit))):
            parts.append(np.array(batch, dtype=SAMPLE))
            if limit is not None:
                limit -= len(batch)
    except (KeyError, TypeError, ValueError, OverflowError) as cause:
        raise RecordError(path, f"its messages are not a rig's ({cause!r})") from cause
    rows = np.empty(sum(len(part) for part in parts), SAMPLE)  # np.concatenate would leave the padding out
    if parts:
        np.concatenate(parts, out=rows)
    return rows


def read_events(path: Path) -> list[dict[str, Any]]:
    """The events of a record: commands, transitions, alarms. Raises `RecordError`."""
    return [_DECODE(message.data) for topic, message in recover_messages(path) if topic == EVENTS]


def row_of(raw: dict[str, Any]) -> tuple[Any, ...]:
    """A telemetry message as a row of `SAMPLE`. Raises what a message does that is none of a rig's."""
    values = []
    for field in FIELDS:
        value = raw.get(field.name)
        if field.name == "state":
            value = _CODES[raw[field.name]]
        elif value is None:  # not a number, or four that are none
            value = (np.nan,) * len(field.parts) if field.parts else np.nan
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
