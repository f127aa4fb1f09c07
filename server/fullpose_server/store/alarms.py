"""The alarm history: one row an alarm, over restarts of server and rig process; and the shelves that stand."""

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from sqlalchemy import delete, select, tuple_

from fullpose_server.session.alarms import Alarm, Shelf
from fullpose_server.store.database import Database
from fullpose_server.store.keyset import Key, newest_first
from fullpose_server.store.tables import AlarmRow, ShelfRow

DAY_S = 86_400.0


@dataclass(frozen=True)
class RaisedAlarm:
    """An alarm of a rig; each life of its process numbers them from 1."""

    rig: str
    life: str
    alarm: Alarm

    @property
    def id(self) -> str:
        """Unlike any other's, whatever restarts."""
        return alarm_id(self.life, self.alarm.number)


@dataclass(frozen=True)
class RigShelves:
    """All the shelves of a rig."""

    rig: str
    shelves: tuple[Shelf, ...]


@dataclass(frozen=True)
class AlarmFilter:
    """Which alarms are asked for; None: whatever. `since_s`, `until_s`: of the first occurrence [s, Unix]."""

    rig: str | None = None
    severity: str | None = None
    code: str | None = None
    since_s: float | None = None
    until_s: float | None = None
    ids: Collection[str] | None = None
    but: Collection[str] = ()


def alarm_id(life: str, number: int) -> str:
    """Of alarm `number` of that life of a rig process."""
    return f"{life}-{number}"


class AlarmHistory:
    """Written by `AlarmTrail`; an alarm that changes is the same row."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def write(self, entries: Sequence[RaisedAlarm | RigShelves]) -> None:
        """Add or change them, all or none."""
        with self._database.begin() as session:
            ids = [entry.id for entry in entries if isinstance(entry, RaisedAlarm)]
            known = {row.id: row for row in session.scalars(select(AlarmRow).where(AlarmRow.id.in_(ids)))}
            for entry in entries:
                match entry:
                    case RaisedAlarm():
                        row = known.setdefault(entry.id, AlarmRow(id=entry.id, rig=entry.rig))
                        for name, value in asdict(entry.alarm).items():
                            setattr(row, name, None if value != value else value)  # SQLite has no NaN
                        session.add(row)
                    case RigShelves():
                        session.execute(delete(ShelfRow).where(ShelfRow.rig == entry.rig))
                        session.add_all(ShelfRow(rig=entry.rig, **asdict(shelf)) for shelf in entry.shelves)

    def all(self, wanted: AlarmFilter, before: Key | None, limit: int) -> list[AlarmRow]:
        """Newest first by the first occurrence, those after the one at `before`, at most `limit`."""
        query = newest_first(select(AlarmRow), AlarmRow.time_s, AlarmRow.id, before, limit)
        for column, value in ((AlarmRow.rig, wanted.rig), (AlarmRow.severity, wanted.severity)):
            if value is not None:
                query = query.where(column == value)
        if wanted.code is not None:
            query = query.where(AlarmRow.code == wanted.code)
        if wanted.since_s is not None:
            query = query.where(AlarmRow.time_s >= wanted.since_s)
        if wanted.until_s is not None:
            query = query.where(AlarmRow.time_s < wanted.until_s)
        if wanted.ids is not None:
            query = query.where(AlarmRow.id.in_(wanted.ids))
        if wanted.but:
            query = query.where(AlarmRow.id.not_in(wanted.but))
        with self._database.begin() as session:
            return list(session.scalars(query))

    def shelves(self, rig: str, now_s: float) -> tuple[Shelf, ...]:
        """Those of a rig that have not ended."""
        with self._database.begin() as session:
            rows = session.scalars(select(ShelfRow).where(ShelfRow.rig == rig))
            shelves = [Shelf(r.code, r.frame, r.since_s, r.until_s, r.by, r.reason) for r in rows]
        return tuple(shelf for shelf in shelves if shelf.lasts(now_s))

    def sweep(self, days: float | None, most: int | None, now_s: float) -> int:
        """Remove what is older than so many days, then the oldest beyond so many; returns how many went."""
        gone = 0
        with self._database.begin() as session:
            if days is not None:
                old = delete(AlarmRow).where(AlarmRow.time_s < now_s - days * DAY_S)
                gone += _count(session.execute(old))
            if most is not None:
                newest = select(AlarmRow.time_s, AlarmRow.id).order_by(AlarmRow.time_s.desc(), AlarmRow.id.desc())
                beyond = session.execute(newest.offset(most).limit(1)).first()
                if beyond is not None:
                    surplus = delete(AlarmRow).where(tuple_(AlarmRow.time_s, AlarmRow.id) <= tuple_(*beyond))
                    gone += _count(session.execute(surplus))
        return gone


def _count(result: Any) -> int:
    return int(result.rowcount)
