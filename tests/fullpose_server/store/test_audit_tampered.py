"""What somebody does to the audit who has the database itself, of either kind: the chain shows it."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from fullpose_server.location import Location
from fullpose_server.store import hash_chain
from fullpose_server.store.audit import LINKED, AuditLog, read_rows
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database
from fullpose_server.store.hash_chain import AuditReport, row_hash
from fullpose_server.store.reading import reading

ROWS = 7
ALL_BUT_ID = ", ".join(name for name in LINKED if name != "id")
CHANGES: dict[str, str] = {
    "at": "1.0",
    "who": "'bob'",
    "address": "'10.0.0.8'",
    "rig": "'other'",
    "command": "'stop'",
    "args": """'{"plan": "other"}'""",
    "lease_epoch": "77",
    "lease_sequence": "77",
    "state_before": "'idle'",
    "state_after": "'idle'",
    "accepted": "NOT accepted",
    "detail": "'nothing'",
    "previous": f"'{'f' * 64}'",
    "hash": f"'{'e' * 64}'",
}


def entry(number: int) -> AuditEntry:
    states = ("armed", "positioning")
    args = {"plan": f"ü{number}", "nested": {"b": [1, 2.5, None], "a": True}}
    return AuditEntry(1.8e9 + 0.1 * number, "ann", "bench", "start", args, (3, number), states, True, None, "10.0.0.7")


@pytest.fixture
def written(location: Location, database: Database) -> Location:
    """A database with an audit."""
    AuditLog(database).write([entry(number) for number in range(1, ROWS + 1)])
    return location


@pytest.fixture
def owner(written: Location, database: Database) -> Iterator[Session]:
    """Somebody who has the database, and has taken the triggers away; what they do is taken back at the end."""
    with Session(database.engine) as session:
        if database.engine.dialect.name == "postgresql":
            session.execute(text("ALTER TABLE audit DISABLE TRIGGER USER"))
        else:
            session.execute(text("BEGIN"))
            names = "SELECT name FROM sqlite_master WHERE type = 'trigger' AND tbl_name = 'audit'"
            for name in session.scalars(text(names)).all():
                session.execute(text(f"DROP TRIGGER {name}"))
        yield session
        session.rollback()


def found(session: Session, expected: str | None = None) -> AuditReport:
    session.expire_all()
    return hash_chain.verify(iter(list(read_rows(session))), expected)


def test_every_column_that_is_edited_is_found_and_where(owner: Session) -> None:
    assert set(CHANGES) == set(LINKED) - {"id"}
    assert found(owner).broken is None
    for number in (1, 4, ROWS):
        for column, value in CHANGES.items():
            with owner.begin_nested() as kept:
                owner.execute(text(f"UPDATE audit SET {column} = {value} WHERE id = {number}"))
                report = found(owner)
                assert (report.broken, report.rows) == (number, number - 1), column
                kept.rollback()
    assert found(owner).rows == ROWS


def forge(session: Session) -> None:
    """With a hash that fits the row's own new content."""
    row = next(row for row in list(read_rows(session)) if row["id"] == 3)
    made = row_hash({**row, "who": "bob"}, row["previous"])
    session.execute(text(f"UPDATE audit SET who = 'bob', hash = '{made}' WHERE id = 3"))


def swap(session: Session) -> None:
    for of, to in ((2, 0), (5, 2), (0, 5)):
        session.execute(text(f"UPDATE audit SET id = {to} WHERE id = {of}"))


def delete(session: Session) -> None:
    session.execute(text("DELETE FROM audit WHERE id = 4"))


def put_in(session: Session) -> None:
    session.execute(text("DROP INDEX ix_audit_previous"))
    copy = f"INSERT INTO audit (id, {ALL_BUT_ID}) SELECT {ROWS + 1}, {ALL_BUT_ID} FROM audit WHERE id = 2"
    session.execute(text(copy))


@pytest.mark.parametrize(("how", "row"), [(forge, 4), (swap, 2), (delete, 4), (put_in, ROWS + 1)])
def test_a_row_that_was_forged_moved_taken_out_or_put_in_is_found(
    owner: Session, how: Callable[[Session], Any], row: int
) -> None:
    how(owner)
    assert found(owner).broken is not None
    assert found(owner).rows <= ROWS
    assert found(owner).broken in (row, row + 1)


def test_a_tail_that_was_cut_off_is_shown_by_a_hash_kept_elsewhere(owner: Session) -> None:
    kept = found(owner).head
    owner.execute(text(f"DELETE FROM audit WHERE id > {ROWS - 2}"))
    assert found(owner).why is None  # the chain alone cannot show it
    assert kept in (found(owner, kept).why or "")


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE audit SET who = 'bob' WHERE id = 2",
        "DELETE FROM audit WHERE id = 2",
        "DELETE FROM audit",
        f"INSERT INTO audit (id, {ALL_BUT_ID}) SELECT id, {ALL_BUT_ID} FROM audit WHERE id = 2",
    ],
)
def test_the_database_refuses_what_is_not_added_at_the_end(
    written: Location, database: Database, statement: str
) -> None:
    with Session(database.engine) as session, pytest.raises(DBAPIError, match="append-only"):
        session.execute(text(statement))
    with reading(written) as session:
        assert hash_chain.verify(read_rows(session), None).rows == ROWS
