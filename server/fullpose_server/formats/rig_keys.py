"""Keys of a rig file: what is wrong with one is said by file, key, value and what was expected."""

import math
from collections.abc import Iterable
from typing import Any

from fullpose_server.errors import FileError


def bad(file: str, key: str, value: Any, expected: str) -> FileError:
    """The error of one key."""
    return FileError(file, expected, column=key, value=repr(value), column_word="key")


def only(table: dict[str, Any], known: Iterable[str], prefix: str, file: str) -> None:
    """Raise `FileError` for a key that is not `known`."""
    for key in table:
        if key not in known:
            raise bad(file, prefix + key, key, "one of " + ", ".join(sorted(known)))


def is_number(value: Any) -> bool:
    """Whether `value` is a finite float, or an integer of at most 64 bits (TOML's; JSON carries no longer ones)."""
    if isinstance(value, int):
        return not isinstance(value, bool) and -(2**63) <= value < 2**63
    return isinstance(value, float) and math.isfinite(value)
