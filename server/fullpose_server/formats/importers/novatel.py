"""NovAtel SPAN logs in ASCII: INSPVA, INSPVAX, INSATT, INSATTX and their short forms, one record a line.

The vehicle's axes are x right, y forward, z up; the azimuth is turned first, clockwise from north, then the pitch about
x, then the roll about y: heading, pitch and bank.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.table import Table, table_of
from fullpose_server.formats.importers.text_source import text_source

_WEEK_S = 604_800.0
# Where roll, pitch, azimuth begin among the fields after the header; and where the week is, None: in the header.
_LAYOUTS: dict[str, tuple[int, int | None]] = {
    "INSPVAA": (8, 0),
    "INSPVASA": (8, 0),
    "INSATTA": (2, 0),
    "INSATTSA": (2, 0),
    "INSPVAXA": (9, None),
    "INSATTXA": (2, None),
}


@dataclass
class _Records:
    lines: list[int] = field(default_factory=list)
    # week, seconds, azimuth, pitch, roll
    rows: list[tuple[float, float, float, float, float]] = field(default_factory=list)


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """One table a kind of record, the most frequent first. Raises `FileError`, `TooLargeError`."""
    found: dict[str, _Records] = {}
    for number, line in enumerate(text_source(path, file, bounds).lines(), start=1):
        name = line[1:].partition(",")[0] if line[:1] in ("#", "%") else ""
        if name not in _LAYOUTS:
            continue
        records = found.setdefault(name, _Records())
        records.rows.append(_record(file, number, name, line))
        records.lines.append(number)
        check_rows(len(records.rows), bounds, file)
    tables = []
    for name, records in sorted(found.items(), key=lambda pair: -len(pair[1].rows)):
        week, seconds, azimuth, pitch, roll = np.array(records.rows).T
        seconds += _WEEK_S * (week - week[0])  # of the week in which the log begins: doubles keep their nanoseconds
        columns = {"seconds": seconds, "azimuth": azimuth, "pitch": pitch, "roll": roll}
        table = table_of(file, "novatel", columns, row_word="line", profile="novatel")
        tables.append(replace(table, name=name, line_of=records.lines.__getitem__))
    if not tables:
        raise FileError(file, f"NovAtel records of {', '.join(_LAYOUTS)}")
    return tuple(tables)


def _record(file: str, line: int, name: str, text: str) -> tuple[float, float, float, float, float]:
    header, semicolon, body = text.partition(";")
    if not semicolon:
        expected = f"a NovAtel record, a header and ';' before its fields ({name} as the receiver writes it)"
        raise FileError(file, expected, line=line, value=text[:60])
    first, week_at = _LAYOUTS[name]
    fields = body.partition("*")[0].split(",")
    try:
        if week_at is None:
            week, seconds = (float(cell) for cell in header.split(",")[5:7])
            roll, pitch, azimuth = (float(cell) for cell in fields[first : first + 3])
        else:
            week, seconds = float(fields[0]), float(fields[1])
            roll, pitch, azimuth = (float(cell) for cell in fields[first : first + 3])
    except ValueError:
        raise FileError(file, f"the fields of {name}", line=line, value=text[:60]) from None
    return week, seconds, azimuth, pitch, roll
