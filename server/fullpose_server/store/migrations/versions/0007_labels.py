"""Tags and notes of flights and plans, and what they are searched by; which data folder a PostgreSQL belongs to.

On PostgreSQL, which minds them, columns lose their lengths, and whole numbers have 64 bits.
"""

import sqlalchemy as sa
from alembic import op

from fullpose_server.formats.labels import NO_LABELS, search_text

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

LABELLED = {"trajectories": ("sha256", ("name",)), "plans": ("id", ("rig", "method"))}
COLUMNS = ("tags", "notes", "search")


def upgrade() -> None:
    connection = op.get_bind()
    if connection.dialect.name == "postgresql":
        _widen(connection)
    for table, (key, texts) in LABELLED.items():
        op.add_column(table, sa.Column("tags", sa.JSON, nullable=False, server_default="[]"))
        op.add_column(table, sa.Column("notes", sa.String, nullable=False, server_default=""))
        op.add_column(table, sa.Column("search", sa.String, nullable=False, server_default=""))
        rows = sa.Table(table, sa.MetaData(), autoload_with=connection)
        for row in connection.execute(sa.select(rows.c[key], *(rows.c[name] for name in texts))).all():
            found = search_text(NO_LABELS, *row[1:])
            connection.execute(sa.update(rows).where(rows.c[key] == row[0]).values(search=found))
    op.create_table(
        "data_folder",
        sa.Column("id", sa.String, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_data_folder"),
    )


def downgrade() -> None:
    op.drop_table("data_folder")
    for table in LABELLED:
        for name in COLUMNS:
            op.drop_column(table, name)


def _widen(connection: sa.Connection) -> None:
    tables = sa.MetaData()
    tables.reflect(connection)
    for table in tables.sorted_tables:
        for column in table.columns:
            if table.name == "alembic_version":
                continue
            if isinstance(column.type, sa.Integer):
                op.alter_column(table.name, column.name, type_=sa.BigInteger)
            elif isinstance(column.type, sa.String) and column.type.length is not None:
                op.alter_column(table.name, column.name, type_=sa.String)
