"""The migrations lead to the tables; the file is in write-ahead mode."""

from pathlib import Path

from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import text

from server.store.database import Database, migrate
from server.store.tables import Table


def test_migrations_lead_to_the_tables(tmp_path: Path) -> None:
    database = Database(tmp_path / "a.db")
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Table.metadata) == []
    database.close()


def test_opening_again_changes_nothing(tmp_path: Path) -> None:
    database = Database(tmp_path / "a.db")
    migrate(database.engine)
    with database.engine.connect() as connection:
        assert connection.execute(text("PRAGMA journal_mode")).scalar() == "wal"
        assert connection.execute(text("PRAGMA foreign_keys")).scalar() == 1
    database.close()
