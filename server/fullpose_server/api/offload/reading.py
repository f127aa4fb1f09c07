"""A file looked at before it is stored: its first rows, what its columns are taken for, and the flight it makes."""

from pathlib import Path
from typing import Any

from fullpose_server.api.thinned import thinned_flight
from fullpose_server.errors import FileError
from fullpose_server.formats.choose_map import choose
from fullpose_server.formats.importers.columns import Bounds
from fullpose_server.formats.importers.registry import importer_of, read_tables
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.profile import Profile, shipped
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.saved_profiles import SavedProfiles
from fullpose_server.formats.trajectory_file import flight_chosen
from fullpose_server.formats.visible import visible

MOST_COLUMNS = 200  # that a person looks through


def reading_preview(
    path: Path, file: str, bounds: Bounds, options: ReadOptions, points: int, saved: str
) -> dict[str, Any]:
    """The preview as JSON-ready values, about `points` samples of the flight; `saved`: the folder of people's profiles.

    What does not make a flight is in `problem`: a person can say otherwise. Raises as `read_tables`.
    """
    tables = read_tables(path, file, bounds, importer_of(path, file, file))
    profiles = [*SavedProfiles(Path(saved)).all().values(), *shipped().values()]
    document = _of_table(tables[0], tables, profiles) | {
        "columns": None,
        "profile": None,
        "problem": None,
        "remedy": None,
        "flight": None,
    }
    try:
        chosen = choose(tables, options)
        document |= _of_table(chosen.table, tables, profiles)
        document |= {"columns": chosen.columns.model_dump(mode="json"), "profile": chosen.profile}
        flight = flight_chosen(chosen, options)
    except FileError as error:
        return document | {"problem": str(error), "remedy": error.otherwise and error.otherwise[0]}
    return document | {
        "flight": {
            "samples": int(flight.time.size),
            "duration_s": float(flight.time[-1] - flight.time[0]),
            "convention": flight.convention.value,
            "statement": flight.taken.statement,
            "warnings": [caution.to_json() for caution in flight.warnings],
            **thinned_flight(flight.time, flight.q, points),
        }
    }


def _of_table(table: Table, tables: tuple[Table, ...], profiles: list[Profile]) -> dict[str, Any]:
    names = table.names[:MOST_COLUMNS]
    return {
        "format": table.format,
        "table": table.name,
        "tables": [each.name for each in tables],
        "names": list(names),
        "units": [table.unit(name) for name in names],
        "head": [[visible(cell) for cell in row[: len(names)]] for row in table.head],
        "profiles": [{"name": each.name, "about": each.about} for each in profiles if not each.missing(table)],
    }
