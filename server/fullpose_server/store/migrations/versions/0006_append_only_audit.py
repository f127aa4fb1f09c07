"""The audit says where from, and each row has the hash of the row before; rows can be added, and nothing else.

The rows that are there are chained as they are. The triggers refuse an accident, and a program that means no harm;
what somebody does to the file by other means, the chain shows.
"""

import json

import sqlalchemy as sa
from alembic import op

from fullpose_server.store.hash_chain import CONTENT, GENESIS, row_hash

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

TRIGGERS = {
    "audit_keeps": ("BEFORE UPDATE", ""),
    "audit_holds": ("BEFORE DELETE", ""),
    # Also where a row of the same number would be replaced, for which SQLite asks no other trigger.
    "audit_follows": (
        "BEFORE INSERT",
        "WHEN NEW.id IS NOT (SELECT coalesce(max(id), 0) + 1 FROM audit) OR NEW.previous IS NOT coalesce("
        f"(SELECT hash FROM audit ORDER BY id DESC LIMIT 1), '{GENESIS}')",
    ),
}
# The error is the one by which PostgreSQL says that a row may not be so.
REFUSAL = "RAISE EXCEPTION 'the audit is append-only' USING ERRCODE = 'integrity_constraint_violation'"
POSTGRESQL = (
    f"CREATE FUNCTION audit_refuses() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN {REFUSAL}; END $$",
    "CREATE FUNCTION audit_follows() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN"
    " IF NEW.id IS DISTINCT FROM (SELECT coalesce(max(id), 0) + 1 FROM audit)"
    " OR NEW.previous IS DISTINCT FROM coalesce("
    f"(SELECT hash FROM audit ORDER BY id DESC LIMIT 1), '{GENESIS}')"
    f" THEN {REFUSAL}; END IF; RETURN NEW; END $$",
    "CREATE TRIGGER audit_keeps BEFORE UPDATE OR DELETE OR TRUNCATE ON audit"
    " FOR EACH STATEMENT EXECUTE FUNCTION audit_refuses()",
    "CREATE TRIGGER audit_follows BEFORE INSERT ON audit FOR EACH ROW EXECUTE FUNCTION audit_follows()",
)


def upgrade() -> None:
    with op.batch_alter_table("audit") as table:
        table.add_column(sa.Column("address", sa.String(64), nullable=True))
        table.add_column(sa.Column("previous", sa.String(64), nullable=True))
        table.add_column(sa.Column("hash", sa.String(64), nullable=True))
    _link(op.get_bind())
    with op.batch_alter_table("audit") as table:
        table.alter_column("previous", existing_type=sa.String(64), nullable=False)
        table.alter_column("hash", existing_type=sa.String(64), nullable=False)
    op.create_index("ix_audit_previous", "audit", ["previous"], unique=True)
    if op.get_bind().dialect.name == "sqlite":
        for name, (when, only) in TRIGGERS.items():
            refusal = "SELECT RAISE(ABORT, 'the audit is append-only')"
            op.execute(f"CREATE TRIGGER {name} {when} ON audit {only} BEGIN {refusal}; END")
    else:
        for statement in POSTGRESQL:
            op.execute(statement)


def downgrade() -> None:
    if op.get_bind().dialect.name == "sqlite":
        for name in TRIGGERS:
            op.execute(f"DROP TRIGGER {name}")
    else:
        op.execute("DROP TRIGGER audit_keeps ON audit")
        op.execute("DROP TRIGGER audit_follows ON audit")
        op.execute("DROP FUNCTION audit_refuses()")
        op.execute("DROP FUNCTION audit_follows()")
    op.drop_index("ix_audit_previous", "audit")
    with op.batch_alter_table("audit") as table:
        for column in ("hash", "previous", "address"):
            table.drop_column(column)


def _link(connection: sa.Connection) -> None:
    """Number the rows from 1 on, without gaps, and chain them."""
    audit = sa.Table("audit", sa.MetaData(), autoload_with=connection)
    ids = list(connection.scalars(sa.select(audit.c.id).order_by(audit.c.id)))
    previous = GENESIS
    for number, old in enumerate(ids, start=1):
        row = connection.execute(sa.select(audit).where(audit.c.id == old)).mappings().one()
        args = json.loads(row["args"]) if isinstance(row["args"], str) else row["args"]
        content = {name: row[name] for name in CONTENT} | {
            "id": number,
            "args": args,
            "accepted": bool(row["accepted"]),
        }
        linked = {"id": number, "previous": previous, "hash": (previous := row_hash(content, previous))}
        connection.execute(sa.update(audit).where(audit.c.id == old).values(**linked))
