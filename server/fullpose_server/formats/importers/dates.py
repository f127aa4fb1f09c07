"""Calendar stamps of attitude files, as seconds from the first: ISO 8601, with month and day or the day of the year."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

import numpy as np

from fullpose._typing import Array

_ISO = re.compile(
    r"(?P<year>\d{4})-(?:(?P<month>\d\d)-(?P<day>\d\d)|(?P<of_year>\d{3}))[T ]"
    r"(?P<hour>\d\d):(?P<minute>\d\d):(?P<second>\d\d)(?P<fraction>\.\d*)?Z?"
)


def parse_date(text: str) -> tuple[datetime, float] | None:
    """The second and its fraction; None where the text is no date. A leap second is the second after it."""
    found = _ISO.fullmatch(text.strip())
    if found is None:
        return None
    try:
        if found["of_year"]:
            day = datetime(int(found["year"]), 1, 1, tzinfo=UTC) + timedelta(days=int(found["of_year"]) - 1)
        else:
            day = datetime(int(found["year"]), int(found["month"]), int(found["day"]), tzinfo=UTC)
    except ValueError:
        return None
    clock = timedelta(hours=int(found["hour"]), minutes=int(found["minute"]), seconds=int(found["second"]))
    fraction = found["fraction"] or ""
    return day + clock, float(fraction) if len(fraction) > 1 else 0.0


def since_first(dates: Sequence[tuple[datetime, float]]) -> Array:
    """Seconds (n,) from the first date."""
    if not dates:
        return np.empty(0)
    first, offset = dates[0]
    return np.array([(second - first).total_seconds() + (fraction - offset) for second, fraction in dates])
