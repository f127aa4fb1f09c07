"""The database read by other programs than the server: also while it serves, and without changing a byte."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session

from fullpose_server.errors import DamagedError, FileError, ServerError
from fullpose_server.location import Location, PostgresqlUrl
from fullpose_server.store import postgresql, sqlite
from fullpose_server.store.database import HEAD, NewerDatabaseError, UnreachableDatabaseError, revision_of


class EarlierDatabaseError(ServerError):
    """An earlier version wrote it, and reading cannot bring it up."""

    def __init__(self, location: Location, revision: str) -> None:
        super().__init__(
            f"database {location} was written by an earlier Fullpose (revision {revision}, this one reads {HEAD}):"
            " start the server once, which brings it up"
        )


@contextmanager
def reading(location: Location) -> Iterator[Session]:
    """A session that can only read, as of one moment.

    Raises `FileError` where there is none, `DamagedError`, `StorageError`, `EarlierDatabaseError`,
    `NewerDatabaseError`.
    """
    if isinstance(location, PostgresqlUrl):
        engine = postgresql.patient_engine(location, changes=False)
    elif location.is_file():
        engine = sqlite.reading_engine(location)
    else:
        raise FileError(str(location), "the database of a server (name its --data-dir)")
    try:
        with engine.connect() as connection:
            _check_revision(location, connection)
        with Session(engine) as session:
            if engine.dialect.name == "postgresql":
                session.execute(text(postgresql.SNAPSHOT))
            yield session
    except DBAPIError as error:
        if isinstance(location, PostgresqlUrl):
            raise UnreachableDatabaseError(location, error) from error
        raise DamagedError(f"database {location} cannot be read: {error.orig}") from error
    finally:
        engine.dispose()


def _check_revision(location: Location, connection: Connection) -> None:
    revision = revision_of(connection)
    if revision is None:
        raise FileError(str(location), "the database of a server, this is another")
    if revision > HEAD:
        raise NewerDatabaseError(location, revision)
    if revision != HEAD:
        raise EarlierDatabaseError(location, revision)
