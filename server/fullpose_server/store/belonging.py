"""A PostgreSQL and a data folder belong together: the one has the rows, the other the files that they are of.

With another folder every flight and plan would be one that was lost, and rows of what is lost are removed.
"""

from pathlib import Path
from uuid import uuid4

from sqlalchemy import select
from sqlalchemy.orm import Session

from fullpose_server.errors import ServerError
from fullpose_server.formats.output_file import write_text
from fullpose_server.location import DATABASE, Location, PostgresqlUrl
from fullpose_server.store.database import Database
from fullpose_server.store.tables import DataFolderRow

FILE = "database.id"  # in the data folder


class ForeignDatabaseError(ServerError):
    """A database and a data folder that do not belong together."""


def bind(database: Database, location: Location, folder: Path) -> None:
    """Let them belong together where neither has another yet. Raises `ForeignDatabaseError`."""
    if not isinstance(location, PostgresqlUrl):
        return
    if (folder / DATABASE).exists():
        raise ForeignDatabaseError(
            f"data folder {folder} has rows of its own in {DATABASE}, which are not in {location}: bring them"
            " there with `fullpose backup` and `fullpose restore`, or move that file away"
        )
    with database.begin_alone(DataFolderRow) as session:
        if check(session, location, folder):
            return
        known = _of_folder(folder) or uuid4().hex
        write_text(folder / FILE, f"{known}\n")
        session.add(DataFolderRow(id=known))


def check(session: Session, location: Location, folder: Path) -> bool:
    """Whether the database has a folder yet. Raises `ForeignDatabaseError` where it has another."""
    known = session.scalar(select(DataFolderRow.id))
    if known is not None and known != _of_folder(folder):
        raise ForeignDatabaseError(
            f"database {location} belongs to another data folder than {folder}, which has the files of its rows: name"
            " that one with --data-dir, or another database"
        )
    return known is not None


def _of_folder(folder: Path) -> str | None:
    file = folder / FILE
    return file.read_text("utf-8").strip() if file.is_file() else None
