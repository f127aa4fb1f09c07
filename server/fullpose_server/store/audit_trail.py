"""The audit follows what was done: no command waits for a row, and no database, locked or full, refuses one."""

from itertools import count

from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.write_behind import WriteBehind


class AuditTrail(WriteBehind[AuditEntry]):
    """Every entry is a row of its own."""

    def __init__(self, audit: AuditLog) -> None:
        self._numbers = count()
        super().__init__("audit", audit.write)

    def follow(self, entry: AuditEntry) -> None:
        """Have it written. Never waits; may be called from any thread."""
        self.put(next(self._numbers), entry)
