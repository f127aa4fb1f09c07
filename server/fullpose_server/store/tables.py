"""The tables. Times are UTC seconds since 1970; documents that are only handed on are JSON."""

from typing import Any

from sqlalchemy import JSON, BigInteger, Float, ForeignKey, Index, Integer, MetaData, String
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column
from sqlalchemy.types import TypeEngine

# Names for constraints, so that a later migration can speak of them.
NAMING = {
    "ix": "ix_%(table_name)s_%(column_0_name)s",
    "pk": "pk_%(table_name)s",
    "fk": "fk_%(table_name)s_%(column_0_name)s",
    "uq": "uq_%(table_name)s_%(column_0_name)s",
}
NUL, SHOWN = "\0", "\N{SYMBOL FOR NULL}"  # the one is written as the other: PostgreSQL's text has no NUL
# What is longer, or larger, than was thought of is kept all the same: SQLite minds neither, PostgreSQL both.
NUMBER = Integer().with_variant(BigInteger(), "postgresql")


def text_of(length: int) -> TypeEngine[str]:
    """Text of about so many characters."""
    return String(length).with_variant(String(), "postgresql")


class Table(DeclarativeBase):
    """Root of the tables."""

    metadata = MetaData(naming_convention=NAMING)
    type_annotation_map = {dict[str, Any]: JSON, list[Any]: JSON}  # noqa: RUF012 - SQLAlchemy reads it from the class


class TrajectoryRow(Table):
    """A stored flight; its arrays are in trajectories/<sha256>/."""

    __tablename__ = "trajectories"
    __table_args__ = (Index("ix_trajectories_created", "created", "sha256"),)

    sha256: Mapped[str] = mapped_column(text_of(64), primary_key=True)
    source_sha256: Mapped[str] = mapped_column(text_of(64))
    name: Mapped[str] = mapped_column(text_of(200))
    convention: Mapped[str] = mapped_column(text_of(8))
    source_format: Mapped[str] = mapped_column(text_of(8))
    source_bytes: Mapped[int] = mapped_column(NUMBER)
    samples: Mapped[int] = mapped_column(NUMBER)
    start_s: Mapped[float] = mapped_column(Float)
    duration_s: Mapped[float] = mapped_column(Float)
    rate_hz: Mapped[float | None] = mapped_column(Float)
    uniform: Mapped[bool]
    peak_body_rate_deg_s: Mapped[float | None] = mapped_column(Float)
    warnings: Mapped[list[Any]]
    input: Mapped[dict[str, Any] | None]  # what was taken of the file; None: stored before it was kept
    created: Mapped[float] = mapped_column(Float)
    tags: Mapped[list[Any]]
    notes: Mapped[str]
    search: Mapped[str]  # `formats.labels.search_text` of its name, notes and tags


class DataFolderRow(Table):
    """The one data folder that a PostgreSQL belongs to (`store.belonging`)."""

    __tablename__ = "data_folder"

    id: Mapped[str] = mapped_column(String, primary_key=True)


class PlanRow(Table):
    """A plan and its job; its arrays are in plans/<id>/."""

    __tablename__ = "plans"
    __table_args__ = (
        Index("ix_plans_status", "status"),
        Index("ix_plans_created", "created", "id"),
        Index("ix_plans_rig", "rig", "created", "id"),
        Index("ix_plans_trajectory", "trajectory", "created", "id"),
    )

    id: Mapped[str] = mapped_column(text_of(32), primary_key=True)
    trajectory: Mapped[str] = mapped_column(ForeignKey("trajectories.sha256"))
    rig: Mapped[str] = mapped_column(text_of(64))
    rig_hash: Mapped[str] = mapped_column(text_of(64))
    method: Mapped[str] = mapped_column(text_of(64))
    options: Mapped[dict[str, Any]]
    start_deg: Mapped[list[Any] | None]
    tolerance_deg: Mapped[float | None] = mapped_column(Float)  # by which the attitude may differ from the flight's
    remedy: Mapped[dict[str, Any] | None]  # of (a plan), kind, frame, limit: what is asked for
    rate_hz: Mapped[float] = mapped_column(Float)
    status: Mapped[str] = mapped_column(text_of(16))
    error: Mapped[dict[str, Any] | None]
    result: Mapped[dict[str, Any] | None]
    created: Mapped[float] = mapped_column(Float)
    started: Mapped[float | None] = mapped_column(Float)
    finished: Mapped[float | None] = mapped_column(Float)
    tags: Mapped[list[Any]]
    notes: Mapped[str]
    search: Mapped[str]  # of its rig, method, notes and tags; its flight has its own


class AuditRow(Table):
    """One command, accepted or refused, or another change; each row after the one before (`store.hash_chain`)."""

    __tablename__ = "audit"
    __table_args__ = (Index("ix_audit_rig", "rig", "id"), Index("ix_audit_previous", "previous", unique=True))

    id: Mapped[int] = mapped_column(NUMBER, primary_key=True, autoincrement=True)
    at: Mapped[float] = mapped_column(Float)
    who: Mapped[str] = mapped_column(text_of(128))
    rig: Mapped[str] = mapped_column(text_of(64))
    command: Mapped[str] = mapped_column(text_of(32))
    args: Mapped[dict[str, Any]]
    lease_epoch: Mapped[int | None] = mapped_column(NUMBER)
    lease_sequence: Mapped[int | None] = mapped_column(NUMBER)
    state_before: Mapped[str] = mapped_column(text_of(16))
    state_after: Mapped[str] = mapped_column(text_of(16))
    accepted: Mapped[bool]
    detail: Mapped[str | None]
    address: Mapped[str | None] = mapped_column(text_of(64))
    previous: Mapped[str] = mapped_column(text_of(64))
    hash: Mapped[str] = mapped_column(text_of(64))


class AlarmRow(Table):
    """An alarm of a rig, as `session.alarms.Alarm` has it; `id` is its own over restarts of the rig's process."""

    __tablename__ = "alarms"
    __table_args__ = (
        Index("ix_alarms_time", "time_s", "id"),
        Index("ix_alarms_rig", "rig", "time_s", "id"),
        Index("ix_alarms_severity", "severity", "time_s", "id"),
        Index("ix_alarms_code", "code", "time_s", "id"),
    )

    id: Mapped[str] = mapped_column(text_of(64), primary_key=True)
    rig: Mapped[str] = mapped_column(text_of(64))
    number: Mapped[int] = mapped_column(NUMBER)
    code: Mapped[str] = mapped_column(text_of(64))
    severity: Mapped[str] = mapped_column(text_of(16))
    message: Mapped[str] = mapped_column(String)
    time_s: Mapped[float] = mapped_column(Float)
    frame: Mapped[str | None] = mapped_column(text_of(16))
    value: Mapped[float | None] = mapped_column(Float)
    limit: Mapped[float | None] = mapped_column(Float)
    unit: Mapped[str | None] = mapped_column(text_of(16))
    first: Mapped[bool]
    acknowledged_by: Mapped[str | None] = mapped_column(text_of(128))
    acknowledged_s: Mapped[float | None] = mapped_column(Float)
    count: Mapped[int] = mapped_column(NUMBER)
    last_time_s: Mapped[float | None] = mapped_column(Float)
    shelved: Mapped[bool]


class ShelfRow(Table):
    """A shelf of a rig, as `session.alarms.Shelf` has it: for the next process of the rig."""

    __tablename__ = "shelves"
    __table_args__ = (Index("ix_shelves_rig", "rig"),)

    id: Mapped[int] = mapped_column(NUMBER, primary_key=True, autoincrement=True)
    rig: Mapped[str] = mapped_column(text_of(64))
    code: Mapped[str] = mapped_column(text_of(64))
    frame: Mapped[str | None] = mapped_column(text_of(16))
    since_s: Mapped[float] = mapped_column(Float)
    until_s: Mapped[float] = mapped_column(Float)
    by: Mapped[str] = mapped_column(text_of(128))
    reason: Mapped[str] = mapped_column(String)


class UserRow(Table):
    """A person. `changed` grows with every change to people or credentials, of both tables together."""

    __tablename__ = "users"
    __table_args__ = (
        Index("ix_users_changed", "changed"),
        Index("ix_users_subject", "subject", unique=True),
    )

    name: Mapped[str] = mapped_column(text_of(64), primary_key=True)
    role: Mapped[str] = mapped_column(text_of(16))
    password: Mapped[str | None] = mapped_column(String)  # its hash; None: they sign in elsewhere, or by token
    subject: Mapped[str | None] = mapped_column(String)  # who they are to the provider that they sign in at
    disabled: Mapped[bool]
    created: Mapped[float] = mapped_column(Float)
    changed: Mapped[int] = mapped_column(NUMBER)


class CredentialRow(Table):
    """A token, or a browser's session; `proof` is what is kept of its secret. Without `role` it has the person's."""

    __tablename__ = "credentials"
    __table_args__ = (
        Index("ix_credentials_changed", "changed"),
        Index("ix_credentials_proof", "proof", unique=True),
        Index("ix_credentials_user", "user", "created"),
    )

    id: Mapped[str] = mapped_column(text_of(32), primary_key=True)
    proof: Mapped[str] = mapped_column(text_of(64))
    user: Mapped[str] = mapped_column(ForeignKey("users.name"))
    role: Mapped[str | None] = mapped_column(text_of(16))
    session: Mapped[bool]
    label: Mapped[str] = mapped_column(text_of(200))
    address: Mapped[str | None] = mapped_column(text_of(64))
    created: Mapped[float] = mapped_column(Float)
    until: Mapped[float | None] = mapped_column(Float)
    revoked: Mapped[float | None] = mapped_column(Float)
    changed: Mapped[int] = mapped_column(NUMBER)
