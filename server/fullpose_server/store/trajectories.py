"""Stored flights: rows in the database, arrays and the source file in trajectories/<sha256>/."""

import contextlib
import shutil
import threading
import time
from pathlib import Path
from uuid import uuid4

from sqlalchemy import func, select

from fullpose_server.errors import InUseError, NotFoundError
from fullpose_server.formats import durable
from fullpose_server.formats.flight_folder import FlightFacts
from fullpose_server.formats.labels import EVERYTHING, NO_LABELS, Labels, Wanted, search_text
from fullpose_server.store.database import Database
from fullpose_server.store.keyset import Key, newest_first, searched
from fullpose_server.store.tables import PlanRow, TrajectoryRow


class TrajectoryStore:
    """Adds, lists and removes flights. Either all of a flight is stored or nothing of it."""

    def __init__(self, database: Database, root: Path) -> None:
        self._database = database
        self._root = root
        self._changing = threading.Lock()  # row and folder of a flight come and go together
        root.mkdir(parents=True, exist_ok=True)
        for left in root.glob(".new-*"):  # an add that a crash cut off
            shutil.rmtree(left, ignore_errors=True)

    def draft(self) -> Path:
        """A new folder for the arrays of a flight; who asked for it removes what is left of it."""
        draft = self._root / f".new-{uuid4().hex}"
        draft.mkdir()
        return draft

    def adopt(
        self, draft: Path, facts: FlightFacts, name: str, source: Path, source_sha256: str, source_format: str
    ) -> tuple[TrajectoryRow, bool]:
        """Store the flight whose arrays are in `draft`, and its source file: both are moved away if it is new."""
        with self._changing, self._database.begin() as session:
            row = session.get(TrajectoryRow, facts.sha256)
            target = self.folder(facts.sha256)
            if row is not None:
                if not target.is_dir():  # it was lost; here it is again
                    durable.rename(draft, target)
                return row, False
            row = TrajectoryRow(
                source_sha256=source_sha256,
                name=name,
                source_format=source_format,
                source_bytes=source.stat().st_size,
                created=time.time(),
                tags=[],
                notes="",
                search=search_text(NO_LABELS, name),
                **facts.to_json(),
            )
            session.add(row)
            shutil.move(source, draft / f"source.{source_format}")
            shutil.rmtree(target, ignore_errors=True)  # without a row it is what a crash left
            durable.rename(draft, target)
        return row, True

    def get(self, sha256: str) -> TrajectoryRow:
        """The row. Raises `NotFoundError`."""
        with self._database.begin() as session:
            row = session.get(TrajectoryRow, sha256)
        if row is None:
            raise NotFoundError("trajectory", sha256)
        return row

    def all(
        self, before: Key | None = None, limit: int | None = None, wanted: Wanted = EVERYTHING
    ) -> list[TrajectoryRow]:
        """Newest first, those after the row at `before`, at most `limit`; those that are wanted."""
        query = newest_first(select(TrajectoryRow), TrajectoryRow.created, TrajectoryRow.sha256, before, limit)
        query = query.where(*searched(wanted, TrajectoryRow.search))
        with self._database.begin() as session:
            return list(session.scalars(query))

    def label(self, sha256: str, labels: Labels) -> TrajectoryRow:
        """Put tags and notes to a flight, in place of those it has. Raises `NotFoundError`."""
        with self._database.begin() as session:
            row = session.get(TrajectoryRow, sha256)
            if row is None:
                raise NotFoundError("trajectory", sha256)
            row.tags, row.notes, row.search = list(labels.tags), labels.notes, search_text(labels, row.name)
        return row

    def folder(self, sha256: str) -> Path:
        """Where the arrays are (`formats.flight_folder` reads them)."""
        return self._root / sha256

    def remove(self, sha256: str) -> None:
        """Remove a flight. Raises `NotFoundError`, or `InUseError` where a plan is made from it."""
        with self._changing:
            with self._database.begin() as session:
                row = session.get(TrajectoryRow, sha256)
                if row is None:
                    raise NotFoundError("trajectory", sha256)
                plans = session.scalar(select(func.count()).where(PlanRow.trajectory == sha256)) or 0
                if plans:
                    raise InUseError("trajectory", sha256, f"{plans} plan(s)")
                session.delete(row)
            shutil.rmtree(self.folder(sha256), ignore_errors=True)

    def lost(self, sha256: str) -> None:
        """Its arrays are gone. A flight that no plan needs goes with them; another can be uploaded again."""
        with contextlib.suppress(InUseError, NotFoundError):
            self.remove(sha256)
