"""The audit is append-only: the database refuses anything else, and the chain shows what was done by other means."""

import json
import shutil
import sqlite3
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy.exc import IntegrityError

from fullpose_server.errors import DamagedError, FileError
from fullpose_server.store import hash_chain
from fullpose_server.store.audit import LINKED, AuditLog, newest_hash, read_rows
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database, NewerDatabaseError
from fullpose_server.store.hash_chain import GENESIS, AuditReport, row_hash
from fullpose_server.store.reading import EarlierDatabaseError, reading

ROWS = 9


def entry(number: int) -> AuditEntry:
    return AuditEntry(
        at=1.8e9 + 0.1 * number,
        who="ann",
        rig="vertical-4" if number % 2 else "",
        command="start",
        args={"plan": f"ü{number}", "nested": {"b": [1, 2.5, None], "a": True}},
        lease=(3, number) if number % 3 else None,
        states=("armed", "positioning"),
        accepted=number % 4 != 0,
        detail=None if number % 4 else "refused: it is not armed",
        address="10.0.0.7" if number % 2 else None,
    )


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database whose server has ended."""
    path = tmp_path_factory.mktemp("audit") / "fullpose.db"
    database = Database(path)
    log = AuditLog(database)
    for first in range(1, ROWS + 1, 4):
        log.write([entry(number) for number in range(first, min(first + 4, ROWS + 1))])
    database.close()
    return path


@pytest.fixture
def copied(written: Path, tmp_path: Path) -> Path:
    path = tmp_path / "fullpose.db"
    shutil.copyfile(written, path)
    return path


def found(path: Path, expected: str | None = None) -> AuditReport:
    with reading(path) as session:
        return hash_chain.verify(read_rows(session), expected)


def tamper(path: Path, *statements: str, parameters: tuple[Any, ...] = ()) -> None:
    """What somebody does who has the file: no trigger is in the way for long."""
    connection = sqlite3.connect(path)
    for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
        connection.execute(f"DROP TRIGGER {name}")
    for statement in statements:
        connection.execute(statement, parameters)
    connection.commit()
    connection.close()


def test_what_was_written_fits(written: Path) -> None:
    report = found(written)
    assert (report.rows, report.broken, report.why) == (ROWS, None, None)
    assert (report.first_at, report.last_at) == (entry(1).at, entry(ROWS).at)
    with reading(written) as session:
        assert report.head == newest_hash(session)
        rows = list(read_rows(session))
    assert rows[0]["previous"] == GENESIS
    assert rows[4]["args"] == entry(5).args
    assert rows[3]["address"] is None
    assert rows[4]["address"] == "10.0.0.7"


def test_the_encoding_stays_as_it_is() -> None:
    """Hashes that were kept elsewhere years ago are to be found again."""
    content = {**dict.fromkeys(hash_chain.CONTENT), "id": 1, "at": 1.5, "who": "ü", "args": {"b": 1, "a": [0.1]}}
    assert row_hash(content, GENESIS) == "a289b5f74dd0d068d80fa31182e3cb4218719626a670deaeda639b9c9d17e0dc"


CHANGES = {
    "id": 99,
    "at": 1.0,
    "who": "bob",
    "address": "10.0.0.8",
    "rig": "other",
    "command": "stop",
    "args": json.dumps({"plan": "other"}),
    "lease_epoch": 77,
    "lease_sequence": 77,
    "state_before": "idle",
    "state_after": "idle",
    "accepted": 2,
    "detail": "nothing",
    "previous": "f" * 64,
    "hash": "f" * 64,
}


@pytest.mark.parametrize("column", LINKED)
@pytest.mark.parametrize("number", [1, 5, ROWS])
def test_a_row_that_was_edited_is_found(copied: Path, column: str, number: int) -> None:
    tamper(copied, f"UPDATE audit SET {column} = ? WHERE id = {number}", parameters=(CHANGES[column],))
    report = found(copied)
    assert report.rows == number - 1
    if column != "id":
        assert report.broken == number


@pytest.mark.parametrize("value", ["{", b"\xff", None, "[]", 3])
def test_arguments_that_are_none_are_found(copied: Path, value: Any) -> None:
    tamper(copied, "PRAGMA ignore_check_constraints = on")
    try:
        tamper(copied, "UPDATE audit SET args = ? WHERE id = 4", parameters=(value,))
    except sqlite3.IntegrityError:
        return  # not null
    assert found(copied).broken == 4


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_row_deleted_moved_or_put_in_is_found(written: Path, tmp_path: Path, data: st.DataObject) -> None:
    path = tmp_path / "fullpose.db"
    shutil.copyfile(written, path)
    one = data.draw(st.integers(1, ROWS - 1))
    other = data.draw(st.integers(one + 1, ROWS))
    how = data.draw(st.sampled_from(["delete", "swap", "insert", "forge"]))
    rest = ", ".join(name for name in LINKED if name != "id")
    match how:
        case "delete":
            tamper(path, f"DELETE FROM audit WHERE id = {one}")
        case "swap":
            tamper(
                path,
                *(f"UPDATE audit SET id = {to} WHERE id = {of}" for of, to in ((one, 0), (other, one), (0, other))),
            )
        case "insert":
            tamper(
                path,
                "DROP INDEX ix_audit_previous",
                f"INSERT INTO audit (id, {rest}) SELECT {ROWS + 1}, {rest} FROM audit WHERE id = {one}",
            )
        case "forge":  # with a hash that fits its own new content
            forge(path, one)
    report = found(path)
    assert report.broken is not None
    assert report.rows <= ROWS


def forge(path: Path, number: int) -> None:
    with reading(path) as session:
        row = next(row for row in read_rows(session) if row["id"] == number)
    row["who"] = "bob"
    made = row_hash(row, row["previous"])
    tamper(path, f"UPDATE audit SET who = 'bob', hash = '{made}' WHERE id = {number}")


def test_a_tail_that_was_cut_off_is_shown_by_a_hash_kept_elsewhere(copied: Path) -> None:
    kept = found(copied).head
    assert found(copied, kept).why is None
    tamper(copied, f"DELETE FROM audit WHERE id > {ROWS - 2}")
    assert found(copied).why is None  # the chain alone cannot show it
    report = found(copied, kept)
    assert report.broken is None
    assert report.why is not None
    assert kept in report.why


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE audit SET who = 'bob' WHERE id = 2",
        "DELETE FROM audit WHERE id = 2",
        "DELETE FROM audit",
        "INSERT OR REPLACE INTO audit SELECT * FROM audit WHERE id = 2",
        "INSERT INTO audit SELECT * FROM audit WHERE id = 2",
    ],
)
def test_the_database_refuses_what_is_not_added_at_the_end(copied: Path, statement: str) -> None:
    connection = sqlite3.connect(copied)
    with pytest.raises(sqlite3.IntegrityError, match="append-only"):
        connection.execute(statement)
    connection.close()
    assert found(copied).rows == ROWS


def test_two_writers_make_one_chain(copied: Path) -> None:
    databases = [Database(copied), Database(copied)]
    logs = [AuditLog(database) for database in databases]
    for number in range(6):
        logs[number % 2].write([entry(number)])
    for database in databases:
        database.close()
    assert found(copied).rows == ROWS + 6


def test_writers_at_the_same_time_make_one_chain(copied: Path) -> None:
    databases = [Database(copied, busy_s=60.0) for _ in range(3)]

    def write(database: Database) -> None:
        for number in range(10):
            AuditLog(database).write([entry(number)])

    with ThreadPoolExecutor(3) as pool:
        list(pool.map(write, databases))
    for database in databases:
        database.close()
    assert found(copied).rows == ROWS + 30


def test_a_batch_that_cannot_be_written_leaves_nothing(copied: Path) -> None:
    database = Database(copied)
    bad = entry(2)
    with pytest.raises(IntegrityError):
        AuditLog(database).write([entry(1), AuditEntry(**{**vars(bad), "who": None})])  # type: ignore[arg-type]
    AuditLog(database).write([bad])
    database.close()
    assert found(copied).rows == ROWS + 1


def snapshot(folder: Path) -> dict[str, tuple[bytes, int]]:
    return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in sorted(folder.iterdir())}


def test_reading_changes_nothing_and_leaves_nothing(copied: Path) -> None:
    before = snapshot(copied.parent)
    assert found(copied).rows == ROWS
    assert snapshot(copied.parent) == before


def test_reading_while_it_is_written(copied: Path) -> None:
    database = Database(copied)
    log = AuditLog(database)
    log.write([entry(1)])
    assert found(copied).rows == ROWS + 1  # of the write-ahead log too
    log.write([entry(2)])
    assert found(copied).rows == ROWS + 2
    database.close()


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda path: path.unlink(), FileError),
        (lambda path: path.write_bytes(b"no database at all" * 100), DamagedError),
        (lambda path: tamper(path, "UPDATE alembic_version SET version_num = '0004'"), EarlierDatabaseError),
        (lambda path: tamper(path, "UPDATE alembic_version SET version_num = '9999'"), NewerDatabaseError),
        (lambda path: tamper(path, "DROP TABLE alembic_version"), FileError),
    ],
)
def test_what_is_no_database_of_this_version_is_refused(
    copied: Path, make: Callable[[Path], Any], error: type[Exception]
) -> None:
    make(copied)
    with pytest.raises(error), reading(copied):
        pass


@pytest.fixture
def earlier(tmp_path: Path) -> Path:
    """A database of revision 0005, its audit with gaps, as an earlier Fullpose left it."""
    from alembic import command
    from alembic.config import Config

    from fullpose_server.store.database import MIGRATIONS

    path = tmp_path / "earlier.db"
    database = Database(path)
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    with database.engine.begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "0005")
    database.close()
    connection = sqlite3.connect(path)
    for number in (1, 2, 5, 9):
        values = (number, 1.5, "ann", "rig", "load", '{"plan": "p"}', 1, 2, "idle", "ready", 1, None)
        connection.execute("INSERT INTO audit VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", values)
    connection.commit()
    connection.close()
    return path


def test_the_rows_of_an_earlier_version_are_chained(earlier: Path) -> None:
    database = Database(earlier)
    AuditLog(database).write([entry(1)])
    database.close()
    assert found(earlier).rows == 5
    with reading(earlier) as session:
        assert [row["id"] for row in read_rows(session)] == [1, 2, 3, 4, 5]
    connection = sqlite3.connect(earlier)
    with pytest.raises(sqlite3.IntegrityError, match="append-only"):
        connection.execute("DELETE FROM audit")
    connection.close()
