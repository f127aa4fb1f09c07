"""The audit follows what was done: no command waits for a row, and no database, locked or full, refuses one."""

import logging
import threading
from collections import deque

from sqlalchemy.exc import SQLAlchemyError

from fullpose_server.errors import ServerError
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_entry import AuditEntry

MOST = 10_000
RETRY_S = 0.5
log = logging.getLogger(__name__)


class AuditTrail:
    """Writes entries in their order, by a thread of its own; what cannot be written is tried again."""

    def __init__(self, audit: AuditLog) -> None:
        self._audit = audit
        self._entries: deque[AuditEntry] = deque()
        self._changed = threading.Condition()
        self._ending = False
        self._lost = 0
        self._error = ""
        self._thread = threading.Thread(target=self._run, name="audit trail", daemon=True)
        self._thread.start()

    def follow(self, entry: AuditEntry) -> None:
        """Have it written. Never waits; may be called from any thread."""
        with self._changed:
            if self._ending or len(self._entries) >= MOST:
                self._lost += 1
                log.error("not in the audit, for it has ended or %d lines wait already: %s", MOST, entry)
                return
            self._entries.append(entry)
            self._changed.notify_all()

    def written(self, timeout_s: float) -> bool:
        """Wait until all that was told before is written; False where it is not within the time."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._entries, timeout_s)

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        found = []
        if self._error:
            found.append(f"{len(self._entries)} lines wait to be written to the audit: {self._error}")
        if self._lost:
            found.append(f"{self._lost} lines of the audit were lost: they are in the server's log")
        return found

    def close(self) -> None:
        """End, with one more try; what cannot be written goes to the server's log."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        self._thread.join()
        for entry in self._entries:
            log.error("not in the audit, for it cannot be written: %s", entry)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._entries or self._ending)
                if not self._entries:
                    return
                entry = self._entries[0]
            try:
                self._audit.write(entry)
            except (SQLAlchemyError, ServerError, OSError) as cause:
                self._error = str(cause).splitlines()[0]
                with self._changed:
                    if self._ending:
                        return
                    self._changed.wait_for(lambda: self._ending, RETRY_S)
                continue
            with self._changed:
                self._error = ""
                self._entries.popleft()
                self._changed.notify_all()
