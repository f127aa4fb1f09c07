"""Recorded runs as the outside sees them: a summary of each file, kept beside it."""

import contextlib
import os
import threading
import time
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from fullpose_server.errors import FileError, NotFoundError, ServerError
from fullpose_server.formats import durable
from fullpose_server.formats.labels import NO_LABELS
from fullpose_server.runtime.recording.mcap_reader import RecordError, is_complete, run_of
from fullpose_server.runtime.recording.record_names import RECORD, RecordNames, is_run, rig_of
from fullpose_server.runtime.recording.run_labels import LABELS, RunLabels
from fullpose_server.runtime.recording.run_search import RunSearch, Sought
from fullpose_server.runtime.recording.run_summary import (
    RunSummary,
    brief,
    keep_summary,
    kept_summary,
    summarise,
    unreadable,
)

PIN = ".pin"  # of the mark beside a record that is to stay
LONG_BYTES = 64_000_000  # a few minutes at 1 kHz, some seconds to read
READING_S = 0.5  # that a list may take over records that have no summary yet: of the others it tells what they are
_WRITTEN_S = 5.0  # a record that has not grown for so long is no longer written: its recorder was cut off


class RunInUseError(ServerError):
    """A record that stays where it is."""

    def __init__(self, run: str, why: str) -> None:
        super().__init__(f"run {run} cannot be removed: {why}")


class RunFiles:
    """The records in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.labels = RunLabels(folder)
        self._names = RecordNames(folder)
        self._search = RunSearch(folder, self.labels)
        self._closing = threading.Event()
        self._ahead: set[str] = set()  # the runs that `read_ahead` has seen a summary of

    def close(self) -> None:
        """Read ahead no more."""
        self._closing.set()

    def read_ahead(self) -> None:
        """Have a summary of every record, the newest first, so that no list has to read one.

        The thread that calls it rests as long as it works: the processor is for others.
        """
        runs = self._names.all()
        self._ahead.intersection_update(runs)
        for run in reversed(runs):
            if run in self._ahead:
                continue
            path, began = self.folder / f"{run}{RECORD}", time.monotonic()
            with contextlib.suppress(RecordError, OSError):  # said by whoever lists it
                if kept_summary(path) is not None:
                    self._ahead.add(run)
                else:
                    self._summary(path)
                    self._closing.wait(time.monotonic() - began)
            if self._closing.is_set():
                return

    def all(
        self, rig: str | None = None, before: str | None = None, limit: int | None = None, sought: Sought | None = None
    ) -> list[RunSummary]:
        """Newest first, those after the run `before`, at most `limit`; one that cannot be read says why.

        One that has only just begun may be left out; of those that have no summary yet only so many are read as half
        a second allows, of the others what follows from their samples is not told. `sought`: those
        alone that have each of its parts.
        """
        found: list[RunSummary] = []
        began = time.monotonic()
        # Of ten thousand records all but a page are passed over by their names alone.
        ids = self._names.all()
        end = len(ids) if before is None else bisect_left(ids, before)
        newest: Iterator[str] = (run for run in reversed(ids[:end]) if rig is None or rig_of(run) == rig)
        if sought is not None:
            newest = self._search.among(newest, sought)
        for run in newest:
            path = self.folder / f"{run}{RECORD}"
            # One that is gone since we looked for it is no run any more.
            with contextlib.suppress(FileNotFoundError):
                try:
                    reading = time.monotonic() - began < READING_S
                    found.append(self._summary(path) if reading else kept_summary(path) or brief(path))
                except (RecordError, OSError) as error:
                    if not _is_fresh(path):
                        found.append(unreadable(path, error))
            if limit is not None and len(found) >= limit:  # before the next is looked for, which may take longer
                break
        return found

    def get(self, run: str) -> RunSummary:
        """One run; of a long one that nobody has read yet only what its beginning says.

        Raises `NotFoundError`, or `FileError` for a file that is no record.
        """
        path = self.path(run)
        try:
            # A long one that has no summary yet is not waited for: it is read in the background.
            if path.stat().st_size > LONG_BYTES:
                return kept_summary(path) or brief(path)
            return self._summary(path)
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
        self.labels.put(run, NO_LABELS)
        self._search.forget(run)
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
        return [path, path.with_suffix(".json"), path.with_suffix(PIN), path.with_suffix(LABELS)]

    def _summary(self, path: Path) -> RunSummary:
        """Of the file: read whole once, when nobody writes to it any more, and kept beside it."""
        kept = kept_summary(path)
        if kept is not None:
            return kept
        size = path.stat().st_size
        complete = is_complete(path)
        if not complete and _is_fresh(path):
            return brief(path)
        made = replace(summarise(path), complete=complete)
        if made.bytes == size:
            keep_summary(path, made)
        return made


def is_being_written(path: Path) -> bool:
    """Whether it is, as far as its file shows."""
    return _is_fresh(path) and not is_complete(path)


def _is_fresh(path: Path) -> bool:
    return abs(time.time() - path.stat().st_mtime) < _WRITTEN_S
