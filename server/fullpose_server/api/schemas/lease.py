"""The lease on the wire: what is asked about it, who holds it, and the secret that proves it (`session.lease`)."""

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fullpose_server.api.schemas.base import Ordinal, Wire
from fullpose_server.people.admitted import Credential
from fullpose_server.secret import proof_of
from fullpose_server.session.lease import GIVES_SECRET, LeaseAction
from fullpose_server.session.lease import LeaseToken as Token

Secret = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,128}$")]
if TYPE_CHECKING:
    ActionName = LeaseAction
else:
    ActionName = Literal[*LeaseAction]


class LeaseToken(Wire):
    """Proof of holding the lease: its secret, its epoch, and a sequence that grows with every command."""

    epoch: Ordinal
    sequence: Ordinal
    secret: Secret = Field(repr=False)

    def shown(self, person: Credential | None) -> Token:
        """What the session is shown of it, where `person` shows it."""
        return Token(self.epoch, self.sequence, proof_by(self.secret, person))


def proof_by(secret: str, person: Credential | None) -> str:
    """The proof of a lease's secret: the secret alone where nobody signs in, else it is its person's too.

    One that got into other hands proves nothing there.
    """
    return proof_of(secret if person is None else f"{person.who}\n{secret}")


class LeaseIn(Wire):
    """take: when free or silent; takeover: by force, audited; request: ask the holder. Each answers a secret.

    Under the lease's secret: renew; grant: hand over to who asked; release: give it up.
    """

    action: ActionName = LeaseAction.TAKE
    secret: Secret | None = Field(default=None, repr=False, description="The lease's; with renew, grant and release")
    to: str | None = Field(
        default=None, max_length=128, description="With grant: who of those who asked; null: the first"
    )
    reason: str | None = Field(
        default=None, max_length=500, description="With takeover: why, for the audit. Needed where people sign in"
    )

    @model_validator(mode="after")
    def _its_secret(self) -> Self:
        if (self.secret is None) != (self.action in GIVES_SECRET):
            words = ", ".join(sorted(set(LeaseAction) - GIVES_SECRET))
            raise ValueError(f"expected the lease's secret with {words}, and with nothing else")
        return self


class LeaseOut(Wire):
    """Who may command. `epoch` grows with every new holder; each command's sequence must be above `sequence`."""

    holder: str | None
    epoch: int
    sequence: int
    expires_s: float | None = Field(description="Until the holder counts as silent: the rig holds, stops, disarms")
    requested_by: list[str]


class LeaseGiven(LeaseOut):
    """The lease after an action. `secret` is the caller's alone: it is told here once, and nowhere else."""

    secret: str | None = Field(
        default=None,
        repr=False,
        description="With take and takeover: the lease's. With request: the lease's once it is granted to the caller",
    )
