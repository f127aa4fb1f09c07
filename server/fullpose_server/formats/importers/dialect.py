"""The dialect of a text table: what is between its cells, its decimal sign, where its names and units are.

Told from the first lines. The first line that is no comment is the header where it looks like one; else the header is
what stands before the first rows of numbers: a comment (EuRoC, TUM, rosbag's `%time`), or lines of another tool's.
"""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.table import unit_in_name
from fullpose_server.formats.units import is_unit
from fullpose_server.formats.visible import visible, without_invisible

WHITE = " "  # any blanks between the cells
COMMENTS = ("#", "%", "//")
HEAD_LINES = 400
_DELIMITERS = ("|", "\t", ";", ",", WHITE)
_DECIMAL_COMMA = re.compile(r"^\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?\s*$")
_METADATA = re.compile(
    r"^\s*(?P<key>Types?|Units?|Interp|BlockPath|PortIndex|Source|Enum\w*|Dimensions)\s*:(?P<value>.*)$"
)
_UNITS_KEY = ("unit", "units")
# What a table without any header is, by its number of columns: TUM's trajectory format.
_NAMELESS = {(WHITE, 8): ("timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw")}


@dataclass(frozen=True)
class Dialect:
    """How the rows of a text are read."""

    delimiter: str
    decimal: str
    names: tuple[str, ...]
    header_line: int  # from 1; 0: there is none
    skip: int  # lines before the first row
    units: dict[str, str] = field(default_factory=dict)
    trailing: bool = False  # every row ends in a delimiter that the header does not have
    comments: bool = False  # there are comments between the rows
    said: tuple[str, ...] = ()  # what a person should know of how it was taken

    @property
    def plain(self) -> bool:
        """Whether Arrow reads such rows from the file as they are."""
        return self.delimiter != WHITE and not self.comments


def split(line: str, delimiter: str) -> list[str]:
    """The cells of a line; roughly, where its quotes or lengths are none of CSV's."""
    try:
        return _cells(line, delimiter)
    except csv.Error:
        return line.split(delimiter)


def _cells(line: str, delimiter: str) -> list[str]:
    if delimiter == WHITE:
        return line.split()
    return next(csv.reader([line], delimiter=delimiter), [])


def is_comment(line: str) -> bool:
    """Whether a line is a remark."""
    return line.lstrip("\ufeff \t").startswith(COMMENTS)


def is_number(text: str, decimal: str = ".") -> bool:
    """Whether a cell is a number as Arrow has it."""
    if decimal == "," and "," in text:
        text = text.replace(",", ".", 1) if "." not in text else "x"
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text and text.isascii()


def sniff(lines: Sequence[str], file: str) -> Dialect:
    """The dialect of a text by its first lines. Raises `FileError` where it is no table."""
    table = [(number, line) for number, line in enumerate(lines, start=1) if without_invisible(line).strip()]
    given = _separator(table)
    if given is not None:
        table = table[1:]
    body = [(number, line) for number, line in table if not is_comment(line)]
    if not body and not table:
        raise FileError(file, "a header line and samples, the file is empty")
    if not body:
        raise FileError(file, "a header line and samples, the file is empty but for comments")
    delimiter = given or _delimiter([line for _, line in body])
    header, rows = _header(body, table, delimiter, file)
    first = _first_row(rows, delimiter)
    units = _units(rows[:first], header.names, delimiter)
    data = [line for _, line in rows[first:]]
    decimal = _decimal(data, delimiter)
    cells = [split(line, delimiter) for line in data[:20]]
    trailing = bool(cells) and all(len(row) == len(header.names) + 1 and not row[-1].strip() for row in cells)
    skip = rows[first][0] - 1 if first < len(rows) else (rows[-1][0] if rows else header.line)
    begun = rows[first][0] if first < len(rows) else 0
    comments = any(number > begun and is_comment(line) for number, line in table) if begun else False
    names = header.names
    shown = [name for name in names if name != without_invisible(name)]
    said = [f"signs that cannot be seen were left out of '{visible(name)}'" for name in shown]
    names = tuple(without_invisible(name).strip() for name in names)
    return Dialect(delimiter, decimal, names, header.line, skip, units, trailing, comments, tuple(said))


@dataclass(frozen=True)
class _Header:
    names: tuple[str, ...]
    line: int


_Lines = list[tuple[int, str]]


def _header(body: _Lines, table: _Lines, delimiter: str, file: str) -> tuple[_Header, _Lines]:
    """The names, and the lines after them that are no comments."""
    number, line = body[0]
    try:
        cells = _cells(line, delimiter)
    except csv.Error as error:
        raise FileError(file, f"a header of column names ({error})", line=number) from None
    numbers = _first_numbers(body, delimiter)
    if numbers is not None and numbers > 0 and not _fits(cells, split(body[numbers][1], delimiter)):
        return _header_before(body, numbers, delimiter)
    if all(is_number(cell, ",") for cell in cells if cell.strip()) and any(cell.strip() for cell in cells):
        return _header_in_comments(body, table, cells, delimiter, file)
    names = tuple(cell.strip() for cell in cells)
    return _Header(names, number), body[1:]


def _fits(header: list[str], row: list[str]) -> bool:
    return len(header) >= len(row) - 1 or len(row) < 3


def _header_before(body: _Lines, numbers: int, delimiter: str) -> tuple[_Header, _Lines]:
    """The last line before the numbers that has as many cells and is no row of units."""
    width = len(split(body[numbers][1], delimiter))
    for k in range(numbers - 1, -1, -1):
        cells = split(body[k][1], delimiter)
        if abs(len(cells) - width) <= 1 and len(cells) > 1 and not _all_units(cells) and not _is_metadata(cells):
            return _Header(tuple(cell.strip() for cell in cells), body[k][0]), body[k + 1 :]
    cells = split(body[0][1], delimiter)
    return _Header(tuple(cell.strip() for cell in cells), body[0][0]), body[1:]


def _header_in_comments(
    body: _Lines, table: _Lines, row: list[str], delimiter: str, file: str
) -> tuple[_Header, _Lines]:
    """The names of a table of numbers alone: the comment before it that has as many cells, else a known layout."""
    first = body[0][0]
    for number, line in reversed([pair for pair in table if pair[0] < first]):
        text = re.sub(r"^[\ufeff \t]*(?:#+|%+|//+)", "", line).strip()
        for separator in (delimiter, ",", "\t", WHITE):
            cells = [cell.strip() for cell in split(text, separator)]
            if len(cells) == len(row) > 1 and not any(is_number(cell) for cell in cells):
                return _Header(tuple(cells), number), body
    if (names := _NAMELESS.get((delimiter, len(row)))) is not None:
        return _Header(names, 0), body
    raise FileError(file, "a header line that names the columns", line=first, value=visible(body[0][1].strip()[:60]))


def _first_numbers(body: _Lines, delimiter: str) -> int | None:
    """Which line begins the rows of numbers: itself and the next have as many cells, most of them numbers."""
    for k in range(len(body) - 1):
        here, after = split(body[k][1], delimiter), split(body[k + 1][1], delimiter)
        if len(here) == len(after) > 1 and _numeric(here) and _numeric(after):
            return k
    return None


def _numeric(cells: list[str]) -> bool:
    filled = [cell for cell in cells if cell.strip()]
    return len(filled) > 1 and 2 * sum(is_number(cell, ",") for cell in filled) >= len(filled)


def _first_row(rows: _Lines, delimiter: str) -> int:
    """How many lines after the header are rows of units or of a tool's own words on its columns."""
    for k, (_, line) in enumerate(rows[:10]):
        cells = split(line, delimiter)
        if not (_all_units(cells) or _is_metadata(cells)):
            return k
    return min(len(rows), 10)


def _all_units(cells: list[str]) -> bool:
    """Whether a line is of units: none is a number, one is of time or angle, and all look like units."""
    if any(is_number(cell, ",") for cell in cells):
        return False
    known = [cell for cell in cells if cell.strip() and is_unit(cell)]
    return bool(known) and all(len(cell.strip()) <= 12 for cell in cells) and 2 * len(known) >= len(cells)


def _is_metadata(cells: list[str]) -> bool:
    filled = [cell for cell in cells if cell.strip()]
    return bool(filled) and all(_METADATA.match(cell) for cell in filled)


def _units(rows: _Lines, names: tuple[str, ...], delimiter: str) -> dict[str, str]:
    units: dict[str, str] = {}
    for _, line in rows:
        for name, cell in zip(names, split(line, delimiter), strict=False):
            found = _METADATA.match(cell)
            if found is None or found["key"].casefold() in _UNITS_KEY:
                unit = cell if found is None else found["value"]
                if unit.strip() and unit_in_name(name)[1] is None:
                    units[without_invisible(name).strip()] = unit.strip()
    return units


def _separator(table: _Lines) -> str | None:
    """What Excel's first line `sep=;` says."""
    if table and (found := re.fullmatch(r"\ufeff?\"?sep=(.)\"?", table[0][1].strip("\r\n "), re.IGNORECASE)):
        return found[1]
    return "\t" if table and table[0][1].lower().lstrip("\ufeff").startswith("sep=\t") else None


def _delimiter(body: list[str]) -> str:
    """The first that gives most lines as many cells, two or more; a comma where none does."""
    lines = body[-20:] if len(body) > 20 else body
    for delimiter in _DELIMITERS:
        widths = [len(split(line, delimiter)) for line in lines]
        common = max(set(widths), key=widths.count)
        if common > 1 and 2 * widths.count(common) >= len(widths):
            return delimiter
    return ","


def _decimal(data: list[str], delimiter: str) -> str:
    if delimiter == ",":
        return "."
    cells = [cell for line in data[:50] for cell in split(line, delimiter)]
    return "," if any(_DECIMAL_COMMA.match(cell) for cell in cells) and not any("." in cell for cell in cells) else "."
