"""One line of the audit, before it is a row: light, for the stop gate makes some too."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class AuditEntry:
    """One line: `lease` is (epoch, sequence), `states` before and after, `at` [s] since the epoch.

    `address` is where it came from, as the server or the gate sees it; None where that is not known.
    """

    at: float
    who: str
    rig: str
    command: str
    args: dict[str, Any]
    lease: tuple[int, int] | None
    states: tuple[str, str]
    accepted: bool
    detail: str | None
    address: str | None = None
