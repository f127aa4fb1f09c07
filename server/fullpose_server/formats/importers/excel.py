"""Excel workbooks (.xlsx): a table each sheet; the header is the first row of two or more texts."""

import zipfile
from array import array
from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime, time, timedelta
from pathlib import Path
from typing import Any

import numpy as np
from openpyxl import load_workbook

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, TooLargeError, check_columns, check_rows
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Table, table_of

ABOUT = "Excel workbook"
_NAN = float("nan")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each sheet that has a header and numbers under it. Raises `FileError`, `TooLargeError`."""
    with parsing(file, ABOUT), path.open("rb") as stream:  # by a name it would have to end in .xlsx
        _check_unpacked(path, file, bounds)
        book = load_workbook(stream, read_only=True, data_only=True)
        try:
            found = [_table(file, sheet, bounds) for sheet in book.worksheets]
            names = [sheet.title for sheet in book.worksheets]
        finally:
            book.close()
    tables = tuple(table for table in found if table is not None)
    if not tables:
        raise FileError(file, f"a sheet with column names and numbers under them among {', '.join(names[:8])}")
    return tables


def _check_unpacked(path: Path, file: str, bounds: Bounds) -> None:
    """Raise `TooLargeError` where the archive says that it unpacks to more than it may."""
    with zipfile.ZipFile(path) as archive:
        total = sum(each.file_size for each in archive.infolist())
        if total > bounds.bytes:
            raise TooLargeError(file, f"at most {bounds.bytes} bytes unpacked", value=f"{total} bytes")


def _table(file: str, sheet: Any, bounds: Bounds) -> Table | None:
    rows: Iterator[tuple[int, tuple[Any, ...]]] = enumerate(sheet.iter_rows(values_only=True), start=1)
    found = next(
        ((line, cells) for line, cells in rows if sum(isinstance(c, str) and bool(c.strip()) for c in cells) > 1), None
    )
    if found is None:
        return None
    header, cells = found
    names = [str(cell).strip() for cell in cells if cell is not None]
    places = [k for k, cell in enumerate(cells) if cell is not None]
    check_columns(len(names), bounds, file)
    units: dict[str, str] = {}
    lines, values = array("q"), array("d")
    for line, row in rows:
        picked = [row[k] if k < len(row) else None for k in places]
        if all(cell is None or cell == "" for cell in picked):
            continue
        if not lines and all(cell is None or isinstance(cell, str) for cell in picked):
            units = {name: cell.strip(" []()") for name, cell in zip(names, picked, strict=True) if cell}
            continue
        lines.append(line)
        values.extend([_number(cell) for cell in picked])
        check_rows(len(lines), bounds, file)
    if not lines:
        return None
    table = np.array(values).reshape(len(lines), len(names))
    columns = {name: np.ascontiguousarray(table[:, k]) for k, name in enumerate(names)}
    made = table_of(file, "excel", columns, name=sheet.title, units=units)
    at = np.array(lines)
    return replace(made, line_of=lambda row: int(at[row]), header_line=header)


def _number(cell: Any) -> float:
    """nan where a cell is empty, and refused later with its place."""
    if cell is None or cell == "":
        return _NAN
    if isinstance(cell, bool) or not isinstance(cell, int | float | datetime | time | timedelta | str):
        return _NAN
    if isinstance(cell, datetime):
        return cell.timestamp()
    if isinstance(cell, time):
        return cell.hour * 3600.0 + cell.minute * 60.0 + cell.second + cell.microsecond * 1e-6
    if isinstance(cell, timedelta):
        return cell.total_seconds()
    try:
        return float(cell)
    except ValueError:
        return _NAN
