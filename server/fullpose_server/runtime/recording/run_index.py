"""Recorded runs as the outside sees them: a summary of each file, kept beside it."""

import contextlib
import json
import os
import time
from bisect import bisect_left
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fullpose_server.errors import FileError, NotFoundError, ServerError
from fullpose_server.formats import durable
from fullpose_server.formats.output_file import write_text
from fullpose_server.runtime.contract.telemetry import Flag, Samples
from fullpose_server.runtime.recording.mcap_reader import (
    RecordError,
    is_complete,
    read_record,
    run_of,
)
from fullpose_server.runtime.recording.record_names import RECORD, RecordNames, began_at, is_run, rig_of
from fullpose_server.session.states import State

PIN = ".pin"  # of the mark beside a record that is to stay
_WRITTEN_S = 5.0  # a record that has not grown for so long is no longer written: its recorder was cut off


@dataclass(frozen=True)
class RunSummary:
    """What a record says, errors over the flight itself: running or held, leads left out."""

    id: str
    rig: str
    end: str | None  # how it ended, a `RunEnd`; None: not known, or no run, or not ended
    end_code: str | None  # of the alarm that ended it
    incident: str | None  # code of the alarm that had it kept while no run was recorded; None: a run
    error: str | None  # why it cannot be read; then nothing but its name is known
    plan_id: str | None
    plan_hash: str | None
    who: str
    started: float | None  # seconds since 1970, of the first sample
    ended: float | None
    samples: int | None  # None, as all that follows from them, while they are being written
    lost_samples: int | None  # sequence numbers that are missing, from the run's beginning to its end
    bytes: int
    complete: bool  # False while it is written, where the recorder was cut off, or a part is damaged
    max_solve_error_deg: float | None
    max_tracking_error_deg: float | None
    max_lateness_us: float | None


class RunInUseError(ServerError):
    """A record that stays where it is."""

    def __init__(self, run: str, why: str) -> None:
        super().__init__(f"run {run} cannot be removed: {why}")


class RunFiles:
    """The records in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._names = RecordNames(folder)

    def all(self, rig: str | None = None, before: str | None = None, limit: int | None = None) -> list[RunSummary]:
        """Newest first, those after the run `before`, at most `limit`; one that cannot be read says why.

        One that has only just begun may be left out.
        """
        found: list[RunSummary] = []
        # Of ten thousand records all but a page are passed over by their names alone.
        ids = self._names.all()
        end = len(ids) if before is None else bisect_left(ids, before)
        for run in reversed(ids[:end]):
            if limit is not None and len(found) >= limit:
                break
            if rig is not None and rig_of(run) != rig:
                continue
            path = self.folder / f"{run}{RECORD}"
            # One that is gone since we looked for it is no run any more.
            with contextlib.suppress(FileNotFoundError):
                try:
                    found.append(self._summary(path))
                except (RecordError, OSError) as error:
                    if not _is_fresh(path):
                        found.append(_unreadable(path, error))
        return found

    def get(self, run: str) -> RunSummary:
        """One run. Raises `NotFoundError`, or `FileError` for a file that is no record."""
        try:
            return self._summary(self.path(run))
        except RecordError as error:
            raise FileError(f"{run}{RECORD}", f"a record ({error.why})") from None

    def path(self, run: str) -> Path:
        """The record's file. Raises `NotFoundError`."""
        path = self.folder / f"{run}{RECORD}"
        if not is_run(run) or not path.is_file():
            raise NotFoundError("run", run)
        return path

    def remove(self, run: str) -> None:
        """Remove a record, and what is kept beside it. Raises `NotFoundError`, `RunInUseError`."""
        path = self.path(run)
        if path.with_suffix(PIN).exists():
            raise RunInUseError(run, "it is pinned")
        if is_being_written(path):
            raise RunInUseError(run, "it is being written")
        path.with_suffix(".json").unlink(missing_ok=True)
        path.unlink(missing_ok=True)

    def pin(self, run: str, *, pinned: bool) -> None:
        """Keep a record whatever its age, or no longer. Raises `NotFoundError`."""
        mark = self.path(run).with_suffix(PIN)
        if pinned:
            mark.touch()
            durable.sync(self.folder)
        else:
            mark.unlink(missing_ok=True)

    def pinned(self, run: str) -> bool:
        """Whether it is."""
        return (self.folder / f"{run}{PIN}").exists()

    def sizes(self) -> list[tuple[str, int, float, bool]]:
        """(id, bytes, when it was last written [s since 1970], pinned) of every record."""
        found = []
        with os.scandir(self.folder) as entries:
            names = {entry.name: entry for entry in entries}
        for name, entry in names.items():
            if name.endswith(RECORD):
                with contextlib.suppress(FileNotFoundError):
                    about, run = entry.stat(), name.removesuffix(RECORD)
                    found.append((run, about.st_size, about.st_mtime, f"{run}{PIN}" in names))
        return found

    def damaged(self) -> list[tuple[str, str]]:
        """(id, why) of every file that is no record at all and that nobody writes."""
        found = []
        for run, _, written, _ in self.sizes():
            path = self.folder / f"{run}{RECORD}"
            if abs(time.time() - written) < _WRITTEN_S:
                continue
            try:
                run_of(path)
            except RecordError as error:
                found.append((run, error.why))
            except OSError:
                continue
        return found

    def files(self, run: str) -> list[Path]:
        """The record and what is kept beside it."""
        path = self.folder / f"{run}{RECORD}"
        return [path, path.with_suffix(".json"), path.with_suffix(PIN)]

    def _summary(self, path: Path) -> RunSummary:
        """Of the file: read whole once, when nobody writes to it any more, and kept beside it."""
        kept = path.with_suffix(".json")
        size = path.stat().st_size
        try:
            summary = RunSummary(**json.loads(kept.read_text(encoding="utf-8")))
            if summary.bytes == size:
                return summary
        except (OSError, ValueError, TypeError):
            pass  # not there yet, or of another version: it is read again
        complete = is_complete(path)
        if not complete and _is_fresh(path):
            return _brief(path)
        made = replace(summarise(path), complete=complete)
        if made.bytes == size:
            _keep(made, kept)
        return made


def is_being_written(path: Path) -> bool:
    """Whether it is, as far as its file shows."""
    return _is_fresh(path) and not is_complete(path)


def _is_fresh(path: Path) -> bool:
    return abs(time.time() - path.stat().st_mtime) < _WRITTEN_S


def _keep(summary: RunSummary, kept: Path) -> None:
    with contextlib.suppress(OSError):  # a full disk, say: the summary is as true, and made again next time
        write_text(kept, json.dumps(asdict(summary)))


def _named(path: Path) -> RunSummary:
    """What the file's name says."""
    return RunSummary(
        id=path.stem,
        rig=rig_of(path.stem),
        end=None,
        end_code=None,
        incident=None,
        error=None,
        plan_id=None,
        plan_hash=None,
        who="",
        started=began_at(path.stem),
        ended=None,
        samples=None,
        lost_samples=None,
        bytes=path.stat().st_size,
        complete=False,
        max_solve_error_deg=None,
        max_tracking_error_deg=None,
        max_lateness_us=None,
    )


def _unreadable(path: Path, error: Exception) -> RunSummary:
    match error:
        case RecordError():
            why = error.why
        case OSError(strerror=str(told)):
            why = told
        case _:
            why = str(error)
    return replace(_named(path), error=why)


def _brief(path: Path) -> RunSummary:
    """What the record's beginning says. Raises `RecordError`."""
    run = run_of(path)
    plan = _object(run.get("plan"))
    named = _named(path)
    return replace(
        named,
        rig=str(run.get("rig") or plan.get("rig") or named.rig),
        incident=run.get("incident"),
        plan_id=plan.get("plan_id"),
        plan_hash=plan.get("plan_hash"),
        who=run.get("who", ""),
    )


def summarise(path: Path) -> RunSummary:
    """What the whole record says, but for whether it is complete. Raises `RecordError`."""
    return summary_of(path, *read_record(path))


def summary_of(path: Path, rows: Samples, events: list[dict[str, Any]]) -> RunSummary:
    """Of a record that has been read. Raises `RecordError`."""
    brief = _brief(path)
    flying = np.isin(rows["state"], (State.RUNNING.code, State.HELD.code)) & (rows["flags"] & Flag.LEAD == 0)
    ends = [event for event in events if event.get("kind") == "run_end"]
    ending: dict[str, Any] = ends[-1] if ends else {}
    return replace(
        brief,
        end=_word(ending.get("how")),
        end_code=_word(ending.get("code")),
        started=float(rows["wall_ns"][0]) / 1e9 if rows.size else brief.started,
        ended=float(rows["wall_ns"][-1]) / 1e9 if rows.size else None,
        samples=int(rows.size),
        lost_samples=_lost(rows, events),
        max_solve_error_deg=_largest(rows["solve_error_deg"][flying]),
        max_tracking_error_deg=_largest(rows["tracking_error_deg"][flying]),
        max_lateness_us=_largest(rows["lateness_us"]),
    )


def _lost(rows: Samples, events: list[dict[str, Any]]) -> int:
    """How many of the run's samples are missing: between the rows, and to its beginning and end where it tells them."""
    heads = {event.get("kind"): head for event in events if isinstance(head := event.get("head"), int)}
    first = [int(rows["seq"][0])] if rows.size else []
    last = [int(rows["seq"][-1])] if rows.size else []
    if "run_begin" in heads:
        first.append(heads["run_begin"] + 1)
    if "run_end" in heads:
        last.append(heads["run_end"])
    return max(last) - min(first) + 1 - rows.size if first and last else 0


def _largest(values: np.ndarray[Any, Any]) -> float | None:
    seen = values[np.isfinite(values)]
    return float(seen.max()) if seen.size else None


def _word(value: Any) -> str | None:
    return value if isinstance(value, str) else None


def _object(text: str | None) -> dict[str, Any]:
    try:
        found = json.loads(text or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
