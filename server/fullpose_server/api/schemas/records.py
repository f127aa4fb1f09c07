"""What happened, on the wire: runs, audit, and the server's own health."""

from datetime import datetime
from typing import Any, Literal

from pydantic import Field

from fullpose_server.api.schemas.base import Wire
from fullpose_server.api.schemas.labels import LabelledOut
from fullpose_server.api.schemas.session import AlarmOut, RigHealth
from fullpose_server.planning.runner import RunnerStatus
from fullpose_server.session.run_end import RunEnd
from fullpose_server.session.states import State


class RunOut(LabelledOut):
    """A recorded run; errors are those of the flight itself, running or held, leads left out."""

    id: str
    rig: str
    end: RunEnd | None = Field(
        description="How it ended; null: not known (a record that was cut off, or of an earlier version), or not yet"
    )
    end_code: str | None = Field(description="Of the alarm that ended it, where one did")
    incident: str | None = Field(
        description="Null: a run. Else no flight: what was kept around a fault while no run was recorded, and the code"
        " of its alarm"
    )
    error: str | None = Field(description="Why the record cannot be read: then nothing but its name is known")
    plan_id: str | None
    plan_hash: str | None
    who: str
    started_at: datetime | None
    ended_at: datetime | None
    duration_s: float | None
    samples: int | None = Field(description="Null, like all that follows from them, while the run is being written")
    lost_samples: int | None = Field(description="Sequence numbers that are missing, from its beginning to its end")
    bytes: int
    pinned: bool = Field(description="It stays, whatever its age, and cannot be deleted")
    complete: bool = Field(description="False while it is being written, or where it was cut off or is damaged")
    max_solve_error_deg: float | None
    max_tracking_error_deg: float | None
    max_lateness_us: float | None


class AuditOut(Wire):
    """One command, accepted or refused, or another change: of a flight, plan, comparison or record."""

    id: int
    at: datetime
    who: str
    address: str | None = Field(description="Where it came from, as the server sees it; null: not known")
    rig: str | None = Field(
        description="Null: it is no rig's, but about people, or a flight, plan, comparison or record"
    )
    command: str = Field(description="Of a session; or what was done else, as method and path")
    args: dict[str, Any]
    lease_epoch: int | None
    lease_sequence: int | None
    state_before: State | None = Field(description="Null: of no session")
    state_after: State | None
    accepted: bool
    detail: str | None
    previous: str = Field(description="The hash of the line before; of the first, zeros")
    hash: str = Field(description="sha-256 of this line and of `previous`: `fullpose audit verify` proves them")


class AlarmRecordOut(AlarmOut):
    """An alarm of the history; `number` is its process's count, `id` its own over all restarts."""

    id: str
    rig: str
    standing: bool = Field(description="Whether it stands now")


class ServerLimits(Wire):
    max_upload_bytes: int
    max_solve_samples: int


class DiskOut(Wire):
    """The data folder's disk."""

    free_bytes: int
    alarm_bytes: int = Field(description="Less than that free: health is degraded")


class HealthOut(Wire):
    """`status` is degraded where a rig process, a recorder or the planner does not answer, a rig file is none, the disk
    is nearly full, or something stored was damaged."""

    status: Literal["ok", "degraded"]
    version: str
    server_time: float
    uptime_s: float
    authenticated: bool = Field(description="Whether one must sign in; else anyone who reaches the port may command")
    planner: RunnerStatus
    limits: ServerLimits
    disk: DiskOut
    rigs: dict[str, RigHealth]
    warnings: list[str]


class VersionOut(Wire):
    """What runs here."""

    version: str
    api: str = Field(description="Where the API is")
    python: str
    database_revision: str = Field(description="A database of a newer revision is not opened")
