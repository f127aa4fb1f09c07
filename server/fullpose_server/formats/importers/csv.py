"""A flight from comma-separated text.

Speed comes from Arrow; where Arrow refuses a file, a slow second pass finds the line to name.
"""

import csv
import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pyarrow as pa
import pyarrow.csv as pacsv

from fullpose._typing import Array
from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, Filling, check_columns, check_rows
from fullpose_server.formats.importers.table import Columns, Table

_HEADER_BYTES = 1_000_000


@dataclass(frozen=True)
class _Header:
    names: list[str]
    lines: int  # up to and with the header line


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """The one table; `file` is its name in messages. Raises `FileError`, `TooLargeError`."""
    header = _header(path, file)
    check_columns(len(header.names), bounds, file)
    table = Table(
        file=file,
        format="csv",
        names=tuple(header.names),
        load=partial(_load, path, file, header, bounds),
        line_of=lambda row: _line_of(path, file, header, row),
        row_word="line",
        header_line=header.lines,
        head=tuple(tuple(cells) for _, cells in itertools.islice(_rows(path, file, header), 8)),
    )
    return (table,)


def _load(path: Path, file: str, header: _Header, bounds: Bounds, wanted: Sequence[str]) -> Columns:
    try:
        return _columns(path, file, header, tuple(wanted), bounds)
    except pa.ArrowInvalid as error:
        if "Empty CSV" in str(error):
            raise FileError(file, "at least one row of samples after the header") from None
        raise _diagnose(path, file, header, tuple(wanted), str(error)) from None


def _columns(path: Path, file: str, header: _Header, wanted: tuple[str, ...], bounds: Bounds) -> dict[str, Array]:
    """The wanted columns (n,), block by block, so that a file of too many rows is left at the first one too many."""
    filling = Filling(wanted)
    with pacsv.open_csv(
        path,
        read_options=pacsv.ReadOptions(column_names=header.names, skip_rows=header.lines),
        convert_options=pacsv.ConvertOptions(
            include_columns=list(wanted),
            column_types=dict.fromkeys(wanted, pa.float64()),
            null_values=[],
            strings_can_be_null=False,
        ),
    ) as blocks:
        for block in blocks:
            check_rows(filling.rows + block.num_rows, bounds, file)
            filling.add({name: block.column(name).to_numpy(zero_copy_only=False) for name in wanted})
    return filling.columns()


def _header(path: Path, file: str) -> _Header:
    """The first line that is neither empty nor a # comment."""
    with path.open("rb") as stream:
        for number, raw in enumerate(iter(lambda: stream.readline(_HEADER_BYTES + 1), b""), start=1):
            if b"\r" in raw.rstrip(b"\r\n"):
                raise FileError(file, "lines that end in LF or CR LF, not in CR alone", line=number)
            if len(raw) > _HEADER_BYTES:
                raise FileError(file, "a header of comma-separated column names", line=number)
            text = raw.decode("utf-8-sig" if number == 1 else "utf-8", errors="replace").strip()
            if not text or text.startswith("#"):
                continue
            try:
                names = [name.strip() for name in next(csv.reader([text]))]
            except csv.Error as error:
                raise FileError(file, f"a header of comma-separated column names ({error})", line=number) from None
            if len(names) == 1 and (";" in text or "\t" in text):
                raise FileError(file, "commas between the columns", line=number, value=text[:60])
            if all(_is_number(name) for name in names):
                raise FileError(file, "a header line that names the columns", line=number, value=text[:60])
            return _Header(names, number)
    raise FileError(file, "a header line and samples, the file is empty")


def _rows(path: Path, file: str, header: _Header) -> Iterator[tuple[int, list[str]]]:
    """(line, cells) of the rows Arrow counts: empty lines are none. Raises `FileError` where `csv` gives up."""
    with path.open("r", encoding="utf-8", errors="replace", newline="") as stream:
        lines = itertools.islice(stream, header.lines, None)
        reader = csv.reader(lines)
        try:
            for cells in reader:
                if cells:
                    yield header.lines + reader.line_num, cells
        except csv.Error as error:
            expected = f"cells of at most {csv.field_size_limit()} characters ({error})"
            raise FileError(file, expected, line=header.lines + reader.line_num) from None


def _line_of(path: Path, file: str, header: _Header, row: int) -> int:
    found = next(itertools.islice(_rows(path, file, header), row, None), None)
    return header.lines + 1 + row if found is None else found[0]


def _diagnose(path: Path, file: str, header: _Header, wanted: tuple[str, ...], reason: str) -> FileError:
    places = [(name, header.names.index(name)) for name in wanted]
    for line, cells in _rows(path, file, header):
        if len(cells) != len(header.names):
            expected = f"{len(header.names)} columns as in the header"
            return FileError(file, expected, line=line, value=f"{len(cells)} columns")
        for name, column in places:
            if not _is_number(cells[column]):
                return FileError(file, "a number", line=line, column=name, value=repr(cells[column][:40]))
    # Arrow is stricter than Python somewhere: its own words, which carry the row, say where.
    return FileError(file, f"CSV as RFC 4180 has it ({reason.splitlines()[0][:200]})")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text
