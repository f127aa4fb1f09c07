"""What is accepted and yet for a person to look at."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Caution:
    """Something accepted that a person should look at: where in the file, as far as there is a place."""

    code: str
    message: str
    column: str | None = None
    row: int | None = None  # the line of a text, counted from 1; the row of a table that has no lines
    value: str | None = None

    def to_json(self) -> dict[str, Any]:
        """Values for `json`, without what there is none of."""
        return {name: value for name, value in vars(self).items() if value is not None}
