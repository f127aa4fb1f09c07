"""The session on the wire: commands as a tagged union, the snapshot.

Its words are the session's own (`session.states`, `session.alarms`): the models are made from them.
"""

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, Union

from pydantic import Field, create_model, model_validator

from fullpose_server.api.schemas.base import Four, FrameName, Number, Options, Ordinal, Wire, Word, check_one
from fullpose_server.api.schemas.lease import LeaseOut, LeaseToken
from fullpose_server.session.alarms import MAX_SHELF_S, Severity
from fullpose_server.session.states import Command, State
from fullpose_server.session.warning_codes import WarningCode


class NoArgs(Wire):
    """A command without arguments."""


class LiveLoad(Wire):
    """How a live source is flown: a step method that keeps the limits, and its options."""

    method: Word = "exact"
    options: Options = Field(default={})
    first_sample_s: Number = Field(default=5.0, gt=0.0, le=60.0, description="How long go_live waits for the source")
    udp_from: str | None = Field(
        default=None,
        pattern=r"^[0-9.]{7,15}:[0-9]{1,5}$",
        description="Address and port, 127.0.0.1:7461, that the source sends from by UDP; null: it has the key",
    )


class LoadArgs(Wire):
    """A plan, or a live source."""

    plan: Word | None = Field(default=None, description="Id of a flyable plan of this rig")
    live: LiveLoad | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        check_one(self, "plan", "live", "one of plan and live")
        return self


class ArmArgs(Wire):
    """The pair that the caller means to arm; refused where another one is loaded."""

    plan_hash: Word | None = None
    rig_hash: Word | None = None


class MoveArgs(Wire):
    target_deg: Four


class JogArgs(Wire):
    """One step of one frame, from where the rig is commanded to be."""

    frame: FrameName
    step_deg: Number


class AcknowledgeArgs(Wire):
    numbers: list[Ordinal] | None = Field(default=None, max_length=256, description="Of alarms; null: all that stand")


class ShelfArgs(Wire):
    """The warning that is kept out of sight, for a time that ends. Nothing that brakes a rig can be shelved."""

    code: WarningCode
    frame: FrameName | None = Field(default=None, description="null: of every frame")
    minutes: Number = Field(gt=0.0, le=MAX_SHELF_S / 60.0, description="How long; then it stands again when it returns")
    reason: str = Field(default="", max_length=200)


class UnshelveArgs(Wire):
    """Which shelf is taken away."""

    code: Annotated[str, Field(min_length=1, max_length=64)]
    frame: FrameName | None = None


class CommandBody(Wire):
    """What every command has: its word, its arguments, the lease."""

    lease: LeaseToken | None = None
    command: Command
    args: Wire


# The commands whose arguments are not empty; the second: whether they may be left out.
_ARGS: dict[Command, tuple[type[Wire], bool]] = {
    Command.LOAD: (LoadArgs, False),
    Command.ARM: (ArmArgs, True),
    Command.MOVE: (MoveArgs, False),
    Command.JOG: (JogArgs, False),
    Command.ACKNOWLEDGE: (AcknowledgeArgs, True),
    Command.SHELVE: (ShelfArgs, False),
    Command.UNSHELVE: (UnshelveArgs, False),
}


def _model(word: Command) -> type[CommandBody]:
    """The body of one command, called as the session calls it: go_live is GoLive."""
    args, optional = _ARGS.get(word, (NoArgs, True))
    fields: dict[str, Any] = {
        "command": (Literal[word.value], ...),
        "args": (args, args() if optional else ...),
    }
    return create_model(word.value.title().replace("_", ""), __base__=CommandBody, **fields)


COMMANDS = {word: _model(word) for word in Command}
if TYPE_CHECKING:  # a union made from a table is none to a type checker
    CommandIn = CommandBody
else:
    CommandIn = Annotated[Union[tuple(COMMANDS.values())], Field(discriminator="command")]  # noqa: UP007


class CommandOut(Wire):
    """A command that was accepted: what the session was and is."""

    command: str
    state_before: State
    state_after: State
    revision: int
    stop_category: Literal[1, 2] | None = Field(
        default=None,
        description="Of stop and estop, IEC 60204-1: 1, stopped under control, then power off; 2, power stays on. "
        "No safety function",
    )
    unknown: str | None = Field(
        default=None,
        description="Of stop and estop, with 202: the order was given, and this is not known of what came of it",
    )


class CommandDone(CommandOut):
    """A command that was accepted, and what it gave."""

    live_key: str | None = Field(
        default=None,
        repr=False,
        description="Of load with live: what the source proves itself by, told here once; a later load gives another",
    )


class PlanRef(Wire):
    """The plan, or the live source, bound by load."""

    plan_id: str
    plan_hash: str
    rig_hash: str
    live: bool
    name: str
    duration_s: float | None


class AlarmOut(Wire):
    """A fault or warning, with its evidence; `value` and `limit` are in `unit`. `first` of a chain is its cause."""

    number: int
    code: str
    severity: Severity
    message: str
    time_s: float = Field(description="Seconds since 1970, of the first occurrence")
    frame: FrameName | None = None
    value: float | None = None
    limit: float | None = None
    unit: str | None = None
    first: bool = False
    acknowledged_by: str | None = None
    acknowledged_s: float | None = Field(default=None, description="Seconds since 1970, of that")
    count: int = 1
    last_time_s: float | None = Field(
        default=None, description="Of the newest occurrence, where there was more than one"
    )
    shelved: bool = Field(default=False, description="It was raised while shelved: it never stood")


class ShelfOut(Wire):
    """A warning that is kept out of sight: it is in the history, and does not stand."""

    code: str
    frame: FrameName | None
    since_s: float = Field(description="Seconds since 1970")
    until_s: float = Field(description="Seconds since 1970; then it stands again when it returns")
    by: str
    reason: str


class RecorderOut(Wire):
    """The recorder process of a rig."""

    alive: bool
    run: str = Field(description="Id of the run being written, or empty")
    lost: int = Field(description="Samples that never reached the record")
    lag: int = Field(description="Samples between the loop and the recorder")
    bytes_written: int
    free_bytes: int
    error: str


class DriveTimes(Wire):
    """How long the drive's calls take: smoothed, and the longest since its process began."""

    read_us: float
    read_max_us: float
    write_us: float
    write_max_us: float
    hangs: str | None = Field(description="The call that has not returned, while the loop does not respond")


class LiveOut(Wire):
    """The live source that is loaded."""

    rate_hz: float = Field(description="Samples taken in the last second or so")
    age_ms: float | None = Field(
        description="How far the attitude flown lies beyond the newest sample; negative: known ahead; null: not heard"
    )
    accepted: int
    dropped: int = Field(description="Late, doubled or overtaken: not used")
    bad: int = Field(description="No samples at all")
    clock_steps: int = Field(description="How often the source's clock began anew")
    implausible: int = Field(description="Beyond a plausible body rate: not used")
    unproven: int = Field(description="Not of the source that was loaded: not used")
    way_age_ms: float | None = Field(description="Since the preview's planner was heard; null: no such method")


class RigHealth(Wire):
    """How the rig process does; lateness over its whole life, by percentile."""

    realtime: str = Field(description="Scheduling in words: real-time, or what is missing")
    rate_hz: float
    lateness_us: dict[str, float]
    busy_us: float
    ticks: int
    deadline_misses: int
    rig_alive: bool
    rig_pid: int | None
    heartbeat_age_s: float | None
    recorder: RecorderOut | None
    drive: DriveTimes | None = None
    live: LiveOut | None = None


class SessionOut(Wire):
    """All an operator must know: state, what is allowed, who holds the lease, the plan, the alarms, health, pose."""

    rig: str
    state: State
    revision: int
    allowed: list[str]
    lease: LeaseOut
    plan: PlanRef | None
    alarms: list[AlarmOut] = Field(description="Those that stand")
    history: list[AlarmOut]
    shelves: list[ShelfOut] = Field(default=[], description="Warnings that are kept out of sight for a time")
    run_id: str | None
    drive: str | None
    health: RigHealth
    pose_deg: Four | None
