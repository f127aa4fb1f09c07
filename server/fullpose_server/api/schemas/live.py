"""Messages of the WebSocket /rigs/{rig}/live, both ways, tagged by `type`.

A sample may also come as a binary message of 80 bytes, and is then answered by one of 104: the datagrams of UDP
(docs/guide/live.md). Several may come in one message.
"""

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fullpose_server.api.schemas.base import Four, Number, Problem, Three, Wire, check_one
from fullpose_server.api.schemas.lease import LeaseToken, Secret
from fullpose_server.api.schemas.session import LiveLoad
from fullpose_server.runtime.live.packets import LiveStatus
from fullpose_server.session.states import State

STATUS_NAMES = {int(status): str(status.name).lower() for status in LiveStatus}
if TYPE_CHECKING:
    SampleStatus = str
else:
    SampleStatus = Literal[*STATUS_NAMES.values()]


class OpenLive(LiveLoad):
    """First message of the client. With `lease` it loads the live source; with `key` somebody else has loaded it.

    The key is what that load was answered (`live_key`). `convention` is of JSON samples: nue (yaw, pitch, roll) or ned
    (heading, pitch, bank).
    """

    type: Literal["open"]
    convention: Literal["nue", "ned"] = "nue"
    lease: LeaseToken | None = None
    key: Secret | None = Field(default=None, repr=False)

    @model_validator(mode="after")
    def _one_proof(self) -> Self:
        check_one(self, "lease", "key", "one proof: the lease, or the key of the source that was loaded")
        return self


class LiveSampleIn(Wire):
    """One attitude: `q` (w, x, y, z) or `euler_deg`, as the convention says; body rates where the source has them."""

    type: Literal["sample"]
    time_s: Number = Field(description="The source's clock, rising")
    q: Four | None = None
    euler_deg: Three | None = None
    body_rate_deg_s: Three | None = None

    @model_validator(mode="after")
    def _one_attitude(self) -> Self:
        check_one(self, "q", "euler_deg", "one attitude: q or euler_deg")
        return self


LiveIn = Annotated[OpenLive | LiveSampleIn, Field(discriminator="type")]


class LiveOpened(Wire):
    """The answer to open. What comes next is the session's: arm, go_live."""

    type: Literal["opened"] = "opened"
    rig: str
    state: State
    rate_hz: float
    loaded: bool = Field(description="Whether the session has a live source loaded")


class SampleRefused(Wire):
    """Why a sample was not used: its `value` is beyond the `limit`, both in `unit`."""

    code: Literal["implausible_rate"]
    value: float | None = Field(description="The body rate, as the sample says or as it takes; null: no number")
    limit: float
    unit: Literal["deg/s"]


class LiveReplyOut(Wire):
    """What became of a sample; null is not a number: nothing is followed.

    `error_deg`: angles commanded in the tick that took the sample, against the attitude flown then; `lag_deg`: against
    this very sample; `margin`: smallest relative distance to a limit; `latency_us`: in the rig process;
    `server_latency_us`: from the message's arrival at the server to this answer.
    """

    type: Literal["reply"] = "reply"
    sequence: int = Field(description="Counts the samples of this client, from 0")
    time_s: float
    status: list[SampleStatus]
    angles_deg: list[float]
    error_deg: float | None
    lag_deg: float | None
    margin: float | None
    latency_us: float
    server_latency_us: float | None
    refused: SampleRefused | None


class LiveProblem(Wire):
    """A message that was not used; the connection goes on, but where the rig process is gone."""

    type: Literal["problem"] = "problem"
    problem: Problem
