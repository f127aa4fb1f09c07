"""The people of a data folder, for commands that change them: a server that runs on it sees that within a second."""

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from fullpose_server.store.people import PeopleStore

DataDir = Annotated[Path | None, typer.Option(help="The server's data folder (~/.local/share/fullpose).")]
UserName = Annotated[str, typer.Argument(metavar="NAME", help="Who: letters, digits or . @ : + - _")]


@contextmanager
def people_of(data_dir: Path | None, config: Path | None) -> Iterator["PeopleStore"]:
    """The people of a server's data folder, which is made where it is not there yet. Raises `ServerError`."""
    from fullpose_server.cli._configuration import configured
    from fullpose_server.store.database import Database
    from fullpose_server.store.people import PeopleStore

    folder = configured(data_dir=data_dir, config=config).settings.data_dir
    database = Database(folder / "fullpose.db")
    try:
        yield PeopleStore(database)
    finally:
        database.close()


def day(moment: float | None) -> str:
    """A time [s since 1970] for a table."""
    return "-" if moment is None else datetime.fromtimestamp(moment, UTC).strftime("%Y-%m-%d %H:%M")
