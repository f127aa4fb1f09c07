"""Whether a data folder has people, asked before a server opens its port: no SQLAlchemy, which takes its time."""

import sqlite3
from contextlib import closing
from pathlib import Path

from fullpose_server.store.readonly import DATABASE, readonly


def had_people(file: Path) -> bool:
    """Whether a database that is damaged had people, as far as can be seen: by its rows, or the hash of a password."""
    logged = file.with_name(f"{file.name}-wal")
    return _has_rows(file) or any(b"$argon2id$" in each.read_bytes() for each in (file, logged) if each.is_file())


def has_people(data_dir: Path) -> bool:
    """Whether somebody could sign in to a server on this folder. A database that cannot be read has nobody."""
    return _has_rows(data_dir / DATABASE)


def _has_rows(file: Path) -> bool:
    file = file.resolve()
    if not file.is_file():
        return False
    try:
        with closing(sqlite3.connect(readonly(file), uri=True)) as connection:
            found = connection.execute("SELECT 1 FROM users WHERE NOT disabled LIMIT 1").fetchone()
    except sqlite3.Error:  # of an earlier version too, which knew no people
        return False
    return found is not None
