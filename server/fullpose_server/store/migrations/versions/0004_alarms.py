"""The alarm history and the shelves that stand; pages of the audit of one rig."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "alarms",
        sa.Column("id", sa.String(64), nullable=False),
        sa.Column("rig", sa.String(64), nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("code", sa.String(64), nullable=False),
        sa.Column("severity", sa.String(16), nullable=False),
        sa.Column("message", sa.String, nullable=False),
        sa.Column("time_s", sa.Float, nullable=False),
        sa.Column("frame", sa.String(16), nullable=True),
        sa.Column("value", sa.Float, nullable=True),
        sa.Column("limit", sa.Float, nullable=True),
        sa.Column("unit", sa.String(16), nullable=True),
        sa.Column("first", sa.Boolean, nullable=False),
        sa.Column("acknowledged_by", sa.String(128), nullable=True),
        sa.Column("acknowledged_s", sa.Float, nullable=True),
        sa.Column("count", sa.Integer, nullable=False),
        sa.Column("last_time_s", sa.Float, nullable=True),
        sa.Column("shelved", sa.Boolean, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_alarms"),
    )
    op.create_index("ix_alarms_time", "alarms", ["time_s", "id"])
    op.create_index("ix_alarms_rig", "alarms", ["rig", "time_s", "id"])
    op.create_index("ix_alarms_severity", "alarms", ["severity", "time_s", "id"])
    op.create_index("ix_alarms_code", "alarms", ["code", "time_s", "id"])
    op.create_table(
        "shelves",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("rig", sa.String(64), nullable=False),
        sa.Column("code", sa.String(64), nullable=False),
        sa.Column("frame", sa.String(16), nullable=True),
        sa.Column("since_s", sa.Float, nullable=False),
        sa.Column("until_s", sa.Float, nullable=False),
        sa.Column("by", sa.String(128), nullable=False),
        sa.Column("reason", sa.String, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_shelves"),
    )
    op.create_index("ix_shelves_rig", "shelves", ["rig"])
    op.drop_index("ix_audit_rig", "audit")
    op.create_index("ix_audit_rig", "audit", ["rig", "id"])


def downgrade() -> None:
    op.drop_index("ix_audit_rig", "audit")
    op.create_index("ix_audit_rig", "audit", ["rig"])
    op.drop_table("shelves")
    op.drop_table("alarms")
