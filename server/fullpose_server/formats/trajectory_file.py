"""Reading a flight from a file of any known format; what is wrong is named by file, line and column."""

from dataclasses import dataclass
from pathlib import Path

from fullpose_server.formats.choose_map import choose
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.registry import importer_of, read_tables
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.profile import Profile, find_profile
from fullpose_server.formats.table_flight import flight_of
from fullpose_server.formats.trajectory import Convention, Trajectory


@dataclass(frozen=True)
class ReadOptions:
    """How a flight is to be read."""

    convention: Convention | None = None  # None: the profile's
    profile: str | None = None  # a named one or a TOML file; None: the first that fits


AS_IT_IS = ReadOptions()


def read_trajectory(
    path: Path,
    convention: Convention | None = None,
    name: str | None = None,
    bounds: Bounds = UNBOUNDED,
    options: ReadOptions = AS_IT_IS,
) -> Trajectory:
    """The flight in a file of a format that `importers.registry` has, told apart by content; `name` replaces the path
    in messages.

    Raises `TooLargeError` beyond the bounds, `FileError` for everything else a person can put right, `OSError` where
    the file cannot be read at all.
    """
    file = str(path) if name is None else name
    profile = None if options.profile is None else find_profile(options.profile)
    tables = read_tables(path, file, bounds, importer_of(path, file, name or ""))
    return flight_in(tables, convention or options.convention, profile)


def flight_in(tables: tuple[Table, ...], convention: Convention | None, profile: Profile | None = None) -> Trajectory:
    """The flight in the tables of a file. Raises as `read_trajectory`."""
    chosen = choose(tables, convention, profile)
    return flight_of(chosen.table, chosen.columns, chosen.profile)
