"""The audit log: every command, accepted or refused, with who, lease, state before and after."""

from collections.abc import Sequence

from sqlalchemy import select

from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database
from fullpose_server.store.tables import AuditRow


class AuditLog:
    """Written once, never changed."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def write(self, entries: Sequence[AuditEntry]) -> None:
        """Add lines, all or none."""
        with self._database.begin() as session:
            session.add_all(
                AuditRow(
                    at=entry.at,
                    who=entry.who,
                    rig=entry.rig,
                    command=entry.command,
                    args=entry.args,
                    lease_epoch=None if entry.lease is None else entry.lease[0],
                    lease_sequence=None if entry.lease is None else entry.lease[1],
                    state_before=entry.states[0],
                    state_after=entry.states[1],
                    accepted=entry.accepted,
                    detail=entry.detail,
                )
                for entry in entries
            )

    def all(self, rig: str | None, before: int | None, limit: int) -> list[AuditRow]:
        """Newest first; `before` is the id to go on from."""
        query = select(AuditRow).order_by(AuditRow.id.desc()).limit(limit)
        if rig is not None:
            query = query.where(AuditRow.rig == rig)
        if before is not None:
            query = query.where(AuditRow.id < before)
        with self._database.begin() as session:
            return list(session.scalars(query))
