"""Reading a flight from a file of any known format; what is wrong is named by file, line and column."""

from dataclasses import replace
from pathlib import Path

from fullpose_server.formats.caution import Caution
from fullpose_server.formats.choose_map import Choice, choose
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.registry import importer_of, read_tables
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.read_options import AS_IT_IS, ReadOptions
from fullpose_server.formats.table_flight import flight_of
from fullpose_server.formats.trajectory import Convention, Trajectory


def read_trajectory(
    path: Path,
    convention: Convention | None = None,
    name: str | None = None,
    bounds: Bounds = UNBOUNDED,
    options: ReadOptions = AS_IT_IS,
) -> Trajectory:
    """The flight in a file of a format that `importers.registry` has, told apart by content; `name` replaces the path
    in messages. `convention`: before that of `options`.

    Raises `TooLargeError` beyond the bounds, `FileError` for everything else a person can put right, `OSError` where
    the file cannot be read at all.
    """
    file = str(path) if name is None else name
    options = options if convention is None else replace(options, convention=convention)
    return flight_in(read_tables(path, file, bounds, importer_of(path, file, name or "")), options)


def flight_in(tables: tuple[Table, ...], options: ReadOptions = AS_IT_IS) -> Trajectory:
    """The flight in the tables of a file. Raises as `read_trajectory`."""
    return flight_chosen(choose(tables, options), options)


def flight_chosen(chosen: Choice, options: ReadOptions = AS_IT_IS) -> Trajectory:
    """The flight of a table whose columns are chosen. Raises as `read_trajectory`."""
    flight = flight_of(chosen.table, chosen.columns, options)
    taken = replace(flight.taken, profile=chosen.profile, statement=f"{flight.taken.statement} ({chosen.reason})")
    warnings = flight.warnings
    if chosen.assumed is not None:
        warnings = (Caution("axes", chosen.assumed), *warnings)
    return replace(flight, taken=taken, warnings=warnings)
