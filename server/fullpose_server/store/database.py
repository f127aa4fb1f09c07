"""The embedded database: one SQLite file, write-ahead log, migrated by Alembic when it is opened."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, create_engine, event, inspect, text
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import Session, sessionmaker

from fullpose_server.errors import DamagedError, ServerError, StorageBusyError, StorageError, StorageFullError

HEAD = "0006"  # the newest revision in migrations/versions
WAIT_S = 2.0  # for another program that holds it: the threads that wait here are not many
DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
MIGRATIONS = Path(__file__).parent / "migrations"


class NewerDatabaseError(ServerError):
    """Another, newer version wrote it."""

    def __init__(self, path: Path, revision: str) -> None:
        super().__init__(
            f"database {path} was written by a newer Fullpose (revision {revision}, this one knows {HEAD}): start that"
            f" one, or move the file away and put a backup of an earlier one in its place"
        )


class Database:
    """Sessions on the file; synchronous: async callers go through a thread. Locked, it is waited for, `busy_s` [s]."""

    def __init__(self, path: Path, busy_s: float = WAIT_S) -> None:
        """Open it, or make it. Raises `DamagedError`, `NewerDatabaseError`, `StorageError`."""
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(OSError):  # SQLite says better what is wrong
            path.touch(mode=0o600, exist_ok=True)  # hashes of passwords are in it
            path.chmod(0o600)  # one that an earlier version made
        self.engine = _engine(path, busy_s)
        try:
            _check(self.engine)
            migrate(self.engine)
        except DBAPIError as error:
            self.engine.dispose()
            told = _told(error)
            if told is None:  # tables that are not the ones that its revision has
                told = DamagedError(f"the database is damaged: {error.orig}")
            raise told from error
        except BaseException:
            self.engine.dispose()
            raise
        self._sessions = sessionmaker(self.engine, expire_on_commit=False)

    @contextmanager
    def begin(self) -> Iterator[Session]:
        """One transaction: committed at the end, rolled back by an exception. Raises `StorageError`."""
        try:
            with self._sessions.begin() as session:
                yield session
        except DBAPIError as error:
            told = _told(error)
            if told is None:
                raise
            raise told from error

    def close(self) -> None:
        """Close every connection; the write-ahead log is folded into the file."""
        self.engine.dispose()


def _check(engine: Engine) -> None:
    """Raise `DamagedError` where SQLite finds the file's pages in disorder."""
    with engine.connect() as connection:
        found = connection.scalars(text("PRAGMA quick_check(1)")).all()
    if list(found) != ["ok"]:
        raise DamagedError(f"the database is damaged: {' '.join(str(found[0]).split())[:200]}")


def _told(error: DBAPIError) -> StorageError | DamagedError | None:
    """What SQLite's error is to whoever asked; None where it is an error of ours."""
    code = getattr(error.orig, "sqlite_errorcode", 0) & 0xFF
    if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY):
        return StorageFullError(f"the database cannot be written: {error.orig}")
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return StorageBusyError(f"the database is held by another program: {error.orig}")
    if code in DAMAGE:
        return DamagedError(f"the database is damaged: {error.orig}")
    return None


def migrate(engine: Engine) -> None:
    """Bring the schema to the newest revision. Raises `NewerDatabaseError`."""
    with engine.begin() as connection:
        known = inspect(connection).has_table("alembic_version")
        revision = connection.scalar(text("SELECT version_num FROM alembic_version")) if known else None
        if revision == HEAD:
            return
        if revision is not None and revision > HEAD:
            raise NewerDatabaseError(Path(str(engine.url.database)), revision)
    # Takes a tenth of the server's start to load, and has something to do once in a version's life.
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _engine(path: Path, busy_s: float) -> Engine:
    engine = create_engine(f"sqlite:///{path}", connect_args={"timeout": busy_s})

    @event.listens_for(engine, "connect")
    def _pragmas(connection: Any, _record: object) -> None:
        cursor = connection.cursor()
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.execute("PRAGMA synchronous=NORMAL")  # safe in WAL mode but for the last transactions of a power cut
        cursor.execute("PRAGMA foreign_keys=ON")
        cursor.close()

    return engine
