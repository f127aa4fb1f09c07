"""Rows go from either database into either, by way of a backup, and come out as they went in."""

import shutil
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import select, text

from fullpose_server.formats.labels import Labels, Wanted
from fullpose_server.location import Location, PostgresqlUrl
from fullpose_server.people.roles import Role
from fullpose_server.session.alarms import Alarm, Severity, Shelf
from fullpose_server.store import hash_chain
from fullpose_server.store.alarms import AlarmHistory, RaisedAlarm, RigShelves
from fullpose_server.store.audit import AuditLog, read_rows
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.backup import make_backup
from fullpose_server.store.belonging import FILE, ForeignDatabaseError, bind
from fullpose_server.store.copying import NotEmptyError, copied_tables
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.reading import reading
from fullpose_server.store.restore import restore_backup
from fullpose_server.store.trajectories import TrajectoryStore
from tests.support.flown import FLIGHT
from tests.support.postgresql import Server
from tests.support.stores import Stores


def filled(location: Location, folder: Path) -> str:
    """Rows in every table, and the folder that they belong to; the flight."""
    database = Database(location)
    bind(database, location, folder)
    flights, plans = TrajectoryStore(database, folder / "trajectories"), PlanStore(database, folder / "plans")
    stores = Stores(database, flights, plans, folder)
    flight = stores.add_flight(FLIGHT, "Überflug")
    flights.label(flight, Labels(("Kunde A",), "first of all"))
    stores.add_plan(flight)
    people = PeopleStore(database)
    people.add("ann", Role.ADMIN, "a long sentence of hers")
    people.make_token("ann", "a token", Role.VIEWER, None)
    args = {"ü": [1, 0.1, None]}
    AuditLog(database).write(
        [AuditEntry(k + 0.1, "ann", "r", "stop", args, None, ("", ""), True, "d") for k in range(3)]
    )
    shelves = RigShelves("bench", (Shelf("late", None, 0.0, 100.0, "ann", "known"),))
    alarm = Alarm(1, "late", Severity.FAULT, "late", 1.1, value=0.1, first=True)
    AlarmHistory(database).write([RaisedAlarm("bench", "life", alarm), shelves])
    database.close()
    return flight


def rows(location: Location) -> dict[str, list[dict[str, Any]]]:
    with reading(location) as session:
        return {
            table.name: [dict(row) for row in session.execute(select(table).order_by(*table.primary_key)).mappings()]
            for table in copied_tables()
        }


@pytest.fixture(params=["sqlite", "postgresql"])
def target(request: pytest.FixtureRequest, tmp_path: Path) -> PostgresqlUrl | None:
    if request.param == "sqlite":
        return None
    server: Server = request.getfixturevalue("postgresql")
    return server.made()


def test_a_backup_of_either_is_restored_into_either(
    location: Location, target: PostgresqlUrl | None, tmp_path: Path
) -> None:
    flight = filled(location, tmp_path)
    before = rows(location)
    assert all(before.values()), "a table without a row shows nothing"
    make_backup(tmp_path, tmp_path / "b.tar", database=location)
    made = tmp_path / "made"
    restore_backup(tmp_path / "b.tar", made, database=target)
    there: Location = target or made / "fullpose.db"
    assert rows(there) == before
    assert (made / "fullpose.db").exists() is (target is None)
    assert not (made / FILE).exists()
    with reading(there) as session:
        assert hash_chain.verify(read_rows(session)).rows == 3
    database = Database(there)
    bind(database, there, made)
    AuditLog(database).write([AuditEntry(9.0, "bob", "r", "stop", {}, None, ("", ""), True, None)])
    AlarmHistory(database).write([RigShelves("two", (Shelf("late", None, 0.0, 100.0, "ann", "known"),))])
    found = TrajectoryStore(database, made / "trajectories").all(wanted=Wanted.of("first", "kunde a"))
    assert [row.sha256 for row in found] == [flight]
    database.close()


def test_rows_are_never_put_to_others(postgresql: Server, tmp_path: Path) -> None:
    location = postgresql.made()
    filled(location, tmp_path)
    make_backup(tmp_path, tmp_path / "b.tar", database=location)
    with pytest.raises(NotEmptyError, match="expected a database without rows"):
        restore_backup(tmp_path / "b.tar", tmp_path / "made", database=location)
    assert not (tmp_path / "made").exists()
    assert not list(tmp_path.glob(".made*"))


def test_what_fails_on_the_way_leaves_neither_rows_nor_files(postgresql: Server, tmp_path: Path) -> None:
    filled(tmp_path / "fullpose.db", tmp_path)
    make_backup(tmp_path, tmp_path / "b.tar")
    location = postgresql.made()
    database = Database(location)
    with database.begin() as session:
        session.execute(text("ALTER TABLE users ADD CONSTRAINT nobody CHECK (name <> 'ann')"))
    with pytest.raises(Exception, match="nobody"):
        restore_backup(tmp_path / "b.tar", tmp_path / "made", database=location)
    database.close()
    assert not any(rows(location).values())
    assert not (tmp_path / "made").exists()
    assert not list(tmp_path.glob(".made*"))


def test_a_backup_is_of_a_folder_and_its_own_database(postgresql: Server, tmp_path: Path) -> None:
    location, folder = postgresql.made(), tmp_path / "mine"
    folder.mkdir()
    filled(location, folder)
    other = tmp_path / "other"
    shutil.copytree(folder, other)
    (other / FILE).write_text("another")
    with pytest.raises(ForeignDatabaseError):
        make_backup(other, tmp_path / "b.tar", database=location)
    assert not (tmp_path / "b.tar").exists()
