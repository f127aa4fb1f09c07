"""A table from text: commas, semicolons, tabs, bars or blanks between the cells.

Speed comes from Arrow; where Arrow refuses a file, a slow second pass finds the line to name.
"""

import csv
import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv

from fullpose._typing import Array, Integers
from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, Filling, check_columns, check_rows
from fullpose_server.formats.importers.dialect import HEAD_LINES, WHITE, Dialect, is_comment, is_number, sniff
from fullpose_server.formats.importers.last_line import cut_off
from fullpose_server.formats.importers.row_stream import RowStream
from fullpose_server.formats.importers.table import Columns, Table
from fullpose_server.formats.importers.text_source import TextSource, text_source
from fullpose_server.formats.visible import visible, without_invisible

_FIRST_LINE = 1_000_000
_BLOCK_BYTES = 1024 * 1024  # that Arrow reads at once
_HEAD_ROWS = 8
_LONG = re.compile(r"-?\d{16,19}")  # stamps that a double would round


@dataclass(frozen=True)
class _Text:
    source: TextSource
    dialect: Dialect
    bounds: Bounds
    integers: frozenset[str]  # columns that are whole numbers too long for doubles
    left_out: int = 0  # the line that a cut file breaks off in; 0: none

    @property
    def file(self) -> str:
        return self.source.file


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """The one table; `file` is its name in messages. Raises `FileError`, `TooLargeError`."""
    source = text_source(path, file, bounds)
    lines = _first_lines(source)
    dialect = sniff(lines, file)
    check_columns(len(dialect.names), bounds, file)
    text = _Text(source, dialect, bounds, frozenset())
    head = tuple(tuple(cells) for _, cells in itertools.islice(_rows(text), _HEAD_ROWS))
    integers = {
        name
        for k, name in enumerate(dialect.names)
        if head and all(len(row) > k and _LONG.fullmatch(row[k].strip()) for row in head)
    }
    last = cut_off(source, dialect)
    text = _Text(source, dialect, bounds, frozenset(integers), last.line if last is not None and last.dropped else 0)
    said = [Caution("invisible", each) for each in dialect.said] + ([] if last is None else [last.caution])
    table = Table(
        file=file,
        format="csv",
        names=dialect.names,
        load=partial(_load, text),
        units=dialect.units,
        line_of=partial(_line_of, text),
        row_word="line",
        header_line=dialect.header_line or None,
        cautions=tuple(said),
        head=head,
    )
    return (table,)


def _first_lines(source: TextSource) -> list[str]:
    """The first lines, for the dialect. Raises `FileError` where they are none."""
    lines = []
    for number, line in enumerate(itertools.islice(source.lines(), HEAD_LINES), start=1):
        if "\r" in line:
            raise FileError(source.file, "lines that end in LF or CR LF, not in CR alone", line=number)
        if len(line) > _FIRST_LINE:
            raise FileError(source.file, "a header of column names", line=number)
        lines.append(line)
    return lines


def _load(text: _Text, wanted: Sequence[str]) -> Columns:
    """Arrow first on the file as it is, then on cleaned rows, then the slow pass that names the line."""
    reasons = []
    for cleaned in (False, True) if text.source.plain and text.dialect.plain and not text.left_out else (True,):
        try:
            return _columns(text, tuple(wanted), cleaned)
        except pa.ArrowInvalid as error:
            reasons.append(str(error))
    if "Empty CSV" in reasons[-1]:
        raise FileError(text.file, "at least one row of samples after the header")
    raise _diagnose(text, tuple(wanted), reasons[0])


def _columns(text: _Text, wanted: tuple[str, ...], cleaned: bool) -> dict[str, Array | Integers]:
    """The wanted columns (n,), block by block, so that a file of too many rows is left at the first one too many."""
    dialect = text.dialect
    names = [*dialect.names, ""] if dialect.trailing else list(dialect.names)
    where: Any = RowStream(text.source, dialect, to_end=not text.left_out) if cleaned else text.source.path
    doubles = tuple(name for name in wanted if name not in text.integers)
    filling = Filling(doubles)
    stamps: dict[str, list[Integers]] = {name: [] for name in wanted if name in text.integers}
    kinds = {name: pa.int64() if name in text.integers else pa.float64() for name in wanted}
    rows, done, progress, size = 0, 0, text.bounds.progress, text.source.path.stat().st_size
    with pacsv.open_csv(
        where,
        read_options=pacsv.ReadOptions(
            block_size=_BLOCK_BYTES, column_names=names, skip_rows=0 if cleaned else dialect.skip
        ),
        parse_options=pacsv.ParseOptions(delimiter="," if dialect.delimiter == WHITE else dialect.delimiter),
        convert_options=pacsv.ConvertOptions(
            include_columns=list(wanted),
            column_types=kinds,
            null_values=[],
            strings_can_be_null=False,
            decimal_point=dialect.decimal,
        ),
    ) as blocks:
        for block in blocks:
            rows += block.num_rows
            check_rows(rows, text.bounds, text.file)
            done = min(size, done + _BLOCK_BYTES)
            if progress is not None:
                progress(done, size)
            part = {name: _numbers(block.column(name)) for name in wanted}
            for name, pieces in stamps.items():
                pieces.append(part.pop(name))
            if doubles:
                filling.add(part)
    return {**filling.columns(), **{name: np.concatenate(pieces) for name, pieces in stamps.items()}}


def _numbers(array: Any) -> Any:
    """The numbers (n,) of an Arrow array without gaps. Its own `to_numpy` imports pandas, where that is installed."""
    kind = np.int64 if pa.types.is_int64(array.type) else np.float64
    return np.frombuffer(array.buffers()[1], kind, len(array), array.offset * 8) if len(array) else np.empty(0, kind)


def _rows(text: _Text) -> Iterator[tuple[int, list[str]]]:
    """(line, cells) of the rows Arrow counts: empty lines and remarks are none. Raises `FileError` where `csv` does."""
    dialect, last = text.dialect, [0]

    def lines() -> Iterator[str]:
        for number, line in enumerate(text.source.lines(), start=1):
            if number > dialect.skip and number != text.left_out and line.strip() and not is_comment(line):
                last[0] = number
                yield without_invisible(line)

    if dialect.delimiter == WHITE:
        yield from ((last[0], line.split()) for line in lines())
        return
    reader = csv.reader(lines(), delimiter=dialect.delimiter)
    try:
        for cells in reader:
            yield last[0], cells
    except csv.Error as error:
        expected = f"cells of at most {csv.field_size_limit()} characters ({error})"
        raise FileError(text.file, expected, line=last[0]) from None


def _line_of(text: _Text, row: int) -> int:
    found = next(itertools.islice(_rows(text), row, None), None)
    return text.dialect.skip + 1 + row if found is None else found[0]


def _diagnose(text: _Text, wanted: tuple[str, ...], reason: str) -> FileError:
    """The first row that is none: its line, its column, its value."""
    dialect, width = text.dialect, len(text.dialect.names)
    at = [(name, dialect.names.index(name)) for name in wanted]
    for line, cells in _rows(text):
        if len(cells) != width + dialect.trailing:
            return FileError(text.file, f"{width} columns as in the header", line=line, value=f"{len(cells)} columns")
        for name, column in at:
            if not is_number(cells[column], dialect.decimal):
                shown = visible(repr(cells[column][:40]))
                return FileError(text.file, "a number", line=line, column=name, value=shown)
    # Arrow is stricter than Python somewhere: its own words, which carry the row, say where.
    return FileError(text.file, f"CSV as RFC 4180 has it ({reason.splitlines()[0][:200]})")
