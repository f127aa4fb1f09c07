"""The audit log: every command, accepted or refused, with who, lease, state before and after."""

import time
from typing import Any

from sqlalchemy import select

from fullpose_server.store.database import Database
from fullpose_server.store.tables import AuditRow


class AuditLog:
    """Written once, never changed."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def write(
        self,
        *,
        who: str,
        rig: str,
        command: str,
        args: dict[str, Any],
        lease: tuple[int, int] | None,
        states: tuple[str, str],
        accepted: bool,
        detail: str | None,
    ) -> None:
        """Add one line. `lease` is (epoch, sequence), `states` before and after."""
        with self._database.begin() as session:
            session.add(
                AuditRow(
                    at=time.time(),
                    who=who,
                    rig=rig,
                    command=command,
                    args=args,
                    lease_epoch=None if lease is None else lease[0],
                    lease_sequence=None if lease is None else lease[1],
                    state_before=states[0],
                    state_after=states[1],
                    accepted=accepted,
                    detail=detail,
                )
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
