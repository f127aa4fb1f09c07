"""A flight says what was taken of its file."""

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("trajectories", sa.Column("input", sa.JSON(), nullable=True))


def downgrade() -> None:
    # Not as a batch, which makes the table anew: SQLite drops no table that plans refer to.
    op.drop_column("trajectories", "input")
