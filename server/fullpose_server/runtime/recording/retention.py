"""Which records go by themselves: those of too many days, then the oldest beyond so many bytes; none pinned."""

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from fullpose_server.runtime.recording.run_index import RunFiles, RunInUseError

DAY_S = 86_400.0
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Kept:
    """A record, as far as it matters here."""

    id: str
    bytes: int
    written: float  # [s] since 1970
    pinned: bool


@dataclass(frozen=True)
class Retention:
    """The rule; None: without end."""

    days: float | None
    bytes: int | None

    @property
    def on(self) -> bool:
        """Whether anything goes at all."""
        return self.days is not None or self.bytes is not None

    def to_remove(self, records: Sequence[Kept], now: float) -> list[str]:
        """The records that go, the oldest first."""
        gone, size = [], sum(record.bytes for record in records)
        for record in sorted(records, key=lambda record: record.written):
            old = self.days is not None and now - record.written > self.days * DAY_S
            large = self.bytes is not None and size > self.bytes
            if not record.pinned and (old or large):
                gone.append(record.id)
                size -= record.bytes
        return gone


def sweep(runs: RunFiles, rule: Retention, clock: Callable[[], float] = time.time) -> list[str]:
    """Remove what the rule does not keep; returns what went."""
    gone = []
    for run in rule.to_remove([Kept(*record) for record in runs.sizes()], clock()):
        try:
            runs.remove(run)
        except RunInUseError:
            continue
        gone.append(run)
    if gone:
        log.warning("removed by retention: %s", ", ".join(gone))
    return gone
