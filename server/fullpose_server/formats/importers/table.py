"""What every importer makes of a file: tables of named columns. What the columns mean is a column map's to say.

An importer is a module with one function, `read_tables(path, file, bounds) -> tuple[Table, ...]`, and a row in
`importers.registry`. A file with one clock is one table; a log of many messages or topics is one table each, those with
attitudes first.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array, Integers
from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution

# (n,) each. Doubles; a column of stamps that doubles would round (nanoseconds since 1970) may stay whole numbers.
Columns = Mapping[str, Array | Integers]
_EMPTY_BRACKETS = re.compile(r"\s*(?:\[\s*\]|\(\s*\))\s*$")
_UNIT_IN_NAME = re.compile(
    r"^\s*(?P<name>.*?)\s*[\[(<{](?P<unit>[^\[\](){}<>]*[^\[\](){}<>0-9.,:;+\- ][^\[\](){}<>]*)[\])>}]\s*$"
)


def _from_one(row: int) -> int:
    return row + 1


@dataclass(frozen=True)
class Table:
    """The columns of one clock in a file. Nothing but the header is read until `load` is called.

    `load(names)` returns those columns, each (n,), all of one length, or raises `FileError` naming the place of what
    is no number (a missing value is nan where the format has such, and is refused later, with its place).
    """

    file: str  # its name in messages
    format: str  # the name of its importer's row, for `input.format`
    names: tuple[str, ...]  # of its columns, as the file has them, in its order
    load: Callable[[Sequence[str]], Columns] = field(repr=False)
    name: str = ""  # of the table in the file: message, topic, sheet, variable; "" where a file is one table
    units: Mapping[str, str] = field(
        default_factory=dict
    )  # of a column, as the file says it ("deg", "ms"), where it does
    line_of: Callable[[int], int] = field(default=_from_one, repr=False)  # of a row from 0, for messages: its line
    row_word: str = "row"  # what `line_of` counts: "line", "row", "message"
    header_line: int | None = None  # where the names are
    profile: str | None = None  # the named profile that this format's columns have, where the format fixes them
    cautions: tuple[Caution, ...] = ()
    on_request: bool = False  # not the attitude that such a file is of: read where a person names it as the source
    head: tuple[tuple[str, ...], ...] = ()  # the first rows as text, for a person to look at; cells as `names`

    def unit(self, name: str) -> str | None:
        """The unit of a column as the file says it, apart from the name or in brackets in it; None: it does not."""
        return self.units.get(name) or unit_in_name(name)[1]

    def error(
        self,
        expected: str,
        column: str | None = None,
        value: str | None = None,
        row: int | None = None,
        otherwise: tuple[str, str] | None = None,
    ) -> FileError:
        """A `FileError` at a row, counted from 0, or in the header."""
        line, word = self.header_line if row is None else self.line_of(row), self.row_word
        return FileError(self.file, expected, line=line, column=column, value=value, unit=word, otherwise=otherwise)


def table_of(
    file: str,
    kind: str,
    columns: Columns,
    *,
    name: str = "",
    units: Mapping[str, str] | None = None,
    row_word: str = "row",
    profile: str | None = None,
    cautions: tuple[Caution, ...] = (),
) -> Table:
    """A table of columns that are in memory already: what a library has read whole."""
    return Table(
        file=file,
        format=kind,
        names=tuple(columns),
        load=lambda names: {each: columns[each] for each in names},
        name=name,
        units=units or {},
        row_word=row_word,
        profile=profile,
        cautions=cautions,
        head=first_rows(columns),
    )


def first_rows(columns: Columns, rows: int = 8) -> tuple[tuple[str, ...], ...]:
    """The first rows of columns in memory, as text."""
    shown: list[NDArray[np.generic]] = [np.asarray(column[:rows]) for column in columns.values()]
    return tuple(tuple(str(cell) for cell in cells) for cells in zip(*(part.tolist() for part in shown), strict=True))


def unit_in_name(name: str) -> tuple[str, str | None]:
    """The name without a unit in brackets, and the unit: ("heading", "deg") of "heading [deg]"; None without one.

    `q[0]` has none: an index is no unit.
    """
    name = _EMPTY_BRACKETS.sub("", name)
    found = _UNIT_IN_NAME.match(name)
    return (found["name"], found["unit"].strip()) if found else (name.strip(), None)
