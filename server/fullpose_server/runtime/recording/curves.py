"""Curves of a recorded run: its columns as a pyramid, where its chunks are, and its events, made of the record once.

Kept in a folder of their own, whole or not at all, and made anew where the record is another than they were made of.
"""

import contextlib
import hashlib
import json
import shutil
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose_server.formats import durable
from fullpose_server.runtime.contract.telemetry import FIELDS, Samples
from fullpose_server.runtime.recording.channels import TELEMETRY
from fullpose_server.runtime.recording.mcap_reader import is_complete, recover_messages
from fullpose_server.runtime.recording.pyramid import Buckets, Pyramid, PyramidWriter
from fullpose_server.runtime.recording.record_chunks import INDEX, Chunk, RecordRows, chunks
from fullpose_server.runtime.recording.run_summary import Tally, keep_summary, kept_summary

FORMAT = 1
BATCH = 65_536  # rows that are in memory at once
MOST_EVENTS = 2000
MOST_GAPS = 500
_HEAD, _TAIL = 65_536, 1_048_576  # bytes of a record that its fingerprint is of: its end has the index of its chunks
_TOLD = ("demand", "demand_rate", "measured", "measured_rate", "solve_error_deg", "tracking_error_deg", "margin")
_FIELDS = [field for field in FIELDS if field.name in _TOLD]
TIME, FLIGHT_TIME = "time_s", "path_time_s"
COLUMNS = (TIME, FLIGHT_TIME, *(name for field in _FIELDS for name in (field.part_names or [field.name])))
Progress = Callable[[float], None]  # what part of the work is done, 0 to 1


class StaleError(Exception):
    """There are no curves of the record as it is now."""


@dataclass(frozen=True)
class About:
    """What curves are of."""

    format: int
    fingerprint: str  # of the record that they were made of
    sha256: str  # of that record, all of it
    columns: list[str]
    rows: int
    duration_s: float
    started: float | None  # of the first row [s since 1970]
    channel: int  # of the telemetry in the record
    events: list[dict[str, Any]]  # with `at_s` after the first row, at most `MOST_EVENTS`
    events_left_out: int
    gaps: list[tuple[float, int]]  # (after the first row [s], samples that are missing there), at most `MOST_GAPS`


def fingerprint(record: Path) -> str:
    """Of a record as it is now: its size, its time of change, its beginning and its end. Raises OSError.

    Hashing three gigabytes takes longer than a run may take to open.
    """
    about = record.stat()
    digest = hashlib.blake2b(f"{FORMAT} {about.st_size} {about.st_mtime_ns}".encode(), digest_size=16)
    with record.open("rb") as file:
        digest.update(file.read(_HEAD))
        file.seek(max(0, about.st_size - _TAIL))
        digest.update(file.read())
    return digest.hexdigest()


def columns_of(rows: Samples, begun_ns: int) -> Array:
    """`COLUMNS` (n, c) of rows of a record that began at `begun_ns`."""
    values = [(rows["time_ns"] - begun_ns)[:, None] / 1e9, rows[FLIGHT_TIME][:, None]]
    values += [rows[field.name].reshape(len(rows), len(field.parts) or 1) for field in _FIELDS]
    return np.concatenate(values, axis=1)


@contextlib.contextmanager
def folder_made(target: Path) -> Iterator[Path]:
    """A folder to write into that becomes `target` at the end, whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        yield draft
        shutil.rmtree(target, ignore_errors=True)
        durable.rename(draft, target)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise


def make_curves(record: Path, target: Path, progress: Progress) -> None:
    """Make the curves of a record into the folder `target`. Raises `RecordError`."""
    made_of = fingerprint(record)
    with record.open("rb") as file:
        sha256 = hashlib.file_digest(file, "sha256").hexdigest()
    with folder_made(target) as draft:
        following = _Following(draft, record.stat().st_size, progress)
        try:
            for chunk in chunks(record):
                following.take(chunk)
            following.finish()
        finally:
            following.pyramid.close()
        if kept_summary(record) is None:  # it has been read now: nobody need read it again for the list
            summary = following.tally.summary(record, following.events)
            keep_summary(record, replace(summary, complete=is_complete(record)))
        about = following.about(made_of, sha256, _telemetry_channel(record))
        (draft / "about.json").write_text(json.dumps(asdict(about)), encoding="utf-8")


class _Following:
    """What comes of a record's chunks, one after another."""

    def __init__(self, draft: Path, size: int, progress: Progress) -> None:
        self.pyramid = PyramidWriter(draft, len(COLUMNS))
        self.tally = Tally()
        self._index = draft / "index.npy"
        self._size, self._progress = size, progress
        self._chunks: list[tuple[int, int, int, int, int, int]] = []
        self._begun: tuple[int, int] | None = None  # monotonic and wall time of the first row [ns]
        self._last: tuple[int, int] = (0, 0)  # sequence and monotonic time of the last row
        self._rows = 0
        self.events: list[dict[str, Any]] = []
        self._gaps: list[tuple[float, int]] = []

    def take(self, chunk: Chunk) -> None:
        rows = chunk.rows
        self.events += chunk.events
        self.tally.add(rows)
        if len(rows):
            first_ns = int(rows["time_ns"][0])
            if self._begun is None:
                self._begun = first_ns, int(rows["wall_ns"][0])
                self._last = int(rows["seq"][0]) - 1, first_ns
            self._look_for_gaps(rows, self._begun[0])
            self._chunks.append((chunk.offset, chunk.length, self._rows, len(rows), first_ns, int(rows["seq"][0])))
            self._rows += len(rows)
            self._last = int(rows["seq"][-1]), int(rows["time_ns"][-1])
            self.pyramid.add(columns_of(rows, self._begun[0]))
        self._progress(chunk.offset / self._size)

    def finish(self) -> None:
        self.pyramid.finish()
        np.save(self._index, np.array(self._chunks, INDEX), allow_pickle=False)

    def about(self, made_of: str, sha256: str, channel: int) -> About:
        begun_ns = 0 if self._begun is None else self._begun[0]
        events = [event for event in self.events if isinstance(event.get("time_ns"), int)]
        events.sort(key=lambda event: event["time_ns"])
        told = [event | {"at_s": (event["time_ns"] - begun_ns) / 1e9} for event in events[:MOST_EVENTS]]
        return About(
            format=FORMAT,
            fingerprint=made_of,
            sha256=sha256,
            columns=list(COLUMNS),
            rows=self._rows,
            duration_s=(self._last[1] - begun_ns) / 1e9 if self._begun else 0.0,
            started=None if self._begun is None else self._begun[1] / 1e9,
            channel=channel,
            events=told,
            events_left_out=len(events) - len(told),
            gaps=self._gaps,
        )

    def _look_for_gaps(self, rows: Samples, begun_ns: int) -> None:
        sequence = np.concatenate([[self._last[0]], rows["seq"].astype(np.int64)])
        missing = np.diff(sequence) - 1
        for at in np.flatnonzero(missing)[: MOST_GAPS - len(self._gaps)]:
            self._gaps.append(((int(rows["time_ns"][at]) - begun_ns) / 1e9, int(missing[at])))


def _telemetry_channel(record: Path) -> int:
    """By which number telemetry is known in the record; 0, which is none, where there is none."""
    return next((message.channel_id for topic, message in recover_messages(record) if topic == TELEMETRY), 0)


class Curves:
    """The curves of a record as they are kept. Raises `StaleError` where there are none of it as it is now."""

    def __init__(self, folder: Path, record: Path) -> None:
        try:
            self.about = msgspec.json.decode((folder / "about.json").read_bytes(), type=About)
            if self.about.format != FORMAT or self.about.fingerprint != fingerprint(record):
                raise StaleError
            index: NDArray[np.void] = np.load(folder / "index.npy", allow_pickle=False)
            if index.dtype != INDEX:
                raise StaleError
            self.pyramid = Pyramid(folder, self.about.rows, len(self.about.columns))
        except (OSError, ValueError, EOFError, msgspec.MsgspecError) as cause:
            raise StaleError from cause
        self.rows = RecordRows(record, index, self.about.channel)
        self.begun_ns = int(index["time_ns"][0]) if len(index) else 0

    def columns(self, first: int, last: int) -> Array:
        """The rows from `first` up to before `last` as they were recorded, as `columns_of`. Raises `RecordError`."""
        return columns_of(self.rows.between(first, last), self.begun_ns)

    def span(self, from_s: float, to_s: float) -> tuple[int, int]:
        """The rows from the first up to before the last of a stretch of time, and one more on either side.

        With those a line goes on to the edge. Raises `RecordError`.
        """
        first = self.rows.until(self.begun_ns + round(from_s * 1e9) - 1)
        last = self.rows.until(self.begun_ns + round(to_s * 1e9))
        return max(0, first - 1), min(self.about.rows, last + 1)

    def window(self, from_s: float, to_s: float, width: int) -> Buckets:
        """What is drawn of the time from `from_s` to `to_s`, at most `width` buckets and those next to it.

        Rows by themselves, buckets of one, where there are no more than four times as many. Raises `RecordError`.
        """
        first, last = self.span(from_s, to_s)
        if last - first > 4 * width:
            return self.pyramid.buckets(first, last, width)
        rows = self.columns(first, last)
        return Buckets(first + np.arange(len(rows) + 1), rows, rows)
