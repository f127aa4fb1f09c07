"""Plans as the database knows them: one row a plan, its job's status in the row, its arrays in plans/<id>/."""

import shutil
import time
from collections.abc import Collection
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, cast
from uuid import uuid4

from sqlalchemy import Select, select

from fullpose_server.errors import NotFoundError, TransitionError
from fullpose_server.formats.labels import EVERYTHING, NO_LABELS, Labels, Wanted, search_text
from fullpose_server.store.database import Database
from fullpose_server.store.jobs import UNFINISHED, JobStatus
from fullpose_server.store.keyset import Key, newest_first, searched
from fullpose_server.store.tables import PlanRow, TrajectoryRow

SEARCHED = (PlanRow.search, TrajectoryRow.search)


@dataclass(frozen=True)
class PlanAsked:
    """What a plan is asked for; `remedy` (of, kind, frame, limit) makes it a remedy of another."""

    trajectory: str
    rig: str
    rig_hash: str
    method: str
    options: dict[str, Any]
    start_deg: list[float] | None
    rate_hz: float
    tolerance_deg: float | None = None  # by which the attitude may differ from the flight's
    remedy: dict[str, Any] | None = None


class PlanStore:
    """Adds, lists, removes plans and moves their status; who runs them is `PlanQueue`."""

    def __init__(self, database: Database, root: Path) -> None:
        self._database = database
        self.root = root
        root.mkdir(parents=True, exist_ok=True)

    def add(self, asked: PlanAsked) -> PlanRow:
        """A new plan, queued. Raises `NotFoundError` for an unknown trajectory."""
        with self._database.begin() as session:
            if session.get(TrajectoryRow, asked.trajectory) is None:
                raise NotFoundError("trajectory", asked.trajectory)
            row = PlanRow(
                id=uuid4().hex[:16],
                **{each.name: getattr(asked, each.name) for each in fields(asked)},
                status=JobStatus.QUEUED,
                error=None,
                result=None,
                created=time.time(),
                started=None,
                finished=None,
                tags=[],
                notes="",
                search=search_text(NO_LABELS, asked.rig, asked.method),
            )
            session.add(row)
        return row

    def get(self, plan: str) -> PlanRow:
        """Raises `NotFoundError`."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
        if row is None:
            raise NotFoundError("plan", plan)
        return row

    def all(
        self,
        trajectory: str | None = None,
        rig: str | None = None,
        before: Key | None = None,
        limit: int | None = None,
        wanted: Wanted = EVERYTHING,
    ) -> list[tuple[PlanRow, str]]:
        """Newest first, those after the plan at `before`, at most `limit`; each with its flight's name.

        What is wanted may be in the plan's own words and in its flight's.
        """
        query = cast(Select[Any], select(PlanRow, TrajectoryRow.name).join(TrajectoryRow))
        query = newest_first(query, PlanRow.created, PlanRow.id, before, limit)
        if trajectory is not None:
            query = query.where(PlanRow.trajectory == trajectory)
        if rig is not None:
            query = query.where(PlanRow.rig == rig)
        query = query.where(*searched(wanted, *SEARCHED))
        with self._database.begin() as session:
            return [(row, name) for row, name in session.execute(query)]

    def of_wanted(self, part: str, among: Collection[str] | None = None) -> frozenset[str]:
        """The ids of the plans that have this part of what is wanted, in their own words or in their flight's.

        `among`: of these plans alone, some hundreds.
        """
        query = select(PlanRow.id).join(TrajectoryRow)
        if among is not None:
            query = query.where(PlanRow.id.in_(among))
        with self._database.begin() as session:
            return frozenset(session.scalars(query.where(*searched(Wanted((part,)), *SEARCHED))))

    def label(self, plan: str, labels: Labels) -> PlanRow:
        """Put tags and notes to a plan, in place of those it has. Raises `NotFoundError`."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
            if row is None:
                raise NotFoundError("plan", plan)
            row.tags, row.notes, row.search = list(labels.tags), labels.notes, search_text(labels, row.rig, row.method)
        return row

    def folder(self, plan: str) -> Path:
        """Where the plan's arrays are."""
        return self.root / plan

    def begin(self, plan: str) -> PlanRow | None:
        """queued -> running; None where it is no longer queued."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
            if row is None or row.status != JobStatus.QUEUED:
                return None
            row.status, row.started = JobStatus.RUNNING, time.time()
            return row

    def finish(
        self, plan: str, status: JobStatus, *, result: dict[str, Any] | None = None, error: dict[str, Any] | None = None
    ) -> None:
        """queued or running -> done, failed, cancelled or interrupted. Raises `TransitionError` from anywhere else."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
            if row is None or row.status not in UNFINISHED:
                raise TransitionError(f"plan {plan} is {'gone' if row is None else row.status}: it cannot be {status}")
            row.status, row.finished, row.result, row.error = status, time.time(), result, error

    def after_restart(self) -> list[str]:
        """Mark what was running as interrupted, and clear its folder; returns the ids still queued, oldest first."""
        with self._database.begin() as session:
            for row in session.scalars(select(PlanRow).where(PlanRow.status == JobStatus.RUNNING)):
                row.status, row.finished = JobStatus.INTERRUPTED, time.time()
                row.error = {"code": "interrupted", "message": "the server ended while this plan was being made"}
            queued = session.scalars(
                select(PlanRow).where(PlanRow.status == JobStatus.QUEUED).order_by(PlanRow.created)
            )
            ids = [row.id for row in queued]
        for draft in self.root.glob(".*"):  # what a planner was writing
            shutil.rmtree(draft, ignore_errors=True)
        return ids

    def done(self) -> list[str]:
        """The ids of the plans that have been made."""
        with self._database.begin() as session:
            return list(session.scalars(select(PlanRow.id).where(PlanRow.status == JobStatus.DONE)))

    def damaged(self, plan: str, why: str) -> None:
        """A plan that was made is there no more: it has failed, and its row says why."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
            if row is not None and row.status == JobStatus.DONE:
                row.status, row.result = JobStatus.FAILED, None
                row.error = {"code": "damaged", "message": f"its files were damaged, and moved aside: {why}"}

    def remove(self, plan: str) -> None:
        """Remove a finished plan. Raises `NotFoundError`, or `TransitionError` while it is being made."""
        with self._database.begin() as session:
            row = session.get(PlanRow, plan)
            if row is None:
                raise NotFoundError("plan", plan)
            if row.status in UNFINISHED:
                raise TransitionError(f"plan {plan} is {row.status}: cancel it first")
            session.delete(row)
        shutil.rmtree(self.folder(plan), ignore_errors=True)
