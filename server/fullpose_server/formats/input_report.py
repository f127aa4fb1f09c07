"""What a report says of the file a flight came in."""

from typing import Any

from fullpose_server.formats.trajectory import Trajectory


def input_of(flight: Trajectory) -> dict[str, Any]:
    """format, table, profile, convention, statement and warnings, for JSON."""
    return {
        "format": flight.taken.format,
        "table": flight.taken.table,
        "profile": flight.taken.profile,
        "convention": flight.convention.value,
        "statement": flight.taken.statement,
        "warnings": [caution.to_json() for caution in flight.warnings],
    }
