"""Messages of the WebSocket /stop, both ways, tagged by `type`: the channel of stop and E-stop for every rig.

It is kept open from a page's first moment on, so that a stop needs no new connection, and its round trip is known.
"""

from typing import Annotated, Literal

from pydantic import Field

from fullpose_server.api.schemas.base import Ordinal, Problem, Wire
from fullpose_server.api.schemas.session import CommandOut
from fullpose_server.api.schemas.stream import Ping, Pong

AskNumber = Annotated[Ordinal, Field(lt=2**53)]


class StopRig(Wire):
    """Stop or E-stop, now. Needs no lease and is never refused for a name."""

    type: Literal["stop", "estop"]
    rig: str
    client: str | None = Field(default=None, description="Who stops, as the header X-Fullpose-Client")
    id: AskNumber = Field(default=0, description="Told again in the answer")


StopIn = Annotated[StopRig | Ping, Field(discriminator="type")]


class RigStopped(Wire):
    """The rig brakes; where `done.unknown` says so, the order was given and that is all that is known."""

    type: Literal["stopped"] = "stopped"
    id: int
    rig: str
    done: CommandOut


class StopRefused(Wire):
    """The message was none, or the session's state knows no such command."""

    type: Literal["problem"] = "problem"
    id: int | None = None
    problem: Problem


STOP_IN = (StopRig, Ping)
STOP_OUT = (RigStopped, Pong, StopRefused)
