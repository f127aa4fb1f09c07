"""Whether a data folder has people, asked before a server opens its port: no SQLAlchemy, which takes its time."""

import sqlite3
from contextlib import closing
from pathlib import Path

from fullpose_server.store.readonly import readonly


def has_people(data_dir: Path) -> bool:
    """Whether somebody could sign in to a server on this folder. A database that cannot be read has nobody."""
    file = (data_dir / "fullpose.db").resolve()
    if not file.is_file():
        return False
    try:
        with closing(sqlite3.connect(readonly(file), uri=True)) as connection:
            found = connection.execute("SELECT 1 FROM users WHERE NOT disabled LIMIT 1").fetchone()
    except sqlite3.Error:  # of an earlier version too, which knew no people
        return False
    return found is not None
