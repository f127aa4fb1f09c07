"""A database that another program holds."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from sqlalchemy import text

from fullpose_server.location import Location
from fullpose_server.store import postgresql
from fullpose_server.store.tables import Table


@contextmanager
def held(location: Location) -> Iterator[None]:
    """While it lasts, nobody else writes."""
    if isinstance(location, Path):
        with closing(sqlite3.connect(location, isolation_level=None)) as locked:
            locked.execute("BEGIN EXCLUSIVE")
            yield
            locked.execute("ROLLBACK")
        return
    engine = postgresql.patient_engine(location, changes=True)
    with engine.begin() as connection:
        names = ", ".join(f'"{table.name}"' for table in Table.metadata.sorted_tables)
        connection.execute(text(f"LOCK TABLE {names} IN ACCESS EXCLUSIVE MODE"))
        yield
    engine.dispose()
