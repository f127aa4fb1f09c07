"""Whether a database has people, asked before a server opens its port: no SQLAlchemy, which takes its time."""

import sqlite3
from contextlib import closing
from pathlib import Path

from fullpose_server.errors import StorageError
from fullpose_server.location import NO_DRIVER, Location, PostgresqlUrl
from fullpose_server.store.readonly import readonly

_ANYBODY = "SELECT 1 FROM users WHERE NOT disabled LIMIT 1"
_CONNECT_S = 5


def had_people(file: Path) -> bool:
    """Whether a database that is damaged had people, as far as can be seen: by its rows, or the hash of a password."""
    logged = file.with_name(f"{file.name}-wal")
    return has_people(file) or any(b"$argon2id$" in each.read_bytes() for each in (file, logged) if each.is_file())


def has_people(location: Location) -> bool:
    """Whether somebody could sign in to a server on this database. A file that cannot be read has nobody.

    Raises `StorageError` for a PostgreSQL that does not answer.
    """
    if isinstance(location, PostgresqlUrl):
        return _asked(location)
    file = location.resolve()
    if not file.is_file():
        return False
    try:
        with closing(sqlite3.connect(readonly(file), uri=True)) as connection:
            found = connection.execute(_ANYBODY).fetchone()
    except sqlite3.Error:  # of an earlier version too, which knew no people
        return False
    return found is not None


def _asked(location: PostgresqlUrl) -> bool:
    try:
        import psycopg
    except ImportError:
        raise StorageError(NO_DRIVER) from None
    try:
        with psycopg.connect(
            location.url, connect_timeout=_CONNECT_S, options="-c statement_timeout=5000"
        ) as connection:
            return connection.execute(_ANYBODY).fetchone() is not None
    except psycopg.errors.UndefinedTable:  # nothing of ours yet, or of an earlier version
        return False
    except psycopg.Error as error:
        said = " ".join(str(error).split())
        raise StorageError(f"database {location} cannot be opened: the database does not answer: {said}") from None
