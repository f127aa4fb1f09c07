"""One line of the audit, before it is a row: light, for the stop gate makes some too."""

import time
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


def of_no_rig(
    who: str, command: str, args: dict[str, Any], address: str | None, refused: str | None = None
) -> AuditEntry:
    """A line as of now about what is no rig's: people, flights, plans. `refused`: why it was not done."""
    states = ("", "")
    return AuditEntry(time.time(), who, "", command, args, None, states, refused is None, refused, address)
