"""The audit log: every command, accepted or refused, with who, from where, lease, state before and after."""

import json
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

from sqlalchemy import Integer, Select, String, cast, select, type_coerce
from sqlalchemy.orm import Session

from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database
from fullpose_server.store.hash_chain import CONTENT, GENESIS, row_hash
from fullpose_server.store.tables import NUL, SHOWN, AuditRow

LINKED = (*CONTENT, "previous", "hash")
_AT_ONCE = 1000  # rows that are read


class AuditLog:
    """Written once, never changed: by one writer, each row after the newest (`hash_chain`)."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def write(self, entries: Sequence[AuditEntry]) -> None:
        """Add lines, all or none."""
        with self._database.begin_alone(AuditRow) as session:  # so that no other program adds one between
            number, previous = _newest(session)
            for entry in entries:
                number += 1
                content = {"id": number, **_content(entry)}
                session.add(AuditRow(**content, previous=previous, hash=(previous := row_hash(content, previous))))

    def all(self, rig: str | None, before: int | None, limit: int) -> list[AuditRow]:
        """Newest first; `before` is the id to go on from."""
        query = select(AuditRow).order_by(AuditRow.id.desc()).limit(limit)
        if rig is not None:
            query = query.where(AuditRow.rig == rig)
        if before is not None:
            query = query.where(AuditRow.id < before)
        with self._database.begin() as session:
            return list(session.scalars(query))


def read_rows(
    session: Session, *, rig: str | None = None, since: float | None = None, until: float | None = None
) -> Iterator[dict[str, Any]]:
    """The rows by their `LINKED` columns, the oldest first, from `since` to `until` [s since 1970], of a rig.

    What a column cannot hold is given as it is there, for `hash_chain` to find.
    """
    as_text = type_coerce if session.get_bind().dialect.name == "sqlite" else cast  # psycopg reads JSON by itself
    columns: list[Any] = [getattr(AuditRow, name) for name in LINKED if name not in ("args", "accepted")]
    columns += [
        as_text(AuditRow.args, String).label("args"),
        type_coerce(AuditRow.accepted, Integer).label("accepted"),
    ]
    query: Select[Any] = select(*columns).order_by(AuditRow.id)
    if since is not None:
        query = query.where(AuditRow.at >= since)
    if until is not None:
        query = query.where(AuditRow.at <= until)
    if rig is not None:
        query = query.where(AuditRow.rig == rig)
    for found in session.execute(query.execution_options(yield_per=_AT_ONCE)).mappings():
        row: dict[str, Any] = {str(name): value for name, value in found.items()}
        if isinstance(row["args"], str):
            with suppress(ValueError):
                row["args"] = json.loads(row["args"])
        if row["accepted"] in (0, 1):
            row["accepted"] = bool(row["accepted"])
        yield row


def newest_hash(session: Session) -> str:
    """Of the audit, as it is now."""
    return _newest(session)[1]


def _newest(session: Session) -> tuple[int, str]:
    found = session.execute(select(AuditRow.id, AuditRow.hash).order_by(AuditRow.id.desc()).limit(1)).first()
    return (0, GENESIS) if found is None else (int(found[0]), str(found[1]))


def _content(entry: AuditEntry) -> dict[str, Any]:
    content = {
        "at": float(entry.at),
        "who": entry.who,
        "address": entry.address,
        "rig": entry.rig,
        "command": entry.command,
        "args": entry.args,
        "lease_epoch": None if entry.lease is None else entry.lease[0],
        "lease_sequence": None if entry.lease is None else entry.lease[1],
        "state_before": entry.states[0],
        "state_after": entry.states[1],
        "accepted": entry.accepted,
        "detail": entry.detail,
    }
    # What is hashed is what can be read again: PostgreSQL's text has no NUL.
    return {name: _shown(value) for name, value in content.items()}


def _shown(value: Any) -> Any:
    return value.replace(NUL, SHOWN) if isinstance(value, str) else value
