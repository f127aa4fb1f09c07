"""The chain of the audit: each row has the hash of its content and of the row before, so that no row can be changed,
taken out, put in or moved without every later hash being another.

What a chain cannot show is that its newest rows are gone: for that a hash is kept elsewhere, as every evidence bundle
does, and looked for (`verify`'s `expected`). Format 1 of the encoding stays as it is; another would be format 2.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

FORMAT = 1
GENESIS = "0" * 64  # before the first row
CONTENT = (
    "id",
    "at",
    "who",
    "address",
    "rig",
    "command",
    "args",
    "lease_epoch",
    "lease_sequence",
    "state_before",
    "state_after",
    "accepted",
    "detail",
)


def row_hash(content: Mapping[str, Any], previous: str) -> str:
    """sha-256 [hex] of a row's `CONTENT` and the hash of the row before: of JSON with sorted keys and no blanks."""
    document = {name: content[name] for name in CONTENT} | {"format": FORMAT, "previous": previous}
    return hashlib.sha256(json.dumps(document, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def is_as_written(row: Mapping[str, Any]) -> bool:
    """Whether a row (`CONTENT`, previous, hash) is what its hash is of."""
    try:
        return bool(row_hash(row, row["previous"]) == row["hash"])
    except (TypeError, ValueError):  # something that no row has ever had
        return False


@dataclass(frozen=True)
class AuditReport:
    """What `verify` found. `broken` is the first row that does not fit, and `why`; None: all do."""

    rows: int  # that fit, from the first on
    first_at: float | None  # [s] since 1970
    last_at: float | None
    head: str  # the newest hash of those that fit
    broken: int | None = None
    why: str | None = None


def verify(rows: Iterable[Mapping[str, Any]], expected: str | None = None) -> AuditReport:
    """Go through the rows, the oldest first; `expected`, a hash that was kept elsewhere, is to be one of theirs."""
    count, first_at, last_at, last_id, head = 0, None, None, 0, GENESIS
    seen = expected is None or expected == GENESIS
    for row in rows:
        why = _unfit(row, head, last_id)
        if why is not None:
            return AuditReport(count, first_at, last_at, head, row["id"], why)
        count, last_id, head, last_at = count + 1, row["id"], row["hash"], row["at"]
        first_at = last_at if first_at is None else first_at
        seen = seen or head == expected
    why = None if seen else f"no row has the hash {expected}: the rows up to it were removed, or it is another audit's"
    return AuditReport(count, first_at, last_at, head, None, why)


def _unfit(row: Mapping[str, Any], head: str, last_id: int) -> str | None:
    if not is_as_written(row):
        return "it is not as it was written: its content or its hash was edited"
    if row["id"] == last_id + 1 and row["previous"] == head:
        return None
    after = f"row {last_id}" if last_id else "the audit's beginning"
    return f"it does not follow {after}: a row was deleted, inserted or moved"
