"""A plan has a tolerance: by how much the attitude may differ from the flight's."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    with op.batch_alter_table("plans") as table:
        table.add_column(sa.Column("tolerance_deg", sa.Float(), nullable=True))


def downgrade() -> None:
    with op.batch_alter_table("plans") as table:
        table.drop_column("tolerance_deg")
