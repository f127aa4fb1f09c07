"""CCSDS attitude ephemeris messages (504.0-B-1 and B-2), as keyword = value: quaternions and Euler angles.

"A2B" with B the body turns the axes of A onto those of the body, which is our body to reference; the other way round is
its inverse. One segment is one table.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fullpose._typing import Array
from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.dates import parse_date, since_first
from fullpose_server.formats.importers.table import Table, table_of
from fullpose_server.formats.importers.text_source import text_source

_AXES = {"1": "X", "2": "Y", "3": "Z"}
_BODY = ("SC_BODY", "BODY", "SENSOR", "INSTRUMENT", "CSS", "IMU_FRAME", "STARTRACKER", "ACTUATOR")


@dataclass
class _Segment:
    meta: dict[str, str]
    lines: list[int] = field(default_factory=list)
    rows: list[list[str]] = field(default_factory=list)


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """One table a segment. Raises `FileError`, `TooLargeError`."""
    head: dict[str, str] = {}
    segments: list[_Segment] = []
    data, meta = False, False
    for number, line in _lines(path, file, bounds):
        key, equals, value = (part.strip() for part in line.partition("="))
        if line in ("META_START", "META_STOP"):
            meta = line == "META_START"
            if meta:
                segments.append(_Segment({}))
        elif line in ("DATA_START", "DATA_STOP"):
            data = line == "DATA_START"
        elif equals:
            (segments[-1].meta if meta and segments else head)[key.upper()] = value
        elif (data or segments) and segments:
            segments[-1].lines.append(number)
            segments[-1].rows.append(line.split())
            check_rows(len(segments[-1].rows), bounds, file)
    if not segments:
        raise FileError(file, "META_START, a segment of attitudes")
    version = head.get("CCSDS_AEM_VERS", "1.0")
    return tuple(_table(file, version, k, segment) for k, segment in enumerate(segments))


def _lines(path: Path, file: str, bounds: Bounds) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(text_source(path, file, bounds).lines(), start=1):
        text = line.strip()
        if text and not text.startswith("COMMENT"):
            yield number, text


def _table(file: str, version: str, index: int, segment: _Segment) -> Table:
    kind = segment.meta.get("ATTITUDE_TYPE", "").upper().replace("_", " ")
    names: tuple[str, ...]
    if kind.startswith("QUATERNION"):
        first = segment.meta.get("QUATERNION_TYPE", "LAST").upper() == "FIRST"
        names = ("qc", "q1", "q2", "q3") if first else ("q1", "q2", "q3", "qc")
    elif kind.startswith("EULER ANGLE"):
        names = ("1", "2", "3")
    else:
        raise FileError(
            file, "ATTITUDE_TYPE QUATERNION or EULER_ANGLE", column="ATTITUDE_TYPE", value=kind, column_word="key"
        )
    time, values = _values(file, segment, len(names))
    columns = dict(zip(names, values.T, strict=True))
    if "qc" in columns:
        if not _to_body(segment):
            columns |= {name: -columns[name] for name in ("q1", "q2", "q3")}
        profile = "ccsds-aem"
    else:
        columns, profile = _euler(file, version, segment, columns)
    table = table_of(file, "aem", {"time": time, **columns}, row_word="line", profile=profile)
    name = f"segment {index + 1}" if index else segment.meta.get("OBJECT_NAME", "")
    return replace(table, name=name, line_of=lambda row: segment.lines[row])


def _values(file: str, segment: _Segment, width: int) -> tuple[Array, Array]:
    """(time (n,) [s] from the first, values (n, width))."""
    dates, values = [], np.empty((len(segment.rows), width))
    for k, (line, cells) in enumerate(zip(segment.lines, segment.rows, strict=True)):
        date = parse_date(cells[0])
        if date is None:
            raise FileError(
                file, "a date, 2026-11-30T12:00:00.5 or 2026-334T12:00:00.5", line=line, value=cells[0][:40]
            )
        if len(cells) < width + 1:
            raise FileError(file, f"a date and {width} numbers", line=line, value=f"{len(cells)} cells")
        dates.append(date)
        try:
            values[k] = [float(cell) for cell in cells[1 : width + 1]]
        except ValueError as error:
            raise FileError(file, f"{width} numbers ({error})", line=line) from None
    return since_first(dates), values


def _to_body(segment: _Segment) -> bool:
    """Whether the rotation leads from the reference to the body; a body that no name gives away is B."""
    a, b = (segment.meta.get(f"REF_FRAME_{letter}", "").upper() for letter in "AB")
    a_is_body = a.startswith(_BODY) and not b.startswith(_BODY)
    a_to_b = segment.meta.get("ATTITUDE_DIR", "A2B").upper() == "A2B"
    return a_to_b != a_is_body


def _euler(file: str, version: str, segment: _Segment, given: dict[str, Array]) -> tuple[dict[str, Array], str]:
    """The angles as heading, pitch, bank, whose order is Z-Y-X."""
    sequence = segment.meta.get("EULER_ROT_SEQ", "")
    order = "".join(_AXES.get(sign, sign) for sign in sequence.upper())
    inverse = not _to_body(segment)
    wanted = order[::-1] if inverse else order
    if wanted != "ZYX":
        raise FileError(
            file,
            "a rotation sequence of Z, Y, X, or quaternions",
            column="EULER_ROT_SEQ",
            value=sequence,
            column_word="key",
        )
    by_axis = version.startswith("1")  # B-1 has X, Y, Z; B-2 has them in the order of the sequence
    angle = {axis: given["123"["XYZ".index(axis)] if by_axis else "123"[order.index(axis)]] for axis in "XYZ"}
    sign = -1.0 if inverse else 1.0
    return {"heading": sign * angle["Z"], "pitch": sign * angle["Y"], "bank": sign * angle["X"]}, "heading-pitch-bank"
