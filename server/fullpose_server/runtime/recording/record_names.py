"""The records in a folder, by their names alone, and what a name says."""

import os
import re
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

RECORD = ".mcap"
_RUN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,199}")
_SETTLED_NS = 100_000_000  # a change within a tick of the file system's clock would not show


def is_run(name: str) -> bool:
    """Whether it can be the id of a run: a file's name, and no path."""
    return _RUN.fullmatch(name) is not None


def rig_of(run: str) -> str:
    """The rig, by a run's id."""
    return run.split("-", 1)[-1].rsplit("-", 1)[0].removesuffix("-incident")


def began_at(run: str) -> float | None:
    """When a run began by its id, to the second [s since 1970]; None where that says nothing."""
    try:
        return datetime.strptime(run.split("-", 1)[0], "%Y%m%dT%H%M%S").replace(tzinfo=UTC).timestamp()
    except ValueError:
        return None


class _Listing(NamedTuple):
    changed_ns: int  # when the folder had last changed
    settled: bool  # whether that was long enough ago for any later change to show
    ids: tuple[str, ...]


class RecordNames:
    """Of one folder; read anew only where that has changed: ten thousand records and what is beside them take 20 ms."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._listing = _Listing(0, False, ())

    def all(self) -> tuple[str, ...]:
        """The ids of the runs, in their order: the oldest first."""
        known, changed_ns = self._listing, self._folder.stat().st_mtime_ns
        if known.settled and known.changed_ns == changed_ns:
            return known.ids
        settled = time.time_ns() - changed_ns > _SETTLED_NS
        with os.scandir(self._folder) as entries:
            ids = tuple(sorted(e.name.removesuffix(RECORD) for e in entries if e.name.endswith(RECORD)))
        self._listing = _Listing(changed_ns, settled, ids)
        return ids
