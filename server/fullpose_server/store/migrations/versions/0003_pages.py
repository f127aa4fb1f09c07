"""Lists are read page by page, newest first: an index each."""

from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_index("ix_trajectories_created", "trajectories", ["created", "sha256"])
    op.create_index("ix_plans_created", "plans", ["created", "id"])
    op.create_index("ix_plans_rig", "plans", ["rig", "created", "id"])
    op.create_index("ix_plans_trajectory", "plans", ["trajectory", "created", "id"])


def downgrade() -> None:
    for name in ("ix_plans_trajectory", "ix_plans_rig", "ix_plans_created"):
        op.drop_index(name, "plans")
    op.drop_index("ix_trajectories_created", "trajectories")
