"""Of a file with several attitudes (topics, messages, groups, sheets): the one that a person names."""

from collections.abc import Sequence

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.visible import visible

_MOST = 20  # names in a message


def of_source(tables: tuple[Table, ...], source: str | None) -> tuple[Table, ...]:
    """The tables that are looked at: the named one, else those of the attitudes that such a file is of.

    Raises `FileError` where there is none of that name.
    """
    if source is None:
        return tuple(table for table in tables if not table.on_request) or tables
    found = tuple(table for table in tables if table.name == source)
    if not found:
        raise FileError(tables[0].file, f"a source among {listed(tables)}", value=visible(source))
    return found


def check_one(fitting: Sequence[Table]) -> None:
    """Raise `FileError` where several attitudes could be meant: which of them is nobody's guess."""
    if len(fitting) > 1:
        takes = ("source", f"takes one of: {listed(fitting)}")
        raise FileError(fitting[0].file, "one attitude", value=f"{len(fitting)} attitudes", otherwise=takes)


def listed(tables: Sequence[Table]) -> str:
    """The names of tables, for a message."""
    names = [visible(table.name) or "(unnamed)" for table in tables]
    return ", ".join(names[:_MOST]) + (f", ... ({len(names)} sources)" if len(names) > _MOST else "")
