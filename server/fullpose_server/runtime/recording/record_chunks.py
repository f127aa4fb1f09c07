"""A record by its chunks: read one after another without more than one in memory, or any stretch of rows by itself.

Faster than `read_record`, which the first reading of an hour at 1 kHz needs: three and a half million messages.
"""

import math
import struct
from collections.abc import Iterator
from pathlib import Path
from types import GenericAlias
from typing import Any, NamedTuple

import msgspec
import numpy as np
from mcap.opcode import Opcode
from mcap.records import Channel
from mcap.stream_reader import get_chunk_data_stream
from numpy.typing import NDArray

from fullpose_server.runtime.contract.telemetry import FIELDS, SAMPLE, Samples
from fullpose_server.runtime.recording.channels import EVENTS, TELEMETRY
from fullpose_server.runtime.recording.mcap_reader import RecordError, contents, decoded, row_of, stream_of
from fullpose_server.session.states import STATES

_CODES = {str(state): code for code, state in enumerate(STATES)}
_FRAME = struct.Struct("<BQ")  # before each record: its opcode, and the length of its content
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time; then the data
_EVENT = msgspec.json.Decoder(dict[str, Any]).decode
INDEX = np.dtype(
    [("offset", "<u8"), ("length", "<u8"), ("first", "<u8"), ("rows", "<u8"), ("time_ns", "<i8"), ("seq", "<u8")]
)  # of a chunk with telemetry: where it is, the number of its first row, how many, and what its first row has


def _message_type() -> type[msgspec.Struct]:
    fields: list[tuple[str, Any, Any]] = []
    for field in FIELDS:
        if field.name == "state":
            fields.append((field.name, Any, msgspec.NODEFAULT))
        elif field.parts:
            numbers = len(field.parts)
            fields.append((field.name, GenericAlias(tuple, (float,) * numbers), (math.nan,) * numbers))
        else:
            fields.append(
                (field.name, int if field.integer else float, msgspec.NODEFAULT if field.integer else math.nan)
            )
    # Fields without a default come first; `astuple` of the record's order is made from names.
    return msgspec.defstruct("Row", fields, gc=False, kw_only=True)


_DECODE = msgspec.json.Decoder(_message_type()).decode
_SLOWLY = msgspec.json.Decoder(dict[str, Any]).decode


class Chunk(NamedTuple):
    """What is in one chunk of a record."""

    offset: int  # of its content in the file
    length: int
    rows: Samples  # (n,)
    events: list[dict[str, Any]]


def chunks(path: Path) -> Iterator[Chunk]:
    """The chunks of a record that are as they were written, in order. Raises `RecordError`."""
    topics: dict[int, str] = {}
    with path.open("rb") as file:
        for opcode, content in contents(path, file):
            if opcode == Opcode.CHUNK:
                telemetry, events = _messages(content, topics)
                rows = _rows(path, telemetry)
                yield Chunk(file.tell() - len(content), len(content), rows, [_EVENT(data) for data in events])


def _messages(content: bytes, topics: dict[int, str]) -> tuple[list[bytes], list[bytes]]:
    """The data of telemetry and of events; nothing of a chunk that is damaged. `topics` learns of new channels."""
    found = decoded(content, get_chunk_data_stream)
    if found is None:
        return [], []
    data = found[0].read(found[1])
    taken: dict[str, list[bytes]] = {TELEMETRY: [], EVENTS: []}
    at = 0
    while at + _FRAME.size <= len(data):
        opcode, length = _FRAME.unpack_from(data, at)
        at += _FRAME.size
        if at + length > len(data):
            return [], []
        if opcode == Opcode.MESSAGE and length >= _MESSAGE.size:
            topic = topics.get(_MESSAGE.unpack_from(data, at)[0], "")
            if topic in taken:
                taken[topic].append(data[at + _MESSAGE.size : at + length])
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream_of(data[at : at + length]))
            topics[channel.id] = channel.topic
        at += length
    return taken[TELEMETRY], taken[EVENTS]


def _rows(path: Path, messages: list[bytes]) -> Samples:
    rows = np.zeros(len(messages), SAMPLE)
    if not messages:
        return rows
    try:
        read = [_DECODE(data) for data in messages]
        for field in FIELDS:
            name = field.name
            if name == "state":
                rows[name] = [_CODES[row.state] for row in read]  # type: ignore[attr-defined]
            else:
                rows[name] = [getattr(row, name) for row in read]
    except msgspec.MsgspecError:  # a lone value among four that is none, say: what `read_record` takes
        try:
            return np.array([row_of(_SLOWLY(data)) for data in messages], SAMPLE)
        except (KeyError, TypeError, ValueError, OverflowError) as cause:
            raise RecordError(path, f"its messages are not a rig's ({cause!r})") from cause
    except (KeyError, TypeError, ValueError, OverflowError) as cause:
        raise RecordError(path, f"its messages are not a rig's ({cause!r})") from cause
    return rows


class RecordRows:
    """Rows of a record by their number, of a file whose chunks are known: `index` (c,) of `INDEX`. Not thread-safe."""

    def __init__(self, path: Path, index: NDArray[np.void], channel: int, kept: int = 64) -> None:
        self._path = path
        self._index = index
        self._topics = {channel: TELEMETRY}
        self._kept = kept  # chunks in memory
        self._chunks: dict[int, Samples] = {}

    def __len__(self) -> int:
        """How many there are."""
        return int(self._index["first"][-1] + self._index["rows"][-1]) if len(self._index) else 0

    def between(self, first: int, last: int) -> Samples:
        """The rows from `first` up to before `last`. Raises `RecordError` where the file is another by now."""
        first, last = max(0, first), min(last, len(self))
        if first >= last:
            return np.empty(0, SAMPLE)
        begin = int(np.searchsorted(self._index["first"], first, side="right")) - 1
        end = int(np.searchsorted(self._index["first"], last, side="left"))
        found = np.empty(sum(int(n) for n in self._index["rows"][begin:end]), SAMPLE)
        np.concatenate([self._chunk(number) for number in range(begin, end)], out=found)
        skipped = int(self._index["first"][begin])
        return found[first - skipped : last - skipped]

    def until(self, time_ns: int) -> int:
        """How many rows are no later than `time_ns`."""
        return self._up_to("time_ns", time_ns)

    def numbered(self, sequence: int) -> int:
        """How many rows have no greater `seq`."""
        return self._up_to("seq", sequence)

    def _up_to(self, name: str, value: int) -> int:
        chunk = int(np.searchsorted(self._index[name], value, side="right")) - 1
        if chunk < 0:
            return 0
        inside = np.searchsorted(self._chunk(chunk)[name], value, side="right")
        return int(self._index["first"][chunk]) + int(inside)

    def _chunk(self, number: int) -> Samples:
        if (known := self._chunks.pop(number, None)) is None:
            about = self._index[number]
            with self._path.open("rb") as file:
                file.seek(int(about["offset"]))
                telemetry, _ = _messages(file.read(int(about["length"])), self._topics)
            known = _rows(self._path, telemetry)
            if len(known) != about["rows"]:
                raise RecordError(self._path, "it has changed since its curves were made")
        self._chunks[number] = known  # the last that were asked for stay
        while len(self._chunks) > self._kept:
            self._chunks.pop(next(iter(self._chunks)))
        return known
