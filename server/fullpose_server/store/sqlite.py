"""SQLite as the store uses it: one file, write-ahead log, and what its errors are to whoever asked."""

import sqlite3
from pathlib import Path
from typing import Any

from sqlalchemy import Engine, create_engine, event, text
from sqlalchemy.exc import DBAPIError

from fullpose_server.errors import DamagedError, StorageBusyError, StorageError, StorageFullError
from fullpose_server.store.readonly import readonly

DAMAGE = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)
ALONE = "BEGIN IMMEDIATE"
SNAPSHOT = "BEGIN"  # from its first look on: in a write-ahead log every transaction reads as of one moment


def engine(path: Path, busy_s: float) -> Engine:
    """On a file, which is made where it is not there; locked, it is waited for, `busy_s` [s]."""
    made = create_engine(f"sqlite:///{path}", connect_args={"timeout": busy_s})

    @event.listens_for(made, "connect")
    def _pragmas(connection: Any, _record: object) -> None:
        cursor = connection.cursor()
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.execute("PRAGMA synchronous=NORMAL")  # safe in WAL mode but for the last transactions of a power cut
        cursor.execute("PRAGMA foreign_keys=ON")
        cursor.close()

    return made


def reading_engine(path: Path) -> Engine:
    """Likewise, which changes not a byte."""
    return create_engine(f"sqlite:///{readonly(path)}&uri=true")


def check(made: Engine) -> None:
    """Raise `DamagedError` where SQLite finds the file's pages in disorder."""
    with made.connect() as connection:
        found = connection.scalars(text("PRAGMA quick_check(1)")).all()
    if list(found) != ["ok"]:
        raise DamagedError(f"the database is damaged: {' '.join(str(found[0]).split())[:200]}")


def told(error: DBAPIError) -> StorageError | DamagedError | None:
    """What SQLite's error is to whoever asked; None where it is an error of ours."""
    code = getattr(error.orig, "sqlite_errorcode", 0) & 0xFF
    if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY):
        return StorageFullError(f"the database cannot be written: {error.orig}")
    if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return StorageBusyError(f"the database is held by another program: {error.orig}")
    if code in DAMAGE:
        return DamagedError(f"the database is damaged: {error.orig}")
    return None
