"""Trajectories, plans, audit."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "trajectories",
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("source_sha256", sa.String(64), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("convention", sa.String(8), nullable=False),
        sa.Column("source_format", sa.String(8), nullable=False),
        sa.Column("source_bytes", sa.Integer, nullable=False),
        sa.Column("samples", sa.Integer, nullable=False),
        sa.Column("start_s", sa.Float, nullable=False),
        sa.Column("duration_s", sa.Float, nullable=False),
        sa.Column("rate_hz", sa.Float, nullable=True),
        sa.Column("uniform", sa.Boolean, nullable=False),
        sa.Column("peak_body_rate_deg_s", sa.Float, nullable=True),
        sa.Column("warnings", sa.JSON, nullable=False),
        sa.Column("created", sa.Float, nullable=False),
        sa.PrimaryKeyConstraint("sha256", name="pk_trajectories"),
    )
    op.create_table(
        "plans",
        sa.Column("id", sa.String(32), nullable=False),
        sa.Column("trajectory", sa.String(64), nullable=False),
        sa.Column("rig", sa.String(64), nullable=False),
        sa.Column("rig_hash", sa.String(64), nullable=False),
        sa.Column("method", sa.String(64), nullable=False),
        sa.Column("options", sa.JSON, nullable=False),
        sa.Column("start_deg", sa.JSON, nullable=True),
        sa.Column("rate_hz", sa.Float, nullable=False),
        sa.Column("status", sa.String(16), nullable=False),
        sa.Column("error", sa.JSON, nullable=True),
        sa.Column("result", sa.JSON, nullable=True),
        sa.Column("created", sa.Float, nullable=False),
        sa.Column("started", sa.Float, nullable=True),
        sa.Column("finished", sa.Float, nullable=True),
        sa.ForeignKeyConstraint(["trajectory"], ["trajectories.sha256"], name="fk_plans_trajectory"),
        sa.PrimaryKeyConstraint("id", name="pk_plans"),
    )
    op.create_index("ix_plans_status", "plans", ["status"])
    op.create_table(
        "audit",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("at", sa.Float, nullable=False),
        sa.Column("who", sa.String(128), nullable=False),
        sa.Column("rig", sa.String(64), nullable=False),
        sa.Column("command", sa.String(32), nullable=False),
        sa.Column("args", sa.JSON, nullable=False),
        sa.Column("lease_epoch", sa.Integer, nullable=True),
        sa.Column("lease_sequence", sa.Integer, nullable=True),
        sa.Column("state_before", sa.String(16), nullable=False),
        sa.Column("state_after", sa.String(16), nullable=False),
        sa.Column("accepted", sa.Boolean, nullable=False),
        sa.Column("detail", sa.String, nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_audit"),
    )
    op.create_index("ix_audit_rig", "audit", ["rig"])


def downgrade() -> None:
    op.drop_table("audit")
    op.drop_table("plans")
    op.drop_table("trajectories")
