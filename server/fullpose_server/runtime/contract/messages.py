"""What server and rig process say to each other, and what the server tells the rest. JSON, one message a packet."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import msgspec

from fullpose_server.session.alarms import Alarm, Shelf
from fullpose_server.session.lease import Lease, LeaseToken

MAX_REQUEST = 1 << 16  # [bytes] what the rig process reads of a packet; of a longer one it would see a part
INTERNAL_ERROR = "internal_error"  # code of the alarm with which a loop that failed ends


class Op(StrEnum):
    """What a request is about."""

    COMMAND = "command"  # of the session
    LEASE = "lease"
    LAPSE = "lapse"  # of the lease of `who`, who may command no longer
    LIVE = "live"  # whether its key is that of the live source that is loaded
    EXIT = "exit"


@dataclass(frozen=True)
class Request:
    """Server to rig, numbered by who sends it. Fields that do not belong to `op` stay at their defaults."""

    id: int
    op: Op
    who: str
    command: str = ""
    args: dict[str, Any] = field(default_factory=dict)
    lease: LeaseToken | None = None
    action: str = ""
    to: str | None = None
    proof: str | None = field(default=None, repr=False)  # of the lease's secret, or of the one that the action gives
    key: str | None = field(default=None, repr=False)  # of the live source: that `load` gives, or `live` shows

    @property
    def word(self) -> str:
        """What is asked, for people."""
        return self.command or self.action or self.op


@dataclass(frozen=True)
class ErrorBody:
    """A refusal, for people and machines."""

    code: str
    message: str
    state: str
    command: str
    allowed: list[str]


@dataclass(frozen=True)
class Reply:
    """What became of a command. `unknown`: it was given, and this is not known of what came of it."""

    ok: bool
    state_before: str
    state_after: str
    revision: int
    error: ErrorBody | None = None
    unknown: str | None = None


@dataclass(frozen=True)
class Answer:
    """Rig to server: the reply to request `id`; a lease action also carries the lease."""

    id: int
    reply: Reply
    lease: Lease | None = None


@dataclass(frozen=True)
class PlanRef:
    """The plan that is bound."""

    plan_id: str
    plan_hash: str
    rig_hash: str
    live: bool
    name: str = ""
    duration_s: float | None = None


@dataclass(frozen=True)
class LiveHealth:
    """The live source that is loaded."""

    rate_hz: float  # of samples taken, over the last second or so
    age_ms: float | None  # of the attitude flown beyond the newest sample, negative: known ahead; None: none heard
    accepted: int
    dropped: int
    bad: int
    clock_steps: int
    implausible: int
    unproven: int
    way_age_ms: float | None  # since the preview's planner was heard; None: no such method


@dataclass(frozen=True)
class Published:
    """What the loop publishes at every revision."""

    rig: str
    life: str  # of the process: each numbers its alarms from 1
    state: str
    revision: int
    allowed: list[str]
    lease: Lease
    lease_heard_ns: int  # monotonic; the lease's time left runs on from here
    lease_silent_s: float
    plan: PlanRef | None
    alarms: list[Alarm]
    history: list[Alarm]
    shelves: list[Shelf]
    realtime: str
    run_id: str | None
    drive: str
    live: LiveHealth | None = None


@dataclass(frozen=True)
class RecorderHealth:
    """The recorder, as its own header fields tell."""

    alive: bool
    run: str
    lost: int
    lag: int  # samples between the loop and the recorder
    bytes_written: int
    chunks: int
    free_bytes: int
    error: str


@dataclass(frozen=True)
class DriveHealth:
    """How long the drive's calls take [us]: smoothed, and the longest of the process's life."""

    read_us: float
    read_max_us: float
    write_us: float
    write_max_us: float
    hangs: str | None  # the call that has not returned, while the loop does not respond


@dataclass(frozen=True)
class Health:
    """How the rig process is doing. Lateness [us] over its whole life."""

    realtime: str
    rate_hz: float
    lateness_us: dict[str, float]
    busy_us: float
    ticks: int
    deadline_misses: int
    rig_alive: bool
    rig_pid: int
    heartbeat_age_s: float
    recorder: RecorderHealth
    drive: DriveHealth
    live: LiveHealth | None = None


@dataclass(frozen=True)
class Snapshot:
    """A rig's session as a whole."""

    rig: str
    life: str  # of the process
    state: str
    revision: int
    allowed: list[str]
    lease: Lease
    plan: PlanRef | None
    alarms: list[Alarm]
    history: list[Alarm]
    shelves: list[Shelf]
    run_id: str | None
    drive: str
    health: Health
    pose_deg: list[float]


encode = msgspec.json.encode
decode_request = msgspec.json.Decoder(Request).decode
decode_answer = msgspec.json.Decoder(Answer).decode
decode_published = msgspec.json.Decoder(Published).decode
