"""Messages of the WebSocket /stop, both ways, tagged by `type`: the channel of stop and E-stop for every rig.

It is kept open from a page's first moment on, so that a stop needs no new connection, and its round trip is known.
"""

from typing import Annotated, Literal

from pydantic import Field

from fullpose_server.api.schemas.base import Problem, Wire
from fullpose_server.api.schemas.session import CommandOut

AskNumber = Annotated[int, Field(ge=0, lt=2**53)]


class StopRig(Wire):
    """Stop or E-stop, now. Needs no lease and is never refused for a name."""

    type: Literal["stop", "estop"]
    rig: str
    client: str | None = Field(default=None, description="Who stops, as the header X-Fullpose-Client")
    id: AskNumber = Field(default=0, description="Told again in the answer")


class StopPing(Wire):
    """Answered at once: the round trip of a stop, but for the rig's own tick."""

    type: Literal["ping"]
    t: float


StopIn = Annotated[StopRig | StopPing, Field(discriminator="type")]


class RigStopped(Wire):
    """The rig brakes; where `done.unknown` says so, the order was given and that is all that is known."""

    type: Literal["stopped"] = "stopped"
    id: int
    rig: str
    done: CommandOut


class StopPong(Wire):
    type: Literal["pong"] = "pong"
    t: float
    server_time: float


class StopRefused(Wire):
    """The message was none, or the session's state knows no such command."""

    type: Literal["problem"] = "problem"
    id: int | None = None
    problem: Problem


STOP_IN = (StopRig, StopPing)
STOP_OUT = (RigStopped, StopPong, StopRefused)
