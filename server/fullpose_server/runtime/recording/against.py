"""A run against another run, or against its plan: the reference on the run's own time, and the difference, as pyramid.

Both are compared at the same time of the flight, where both have one; else at the same time since they began to run.
What a row measured is what the row before commanded, so a row's time is that of the row before.
"""

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import msgspec
import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES
from fullpose_server.formats.plan_folder import PlanFolder
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.curves import FORMAT, TIME, Progress, StaleError, fingerprint, folder_made
from fullpose_server.runtime.recording.pyramid import Buckets, Pyramid, PyramidWriter
from fullpose_server.runtime.recording.record_chunks import chunks
from fullpose_server.session.states import State

Aligned = Literal["flight", "run"]
_RATES = [f"rate_{frame}_deg_s" for frame in FRAMES]
_ANGLES = [f"{frame}_deg" for frame in FRAMES]
COLUMNS = (TIME, *(f"{kind}_{name}" for kind in ("reference", "difference") for name in (*_ANGLES, *_RATES)))
_RUNNING = (State.RUNNING.code, State.HELD.code)
_VALUES = 8  # four angles [deg] and four rates [deg/s]


@dataclass(frozen=True)
class AboutDifference:
    """What a difference is of."""

    format: int
    fingerprint: str  # of the run's record, with the reference's
    columns: list[str]
    rows: int
    aligned: Aligned
    turned_deg: list[float]  # (4,) whole revolutions that the reference was moved by, to be where the run was


class Reference(NamedTuple):
    """What a run is compared with, in files, so that hours of it take no memory: ascending times, and a value each."""

    time: Array  # (m,) [s], mapped
    values: list[Array]  # 8 of (m,), mapped


class _Row(NamedTuple):
    flight: Array  # (n,) the flight's time of what was measured [s], nan where there is none
    running: Array  # (n,) since it began to run [s], nan before and after
    time: Array  # (n,) since the record's first row [s]
    values: Array  # (n, 8)


def _flown(record: Path, progress: Progress) -> Iterator[_Row]:
    """Rows of a record, chunk by chunk. Raises `RecordError`."""
    size = record.stat().st_size
    begun: int | None = None
    ran: int | None = None
    before = np.nan
    for chunk in chunks(record):
        rows = chunk.rows
        if not len(rows):
            continue
        begun = int(rows["time_ns"][0]) if begun is None else begun
        running = np.isin(rows["state"], _RUNNING)
        if ran is None and running.any():
            ran = int(rows["time_ns"][running][0])
        flight = np.concatenate([[before], rows["path_time_s"][:-1]])
        before = float(rows["path_time_s"][-1])
        since = (rows["time_ns"] - (ran or 0)) / 1e9
        yield _Row(
            np.where(running, flight, np.nan),
            np.where(running, since, np.nan) if ran is not None else np.full(len(rows), np.nan),
            (rows["time_ns"] - begun) / 1e9,
            _values(rows),
        )
        progress(chunk.offset / size)


def _values(rows: Samples) -> Array:
    return np.concatenate([rows["measured"], rows["measured_rate"]], axis=1)


def has_flight_time(record: Path) -> bool:
    """Whether a run's rows tell the time of a flight. Raises `RecordError`."""
    return any(np.isfinite(row.flight).any() for row in _flown(record, lambda _part: None))


def of_plan(plan: PlanFolder, folder: Path) -> Reference:
    """A plan as a reference, whose time is the flight's; its rates are central differences of its angles."""
    info = plan.info
    time = info.start_s + (np.arange(info.samples) - info.lead_in_samples) / info.rate_hz
    columns = [np.degrees(plan.angles[:, k]) for k in range(4)]
    columns += [np.gradient(column) * info.rate_hz for column in columns]
    return _mapped(folder, [time, *columns])


def of_run(record: Path, aligned: Aligned, folder: Path, progress: Progress) -> Reference:
    """Another run as a reference. Where its time stood still, while it was held, the first row counts."""
    names = [folder / f"reference{k}.f8" for k in range(_VALUES + 1)]
    files = [name.open("wb") for name in names]
    latest = -np.inf
    try:
        for row in _flown(record, progress):
            time = row.flight if aligned == "flight" else row.running
            reached = np.fmax.accumulate(np.concatenate([[latest], time]))
            ahead = time > reached[:-1]  # not-a-number is not
            for file, column in zip(files, [time, *row.values.T], strict=True):
                file.write(np.ascontiguousarray(column[ahead], "<f8").tobytes())
            latest = float(reached[-1])
    finally:
        for file in files:
            file.close()
    return Reference(*_opened(names))


def _mapped(folder: Path, columns: list[Array]) -> Reference:
    names = [folder / f"reference{k}.f8" for k in range(len(columns))]
    for name, column in zip(names, columns, strict=True):
        np.ascontiguousarray(column, "<f8").tofile(name)
    return Reference(*_opened(names))


def _opened(names: list[Path]) -> tuple[Array, list[Array]]:
    if not names[0].stat().st_size:  # it never ran
        return np.empty(0), [np.empty(0)] * _VALUES
    time, *values = (np.asarray(np.memmap(name, "<f8", "r")) for name in names)
    return time, values


def make_difference(
    record: Path, reference: Reference, aligned: Aligned, made_of: str, target: Path, progress: Progress
) -> None:
    """Make the pyramid of a run against a reference into the folder `target`. Raises `RecordError`."""
    turned: Array | None = None
    with folder_made(target) as draft:
        writer = PyramidWriter(draft, len(COLUMNS))
        try:
            for row in _flown(record, progress):
                found = _at(reference, row.flight if aligned == "flight" else row.running)
                if turned is None:
                    turned = _turned(row.values, found)
                found[:, :4] += turned if turned is not None else 0.0
                writer.add(np.concatenate([row.time[:, None], found, row.values - found], axis=1))
            writer.finish()
        finally:
            writer.close()
        about = AboutDifference(
            format=FORMAT,
            fingerprint=made_of,
            columns=list(COLUMNS),
            rows=writer.rows,
            aligned=aligned,
            turned_deg=[0.0] * 4 if turned is None else turned.tolist(),
        )
        (draft / "about.json").write_text(json.dumps(asdict(about)), encoding="utf-8")


def _at(reference: Reference, time: Array) -> Array:
    """The reference (n, 8) at times (n,), nan outside of it."""
    found = np.full((len(time), _VALUES), np.nan)
    known = np.isfinite(time)
    if not known.any() or not len(reference.time):
        return found
    # Of hours only what is between the batch's times is looked at.
    begin = max(0, int(np.searchsorted(reference.time, time[known].min())) - 1)
    end = int(np.searchsorted(reference.time, time[known].max(), side="right")) + 1
    x = np.asarray(reference.time[begin:end])
    for k, values in enumerate(reference.values):
        found[known, k] = np.interp(time[known], x, np.asarray(values[begin:end]), np.nan, np.nan)
    return found


def _turned(values: Array, found: Array) -> Array | None:
    """Whole revolutions (4,) [deg] that bring the reference to where the run is; None while nothing tells."""
    both = np.isfinite(found[:, :4] + values[:, :4]).all(axis=1)
    if not both.any():
        return None
    row = int(np.argmax(both))
    return np.asarray(360.0 * np.round((values[row, :4] - found[row, :4]) / 360.0))


class Difference:
    """A difference as it is kept. Raises `StaleError` where there is none of that run and reference as they are now."""

    def __init__(self, folder: Path, made_of: str) -> None:
        try:
            self.about = msgspec.json.decode((folder / "about.json").read_bytes(), type=AboutDifference)
            if self.about.format != FORMAT or self.about.fingerprint != made_of:
                raise StaleError
            self._pyramid = Pyramid(folder, self.about.rows, len(self.about.columns))
        except (OSError, ValueError, msgspec.MsgspecError) as cause:
            raise StaleError from cause

    def between(self, first: int, last: int, width: int) -> Buckets:
        """At most `width` buckets of the run's rows from `first` up to before `last`."""
        return self._pyramid.buckets(first, last, width)


def fingerprint_of(record: Path, reference: Path | str) -> str:
    """Of a run's record with its reference: another record, or a plan's hash. Raises OSError."""
    other = reference if isinstance(reference, str) else fingerprint(reference)
    return f"{fingerprint(record)} {other}"
