"""What is PostgreSQL's alone: one that is not there, one that hangs, one that ends, and texts that it does not take."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import text

from fullpose_server.errors import StorageError
from fullpose_server.location import PostgresqlUrl
from fullpose_server.people.roles import Role
from fullpose_server.session.alarms import Alarm, Severity
from fullpose_server.store import hash_chain, postgresql
from fullpose_server.store.alarm_trail import AlarmTrail
from fullpose_server.store.alarms import AlarmFilter, AlarmHistory, RaisedAlarm
from fullpose_server.store.audit import AuditLog, read_rows
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.belonging import FILE, ForeignDatabaseError, bind
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from fullpose_server.store.people_known import has_people
from fullpose_server.store.reading import reading
from tests.support.postgresql import Server, programs, running_postgresql
from tests.support.waiting import until


@pytest.fixture
def url(postgresql: Server) -> PostgresqlUrl:
    return postgresql.made()


@pytest.fixture
def own() -> Iterator[Server]:
    """One that the test may hurt."""
    if programs() is None:
        pytest.skip("PostgreSQL is not installed (Debian's package: postgresql)")
    with running_postgresql() as server:
        yield server


def test_a_url_is_shown_without_its_password() -> None:
    url = PostgresqlUrl.of("postgresql+psycopg://ann:s%20ecret@db.lab:5433/fullpose?sslmode=require&sslpassword=x")
    assert str(url) == "postgresql://ann@db.lab:5433/fullpose?sslmode=require"
    assert "ecret" not in repr(url)
    assert url.url.startswith("postgresql://ann:s%20ecret@db.lab:5433/fullpose?")
    assert str(PostgresqlUrl.of("postgresql://ann@/db?host=/run/postgresql")) == (
        "postgresql://ann@/db?host=/run/postgresql"
    )


@pytest.mark.parametrize("text_", ["mysql://a/b", "postgresql://ann:secret@host", "postgresql://h:99999999/d", "x"])
def test_what_is_no_url_of_one_is_refused_without_repeating_it(text_: str) -> None:
    with pytest.raises(ValueError, match=r".") as refusal:
        PostgresqlUrl.of(text_)
    assert "secret" not in str(refusal.value)


def test_one_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    nowhere = PostgresqlUrl.of(f"postgresql://ann:secret@/fullpose?host={tmp_path}")
    for use in (lambda: Database(nowhere), lambda: has_people(nowhere)):
        with pytest.raises(StorageError, match="does not answer") as refusal:
            use()
        assert str(nowhere) in str(refusal.value)
        assert "\n" not in str(refusal.value)
        assert "secret" not in str(refusal.value)


def test_one_that_is_another_program_s_is_not_read(postgresql: Server) -> None:
    other = postgresql.made(migrated=False)
    assert not has_people(other)
    with pytest.raises(Exception, match="this is another"), reading(other):
        pass


def test_one_that_hangs_holds_nobody_for_long_and_loses_no_alarm(own: Server) -> None:
    database = Database(own.made())
    history = AlarmHistory(database)
    trail = AlarmTrail(history)
    with database.begin() as session:
        session.execute(text("SELECT 1"))
    own.stop_answering()
    try:
        trail.raised("bench", "life", [Alarm(1, "late", Severity.WARNING, "late", 1.0)])
        with pytest.raises(StorageError, match="does not answer"):
            PeopleStore(database).revision()
        (told,) = until(trail.faults)
        assert "1 lines wait to be written to the alarm history: the database does not answer" in told
    finally:
        own.answer()
    assert trail.written(60.0)
    assert trail.faults() == []
    assert [row.id for row in history.all(AlarmFilter(), None, 10)] == ["life-1"]
    trail.close()
    database.close()


def test_a_connection_that_was_cut_is_made_anew_unseen(url: PostgresqlUrl) -> None:
    database, other = Database(url), postgresql.patient_engine(url, changes=True)
    people = PeopleStore(database)
    people.add("ann", Role.ADMIN, None)
    with other.begin() as connection:
        mine = "pid <> pg_backend_pid() AND datname = current_database()"
        connection.execute(text(f"SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE {mine}"))
    other.dispose()
    assert [row.name for row in people.all()] == ["ann"]
    database.close()


def test_one_that_ended_is_said_and_found_again_by_whoever_asks_next(own: Server) -> None:
    database = Database(own.made())
    people = PeopleStore(database)
    people.add("ann", Role.ADMIN, None)
    os.kill(own.process.pid, signal.SIGQUIT)
    own.process.wait(60)
    with pytest.raises(StorageError, match="does not"):
        people.all()
    database.close()


def test_texts_and_numbers_that_it_has_not_are_kept_as_near_as_can_be(url: PostgresqlUrl) -> None:
    """A row that cannot be written would stand before all that follow it for ever."""
    database = Database(url)
    log, history = AuditLog(database), AlarmHistory(database)
    args = {"a": "x\0y", "b": [1e308, 2**70]}
    log.write([AuditEntry(1.0, "w" * 500, "r" * 500, "c\0" * 99, args, (2**40, 1), ("a" * 99, ""), True, "\0")])
    history.write([RaisedAlarm("r" * 99, "l", Alarm(1, "c" * 99, Severity.FAULT, "\0", 1.0, value=float("nan")))])
    (alarm,) = history.all(AlarmFilter(rig="r" * 99), None, 10)
    assert (alarm.value, alarm.message) == (None, "\N{SYMBOL FOR NULL}")
    with reading(url) as session:
        rows = list(read_rows(session))
    assert hash_chain.verify(rows).rows == 1
    assert rows[0]["args"] == args
    assert PeopleStore(database).get("ann\0") is None
    database.close()


def test_who_only_reads_cannot_write(url: PostgresqlUrl) -> None:
    with pytest.raises(Exception, match="read-only"), reading(url) as session:
        session.execute(text("DELETE FROM plans"))


def test_a_database_has_one_data_folder(url: PostgresqlUrl, postgresql: Server, tmp_path: Path) -> None:
    database = Database(url)
    mine, other = tmp_path / "mine", tmp_path / "other"
    for folder in (mine, other):
        folder.mkdir()
    for _ in range(2):
        bind(database, url, mine)
    with pytest.raises(ForeignDatabaseError, match="another data folder"):
        bind(database, url, other)
    assert not (other / FILE).exists()
    (other / "fullpose.db").touch()
    with pytest.raises(ForeignDatabaseError, match="rows of its own"):
        bind(database, url, other)
    database.close()
