"""A drive's options, from the table of a rig file to the drive's own dataclass."""

from typing import Any, TypeVar

import msgspec

from fullpose_server.drives.base import DriveError

Options = TypeVar("Options")


def options_of(drive: str, kind: type[Options], given: dict[str, Any]) -> Options:
    """The dataclass `kind` with what was given. Raises `DriveError` for an option that is not, or cannot be."""
    unknown = set(given) - set(kind.__dataclass_fields__)  # type: ignore[attr-defined]
    if unknown:
        raise DriveError(f"{drive} drive: no option {', '.join(sorted(unknown))}")
    try:
        return msgspec.convert(given, kind)
    except msgspec.ValidationError as cause:
        raise DriveError(f"{drive} drive: {cause}") from cause
