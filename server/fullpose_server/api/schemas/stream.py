"""Messages of the WebSockets /rigs/{rig}/stream and /runs/{run}/stream, both ways, tagged by `type`.

A binary telemetry frame is little-endian: magic u4 "FPT1", version u2, count u2, seq u8, server_time f8, dropped u8,
then `count` records as `hello.record` describes them.
"""

from typing import Annotated, Any, Literal

from pydantic import Field, create_model

from fullpose_server.api.schemas.base import CLIENT_NAME, Number, Ordinal, Problem, Truth, Wire
from fullpose_server.api.schemas.session import CommandOut, SessionOut
from fullpose_server.runtime.contract.telemetry import FIELDS

Topic = Literal["telemetry", "session"]
Encoding = Literal["json", "binary"]
ClientName = Annotated[str, Field(pattern=CLIENT_NAME)]


class Subscribe(Wire):
    """What the client wants; sent again, it replaces the earlier one."""

    type: Literal["subscribe"]
    topics: list[Topic] = Field(max_length=8, default=["telemetry", "session"])
    rate_hz: Number = Field(default=30.0, gt=0.0, le=1000.0, description="Frames a second, not samples")
    encoding: Encoding = "json"
    every_sample: Truth = Field(default=False, description="All samples since the last frame, else only the newest")
    since_seq: Ordinal | None = Field(default=None, description="Resume after this sample; null: from now on")


class Ping(Wire):
    type: Literal["ping"]
    t: Number


class Seek(Wire):
    """Replay only: to that time, playing or not. The newest sample there is sent at once."""

    type: Literal["seek"]
    time_s: Number = Field(ge=0.0, description="After the run's first sample")


class Speed(Wire):
    """Replay only."""

    type: Literal["speed"]
    factor: Number = Field(gt=0.0, le=100.0, description="1: as fast as it was")


class Pause(Wire):
    """Replay only."""

    type: Literal["pause"]


class Play(Wire):
    """Replay only: on from here; from the beginning where it has come to the end."""

    type: Literal["play"]


class StopNow(Wire):
    """Live only: the priority channel of stop and E-stop, as POST /rigs/{rig}/stop and /estop. No lease; at once."""

    type: Literal["stop", "estop"]
    client: ClientName | None = Field(default=None, description="As the header X-Fullpose-Client, which it replaces")


Playback = Seek | Speed | Pause | Play
StreamIn = Annotated[Subscribe | Ping | StopNow | Playback, Field(discriminator="type")]


class RecordField(Wire):
    """One field of the binary record."""

    name: str
    type: str = Field(description="NumPy type string, little-endian")
    count: int
    offset: int


class Record(Wire):
    """The binary record: its size in bytes and its fields."""

    size: int
    fields: list[RecordField]


class ReplayOf(Wire):
    """The run that is replayed."""

    run: str
    duration_s: float
    started: float | None = Field(description="Seconds since 1970, of the first sample")
    scene: str = Field(description="Where this client's scene of it is, while the WebSocket is open")


class Hello(Wire):
    """First message of the server. `replay` is null where a rig is streamed as it lives."""

    type: Literal["hello"] = "hello"
    schema_: Literal["fullpose.stream/1"] = Field(default="fullpose.stream/1", alias="schema")
    server_time: float
    rig: str
    session: SessionOut
    fields: list[str]
    record: Record
    replay: ReplayOf | None = None


class _Telemetry(Wire):
    """Samples as columns. `seq` is the newest sample's; `dropped` counts what this client has missed so far."""

    type: Literal["telemetry"] = "telemetry"
    seq: int
    server_time: float
    dropped: int


def _columns() -> dict[str, Any]:
    """A column for each field of the sample: whole numbers, or floats where null stands for what is not finite."""
    columns: dict[str, Any] = {}
    for field in FIELDS:
        value: Any = int if field.integer else float | None
        columns[field.column] = (list[list[value]] if field.parts else list[value], ...)
    return columns


Telemetry = create_model("Telemetry", __base__=_Telemetry, __doc__=_Telemetry.__doc__, **_columns())


class SessionChanged(Wire):
    type: Literal["session"] = "session"
    revision: int
    server_time: float
    session: SessionOut


class Replayed(Wire):
    """Where a replay is: the answer to seek, speed, pause and play; with the topic session also when it ends."""

    type: Literal["replay"] = "replay"
    time_s: float
    playing: bool
    factor: float


class Pong(Wire):
    type: Literal["pong"] = "pong"
    t: float
    server_time: float


class Stopped(CommandOut):
    """The answer to stop and estop: what the session was and is."""

    type: Literal["stopped"] = "stopped"


class StreamProblem(Wire):
    """A message of the client that was not understood; the stream goes on."""

    type: Literal["problem"] = "problem"
    problem: Problem


STREAM_IN = (Subscribe, Ping, StopNow, Seek, Speed, Pause, Play)
STREAM_OUT = (Hello, Telemetry, SessionChanged, Replayed, Pong, Stopped, StreamProblem)
