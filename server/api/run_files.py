"""Recorded runs as the outside sees them: a summary of each file, kept beside it, and tables for export."""

import json
import time
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv
import pyarrow.parquet as pq

from server.runtime.replay import RecordError, is_whole, read_samples, run_of
from server.runtime.telemetry import LEAD, SAMPLE, Samples
from server.session.states import STATES, State
from server.store.errors import FileError, NotFoundError
from solver.rig import FRAMES

_UNITS = {
    "demand": "deg",
    "demand_rate": "deg_s",
    "demand_acceleration": "deg_s2",
    "measured": "deg",
    "measured_rate": "deg_s",
    "following_error_deg": "deg",
}
_WRITTEN_S = 5.0  # a record that has not grown for so long is no longer written: its recorder was cut off
_QUATERNION = ("w", "x", "y", "z")


@dataclass(frozen=True)
class RunSummary:
    """What a record says, errors over the flight itself: running or held, leads left out."""

    id: str
    rig: str
    plan_id: str | None
    plan_hash: str | None
    who: str
    started: float | None  # seconds since 1970, of the first sample
    ended: float | None
    samples: int | None  # None, as all that follows from them, while they are being written
    lost_samples: int | None  # sequence numbers that are missing
    bytes: int
    complete: bool  # False while it is written, or where the recorder was cut off
    max_solve_error_deg: float | None
    max_tracking_error_deg: float | None
    max_lateness_us: float | None


class RunFiles:
    """The records in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def all(self, rig: str | None = None) -> list[RunSummary]:
        """Newest first; files that are no records are left out."""
        found = []
        for path in sorted(self.folder.glob("*.mcap"), reverse=True):
            try:
                found.append(self._summary(path))
            except RecordError:
                continue
        return [run for run in found if rig is None or run.rig == rig]

    def get(self, run: str) -> RunSummary:
        """One run. Raises `NotFoundError`, or `FileError` for a file that is no record."""
        try:
            return self._summary(self.path(run))
        except RecordError as error:
            raise FileError(f"{run}.mcap", f"a record ({error})") from None

    def path(self, run: str) -> Path:
        """The record's file. Raises `NotFoundError`."""
        path = self.folder / f"{run}.mcap"
        if Path(run).name != run or not path.is_file():
            raise NotFoundError("run", run)
        return path

    def _summary(self, path: Path) -> RunSummary:
        """Of the file: read whole once, when nobody writes to it any more, and kept beside it."""
        kept = path.with_suffix(".json")
        status = path.stat()
        size = status.st_size
        try:
            summary = RunSummary(**json.loads(kept.read_text(encoding="utf-8")))
            if summary.bytes == size:
                return summary
        except (OSError, ValueError, TypeError):
            pass  # not there yet, or of another version: it is read again
        whole = is_whole(path)
        if not whole and abs(time.time() - status.st_mtime) < _WRITTEN_S:
            return summarise(path, None, complete=False)
        made = summarise(path, read_samples(path), complete=whole)
        if made.bytes == size:
            draft = kept.with_suffix(f".{uuid4().hex}.tmp")
            draft.write_text(json.dumps(asdict(made)), encoding="utf-8")
            draft.replace(kept)
        return made


def summarise(path: Path, rows: Samples | None, *, complete: bool) -> RunSummary:
    """What the record and its rows say; without rows, what its beginning says. Raises `RecordError`."""
    run = run_of(path)
    plan = _object(run.get("plan"))
    brief = RunSummary(
        id=path.stem,
        rig=str(plan.get("rig") or path.stem.split("-", 1)[-1].rsplit("-", 1)[0]),
        plan_id=plan.get("plan_id"),
        plan_hash=plan.get("plan_hash"),
        who=run.get("who", ""),
        started=_stamp(path.stem),
        ended=None,
        samples=None,
        lost_samples=None,
        bytes=path.stat().st_size,
        complete=complete,
        max_solve_error_deg=None,
        max_tracking_error_deg=None,
        max_lateness_us=None,
    )
    if rows is None:
        return brief
    flying = np.isin(rows["state"], (State.RUNNING.code, State.HELD.code)) & (rows["flags"] & LEAD == 0)
    sequence = rows["seq"].astype(np.int64)
    return replace(
        brief,
        started=float(rows["wall_ns"][0]) / 1e9 if rows.size else brief.started,
        ended=float(rows["wall_ns"][-1]) / 1e9 if rows.size else None,
        samples=int(rows.size),
        lost_samples=int(sequence[-1] - sequence[0] + 1 - rows.size) if rows.size else 0,
        max_solve_error_deg=_largest(rows["solve_error_deg"][flying]),
        max_tracking_error_deg=_largest(rows["tracking_error_deg"][flying]),
        max_lateness_us=_largest(rows["lateness_us"]),
    )


def _stamp(run: str) -> float | None:
    """When a run began by its name, to the second [s since 1970]."""
    try:
        return datetime.strptime(run.split("-", 1)[0], "%Y%m%dT%H%M%S").replace(tzinfo=UTC).timestamp()
    except ValueError:
        return None


def table(rows: Samples) -> pa.Table:
    """One column a number, named with its frame and unit; what is not a number is null."""
    columns: dict[str, Any] = {}
    start = rows["time_ns"][0] if rows.size else 0
    columns["time_s"] = (rows["time_ns"] - start) / 1e9
    for name in SAMPLE.names or ():
        values = rows[name]
        if name == "state":
            columns[name] = [STATES[code].value for code in values.tolist()]
        elif name == "target":
            columns |= {f"target_q{axis}": values[:, k] for k, axis in enumerate(_QUATERNION)}
        elif name in _UNITS:
            stem = name.removesuffix("_deg")
            columns |= {f"{stem}_{frame}_{_UNITS[name]}": values[:, k] for k, frame in enumerate(FRAMES)}
        else:
            columns[name] = values
    return pa.table({name: pa.array(_plain(values), from_pandas=True) for name, values in columns.items()})


def write_export(record: Path, target: Path, kind: str) -> None:
    """Write a record as `csv` or `parquet`. Raises `FileError`."""
    try:
        made = table(read_samples(record))
    except RecordError as error:
        raise FileError(record.name, f"a record ({error})") from None
    if kind == "parquet":
        pq.write_table(made, target)
    else:
        pacsv.write_csv(made, target)


def _plain(values: Any) -> Any:
    return np.ascontiguousarray(values) if isinstance(values, np.ndarray) else values


def _largest(values: np.ndarray[Any, Any]) -> float | None:
    seen = values[np.isfinite(values)]
    return float(seen.max()) if seen.size else None


def _object(text: str | None) -> dict[str, Any]:
    try:
        found = json.loads(text or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
