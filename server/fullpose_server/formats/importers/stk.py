"""STK attitude files (.a): quaternions from the coordinate axes to the body, and Euler angles 321."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.table import Table, table_of
from fullpose_server.formats.importers.text_source import text_source

# What a row has after its time. STK turns the coordinate axes onto the body's: body to reference, in our words.
_LAYOUTS = {
    "attitudetimequaternions": ("q1", "q2", "q3", "q4"),
    "attitudetimequatscalarfirst": ("q4", "q1", "q2", "q3"),
    "attitudetimequatangvels": ("q1", "q2", "q3", "q4"),
    "attitudetimeeulerangles": ("a", "b", "c"),
    "attitudetimeyprangles": ("a", "b", "c"),
}


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """The one table. Raises `FileError`, `TooLargeError`."""
    names: tuple[str, ...] = ()
    sequence, lines, rows = "321", list[int](), list[list[float]]()
    for number, line in enumerate(text_source(path, file, bounds).lines(), start=1):
        cells = line.split()
        if not cells or cells[0].startswith("#"):
            continue
        key = cells[0].casefold()
        if key.startswith("attitudetime"):
            if key not in _LAYOUTS:
                raise FileError(file, "quaternions or Euler angles against time", line=number, value=cells[0][:60])
            names = _LAYOUTS[key]
        elif key == "sequence" and len(cells) > 1:
            sequence = cells[1]
        elif key == "end" and names:
            break
        elif names:
            rows.append(_numbers(file, number, cells, len(names) + 1))
            lines.append(number)
            check_rows(len(rows), bounds, file)
    if not names:
        raise FileError(
            file, f"a row {', '.join(('AttitudeTimeQuaternions', 'AttitudeTimeQuatScalarFirst'))} before the data"
        )
    if "a" in names:
        if sequence != "321":
            raise FileError(file, "Sequence 321, or quaternions", column="Sequence", value=sequence, column_word="key")
        names = ("heading", "pitch", "bank")
    values = np.array(rows).reshape(-1, len(names) + 1)
    columns = dict(zip(("time", *names), values.T, strict=True))
    profile = "stk" if "q4" in names else "heading-pitch-bank"
    table = table_of(file, "stk", columns, row_word="line", profile=profile)
    return (replace(table, line_of=lambda row: lines[row]),)


def _numbers(file: str, line: int, cells: list[str], count: int) -> list[float]:
    try:
        numbers = [float(cell) for cell in cells[:count]]
    except ValueError as error:
        raise FileError(file, f"{count} numbers ({error})", line=line) from None
    if len(numbers) < count:
        raise FileError(file, f"{count} numbers", line=line, value=f"{len(numbers)} numbers")
    return numbers
