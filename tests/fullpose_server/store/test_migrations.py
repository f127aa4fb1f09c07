"""Every earlier revision, with rows in all its tables, leads to today's, and today's code reads its rows."""

import json
from pathlib import Path
from typing import Any

import pytest
from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, MetaData, insert, inspect, text

from fullpose_server.formats.labels import Wanted
from fullpose_server.location import Location
from fullpose_server.people.admitted import Shown
from fullpose_server.people.roles import Role
from fullpose_server.secret import proof_of
from fullpose_server.session.alarms import Shelf
from fullpose_server.store import hash_chain, postgresql, sqlite
from fullpose_server.store.alarms import AlarmFilter, AlarmHistory
from fullpose_server.store.audit import AuditLog, read_rows
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import HEAD, MIGRATIONS, Database
from fullpose_server.store.hash_chain import GENESIS, row_hash
from fullpose_server.store.people import PeopleStore
from fullpose_server.store.plans import PlanStore
from fullpose_server.store.reading import EarlierDatabaseError, reading
from fullpose_server.store.trajectories import TrajectoryStore
from tests.support.postgresql import Server

FLIGHT, SECRET = "f" * 64, "a secret of long ago"
AUDIT = {
    "at": 1.5,
    "who": "ann",
    "rig": "bench",
    "command": "load",
    "args": json.dumps({"plan": "p"}),
    "lease_epoch": 1,
    "lease_sequence": 2,
    "state_before": "idle",
    "state_after": "ready",
    "accepted": True,
    "detail": None,
}
# What each table has had since it is there; a column that a later revision added is given where the table has it.
ROWS: dict[str, list[dict[str, Any]]] = {
    "trajectories": [
        {
            "sha256": FLIGHT,
            "source_sha256": "0" * 64,
            "name": "Überflug",
            "convention": "nue",
            "source_format": "csv",
            "source_bytes": 1000,
            "samples": 3,
            "start_s": 0.0,
            "duration_s": 0.1,
            "rate_hz": 20.0,
            "uniform": True,
            "peak_body_rate_deg_s": None,
            "warnings": json.dumps([{"code": "c", "message": "m"}]),
            "created": 1000.25,
            "tags": json.dumps(["old"]),
            "notes": "kept",
            "search": "überflug\nkept\x1fold\x1f",
            "input": json.dumps({"format": "csv", "statement": "as it is"}),
        }
    ],
    "plans": [
        {
            "id": plan,
            "trajectory": FLIGHT,
            "rig": "bench",
            "rig_hash": "h",
            "method": "plan",
            "options": json.dumps({"stage": 1}),
            "start_deg": json.dumps([0.0, 1.0, 2.0, 3.0]),
            "tolerance_deg": 0.25,
            "remedy": json.dumps({"of": "p0", "kind": "rate", "frame": None, "limit": None}),
            "rate_hz": 1000.0,
            "status": status,
            "error": None,
            "result": json.dumps({"feasible": True}),
            "created": created,
            "started": created,
            "finished": created,
            "tags": json.dumps([]),
            "notes": "",
            "search": "bench\nplan\n\x1f",
        }
        for plan, status, created in (("p1", "done", 1001.0), ("p2", "running", 1002.0))
    ],
    "alarms": [
        {
            "id": "life-1",
            "rig": "bench",
            "number": 1,
            "code": "late",
            "severity": "warning",
            "message": "a tick was late",
            "time_s": 1003.0,
            "frame": "base",
            "value": 3.0,
            "limit": 2.0,
            "unit": "ms",
            "first": True,
            "acknowledged_by": None,
            "acknowledged_s": None,
            "count": 2,
            "last_time_s": 1004.0,
            "shelved": False,
        }
    ],
    "shelves": [
        {
            "id": 1,
            "rig": "bench",
            "code": "late",
            "frame": None,
            "since_s": 1.0,
            "until_s": 43_000.0,
            "by": "ann",
            "reason": "known",
        }
    ],
    "users": [
        {
            "name": "ann",
            "role": "admin",
            "password": None,
            "subject": None,
            "disabled": False,
            "created": 1.0,
            "changed": 1,
        }
    ],
    "credentials": [
        {
            "id": "c1",
            "proof": proof_of(SECRET),
            "user": "ann",
            "role": "operator",
            "session": False,
            "label": "a token",
            "address": None,
            "created": 1.0,
            "until": None,
            "revoked": None,
            "changed": 2,
        }
    ],
    "data_folder": [{"id": "folder"}],
}
REVISIONS = [f"{number:04d}" for number in range(1, int(HEAD) + 1)]


def config() -> Config:
    made = Config()
    made.set_main_option("script_location", str(MIGRATIONS))
    return made


def audit_rows(linked: bool) -> list[dict[str, Any]]:
    """With gaps, as an earlier version's are; of a chain without."""
    if not linked:
        return [{"id": number, **AUDIT} for number in (1, 2, 5)]
    rows, previous = [], GENESIS
    for number in (1, 2, 3):
        row = {"id": number, **AUDIT, "address": "10.0.0.7", "previous": previous}
        content = {**row, "args": json.loads(AUDIT["args"])}  # type: ignore[arg-type]
        rows.append({**row, "hash": (previous := row_hash(content, previous))})
    return rows


def fill(engine: Engine, revision: str) -> None:
    """A database of that revision, with its rows written as SQL would write them: no code of the product's."""
    with engine.begin() as connection:
        made = config()
        made.attributes["connection"] = connection
        command.upgrade(made, revision)
    tables = MetaData()
    tables.reflect(engine)
    with engine.begin() as connection:
        for table in tables.sorted_tables:
            rows = audit_rows("hash" in table.columns) if table.name == "audit" else ROWS.get(table.name, [])
            assert rows or table.name == "alembic_version", table.name
            for row in rows:
                given = {name: value for name, value in row.items() if name in table.columns}
                assert set(given) == {column.name for column in table.columns}, table.name
                names = ", ".join(f'"{name}"' for name in given)
                values = ", ".join(f":{name}" for name in given)
                connection.execute(text(f'INSERT INTO "{table.name}" ({names}) VALUES ({values})'), given)


@pytest.fixture(params=["sqlite", "postgresql"])
def empty(request: pytest.FixtureRequest, tmp_path: Path) -> Location:
    if request.param == "sqlite":
        return tmp_path / "fullpose.db"
    server: Server = request.getfixturevalue("postgresql")
    return server.made(migrated=False)


@pytest.fixture(params=REVISIONS)
def filled(request: pytest.FixtureRequest, empty: Location) -> tuple[Location, str]:
    engine = sqlite.engine(empty, 2.0) if isinstance(empty, Path) else postgresql.patient_engine(empty, changes=True)
    fill(engine, request.param)
    engine.dispose()
    return empty, request.param


def test_the_revisions_are_those_that_there_are() -> None:
    scripts = ScriptDirectory.from_config(config())
    assert [script.revision for script in reversed(list(scripts.walk_revisions()))] == REVISIONS


def test_all_rows_of_a_revision_are_read_by_today_s_code(filled: tuple[Location, str], tmp_path: Path) -> None:
    location, revision = filled
    if revision != HEAD:
        with pytest.raises(EarlierDatabaseError, match=f"revision {revision}"), reading(location):
            pass
    database = Database(location)
    (flight,) = TrajectoryStore(database, tmp_path / "trajectories").all(wanted=Wanted.of("üBERflug", None))
    assert (flight.sha256, flight.name, flight.created, flight.uniform) == (FLIGHT, "Überflug", 1000.25, True)
    assert flight.input == ({"format": "csv", "statement": "as it is"} if revision >= "0009" else None)
    assert flight.warnings == [{"code": "c", "message": "m"}]
    assert (flight.tags, flight.notes) == ((["old"], "kept") if revision >= "0007" else ([], ""))
    plans = PlanStore(database, tmp_path / "plans")
    assert plans.after_restart() == []
    (newer, name), (older, _) = plans.all(rig="bench", wanted=Wanted.of("BENCH plan über", None))
    assert (newer.id, newer.status, older.id, older.status, name) == ("p2", "interrupted", "p1", "done", "Überflug")
    assert (older.options, older.start_deg, older.result) == ({"stage": 1}, [0.0, 1.0, 2.0, 3.0], {"feasible": True})
    assert (older.remedy is not None) == (revision >= "0002")
    assert older.tolerance_deg == (0.25 if revision >= "0008" else None)
    _read_audit(database, location)
    _read_alarms(AlarmHistory(database), there=revision >= "0004")
    _read_people(PeopleStore(database), there=revision >= "0005")
    database.close()


def _read_audit(database: Database, location: Location) -> None:
    log = AuditLog(database)
    log.write([AuditEntry(2.5, "bob", "bench", "stop", {"ü": 1}, None, ("running", "stopping"), True, None)])
    with reading(location) as session:
        rows = list(read_rows(session))
    assert [row["id"] for row in rows] == [1, 2, 3, 4]
    assert {name: rows[1][name] for name in AUDIT} == {**AUDIT, "args": {"plan": "p"}}
    report = hash_chain.verify(rows)
    assert (report.rows, report.broken) == (4, None)
    assert [row.who for row in log.all("bench", None, 10)] == ["bob", "ann", "ann", "ann"]
    with pytest.raises(Exception, match="append-only"), database.engine.begin() as connection:
        connection.execute(text("DELETE FROM audit"))


def _read_alarms(history: AlarmHistory, *, there: bool) -> None:
    found = history.all(AlarmFilter(code="late"), None, 10)
    assert [(row.id, row.count, row.value, row.first) for row in found] == ([("life-1", 2, 3.0, True)] if there else [])
    shelf = Shelf("late", None, 1.0, 43_000.0, "ann", "known")
    assert history.shelves("bench", 5.0) == ((shelf,) if there else ())


def _read_people(people: PeopleStore, *, there: bool) -> None:
    assert people.admitted().people is there
    found = people.admitted().find(Shown(SECRET, cookie=False), 0.0)
    assert (found is not None and found.role == Role.OPERATOR) is there
    people.add("bob", Role.VIEWER, None)
    assert people.revision() > (2 if there else 0)


def test_today_s_database_goes_back_and_forth(empty: Location) -> None:
    """A downgrade is for who tries a version: it takes what that version has not, and leaves the rest."""
    engine = sqlite.engine(empty, 2.0) if isinstance(empty, Path) else postgresql.patient_engine(empty, changes=True)
    fill(engine, HEAD)
    with engine.begin() as connection:
        made = config()
        made.attributes["connection"] = connection
        command.downgrade(made, "0001")
    with engine.begin() as connection:
        assert {"trajectories", "plans", "audit"} <= set(inspect(connection).get_table_names())
        assert connection.scalar(text("SELECT count(*) FROM audit")) == 3
        tables = MetaData()
        tables.reflect(connection, only=["audit"])
        connection.execute(insert(tables.tables["audit"]).values({"id": 9, **AUDIT, "args": {}}))
    engine.dispose()
    Database(empty).close()
    with reading(empty) as session:
        assert hash_chain.verify(read_rows(session)).rows == 4
