"""All rows of one database into another of the same revision, whichever kind either is: of one moment, all or none."""

from sqlalchemy import Table, func, insert, select
from sqlalchemy.orm import Session

from fullpose_server.errors import ServerError
from fullpose_server.store import postgresql
from fullpose_server.store.tables import DataFolderRow
from fullpose_server.store.tables import Table as Tables

AT_ONCE = 1000


class NotEmptyError(ServerError):
    """A database that is to take rows in, and has some."""


def copied_tables() -> list[Table]:
    """In an order in which no row refers to one that comes later; which folder a database belongs to stays with it."""
    return [table for table in Tables.metadata.sorted_tables if table.name != DataFolderRow.__tablename__]


def check_empty(target: Session, name: str) -> None:
    """Raises `NotEmptyError` where there is any row."""
    for table in Tables.metadata.sorted_tables:
        rows = target.scalar(select(func.count()).select_from(table)) or 0
        if rows:
            raise NotEmptyError(f"{name}: expected a database without rows, its table {table.name} has {rows}")


def copy_rows(source: Session, target: Session) -> int:
    """Copy every row; returns how many."""
    copied = 0
    for table in copied_tables():
        query = select(table).order_by(*table.primary_key.columns).execution_options(yield_per=AT_ONCE)
        for rows in source.execute(query).mappings().partitions():
            target.execute(insert(table), [dict(row) for row in rows])
            copied += len(rows)
    postgresql.number_on(target.connection(), copied_tables())
    return copied
