"""Rows that follow what happened: nobody waits for them, and no database, locked or full, loses one while we live."""

import logging
import threading
from collections.abc import Callable, Hashable, Sequence
from itertools import islice
from typing import Generic, TypeVar

from sqlalchemy.exc import SQLAlchemyError

from fullpose_server.errors import ServerError

MOST = 10_000
BATCH = 100  # in one transaction
RETRY_S = 0.5
log = logging.getLogger(__name__)
Item = TypeVar("Item")


class WriteBehind(Generic[Item]):
    """Writes items in their order, by a thread of its own; what cannot be written is tried again.

    `write` puts some into the database, all or none. `name`: of what is written, for people.
    """

    def __init__(self, name: str, write: Callable[[Sequence[Item]], None]) -> None:
        self._name = name
        self._write = write
        self._waiting: dict[Hashable, Item] = {}
        self._changed = threading.Condition()
        self._ending = False
        self._lost = 0
        self._error = ""
        self._thread = threading.Thread(target=self._run, name=f"writes the {name}", daemon=True)
        self._thread.start()

    def put(self, key: Hashable, item: Item) -> None:
        """Have it written, in place of what waits under its key. Never waits; may be called from any thread."""
        with self._changed:
            full = len(self._waiting) >= MOST and key not in self._waiting
            if self._ending or full:
                self._lost += 1
                log.error("not in the %s, for it has ended or %d lines wait already: %s", self._name, MOST, item)
                return
            self._waiting[key] = item
            self._changed.notify_all()

    def written(self, timeout_s: float = 1.0) -> bool:
        """Wait until all that was told before is written; False where it is not within the time: nothing can be."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._waiting, timeout_s)

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        found = []
        if self._error:
            found.append(f"{len(self._waiting)} lines wait to be written to the {self._name}: {self._error}")
        if self._lost:
            found.append(f"{self._lost} lines of the {self._name} were lost: they are in the server's log")
        return found

    def close(self) -> None:
        """End, with one more try; what cannot be written goes to the server's log."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        self._thread.join()
        for item in self._waiting.values():
            log.error("not in the %s, for it cannot be written: %s", self._name, item)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._ending)
                if not self._waiting:
                    return
                batch = dict(islice(self._waiting.items(), BATCH))
            try:
                self._write(list(batch.values()))
            except (SQLAlchemyError, ServerError, OSError) as cause:
                self._error = str(cause).splitlines()[0]
                with self._changed:
                    if self._ending:
                        return
                    self._changed.wait_for(lambda: self._ending, RETRY_S)
                continue
            with self._changed:
                self._error = ""
                for key, item in batch.items():
                    if self._waiting[key] is item:  # not told anew meanwhile
                        del self._waiting[key]
                self._changed.notify_all()
