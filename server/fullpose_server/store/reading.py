"""The embedded database read by other programs than the server: also while it serves, and without changing a byte."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import Connection, create_engine, inspect, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from fullpose_server.errors import DamagedError, FileError, ServerError
from fullpose_server.store.database import HEAD, NewerDatabaseError
from fullpose_server.store.readonly import readonly


class EarlierDatabaseError(ServerError):
    """An earlier version wrote it, and reading cannot bring it up."""

    def __init__(self, path: Path, revision: str) -> None:
        super().__init__(
            f"database {path} was written by an earlier Fullpose (revision {revision}, this one reads {HEAD}): start"
            " the server once, which brings it up"
        )


@contextmanager
def reading(path: Path) -> Iterator[Session]:
    """A session that can only read. Raises `FileError` where there is none, `DamagedError`, `EarlierDatabaseError`,
    `NewerDatabaseError`.
    """
    if not path.is_file():
        raise FileError(str(path), "the database of a server (name its --data-dir)")
    engine = create_engine(f"sqlite:///{readonly(path)}&uri=true")
    try:
        with engine.connect() as connection:
            _check_revision(path, connection)
        with Session(engine) as session:
            yield session
    except DBAPIError as error:
        raise DamagedError(f"database {path} cannot be read: {error.orig}") from error
    finally:
        engine.dispose()


def _check_revision(path: Path, connection: Connection) -> None:
    if not inspect(connection).has_table("alembic_version"):
        raise FileError(str(path), "the database of a server, this is another")
    revision = str(connection.scalar(text("SELECT version_num FROM alembic_version")))
    if revision > HEAD:
        raise NewerDatabaseError(path, revision)
    if revision != HEAD:
        raise EarlierDatabaseError(path, revision)
