"""The lease: who may command. Pure; every method is told the time [s, monotonic].

One operator holds it, others watch. Holding is knowing its secret: name, epoch and sequence are public. The book knows
proofs alone (`proof_of` a secret); whoever calls it makes the secrets, and shows them to nobody but whom they are for.
Every change of hands gives a new epoch and another secret; inside an epoch each command carries a sequence higher than
the last. So a command that was delayed, doubled or sent by a former holder is known as such, down to the drive.
"""

import hmac
from dataclasses import dataclass, field, replace
from enum import StrEnum

from fullpose_server.session.errors import LeaseError

LEASE_NEEDED = "this command needs the lease: take it first"
_ASKING = 8  # at most; of more the first goes


class LeaseAction(StrEnum):
    """What may be done about the lease."""

    TAKE = "take"  # when free or silent
    TAKEOVER = "takeover"  # by force
    REQUEST = "request"  # ask the holder for it
    GRANT = "grant"  # hand it to who asked
    RENEW = "renew"
    RELEASE = "release"


GIVES_SECRET = frozenset({LeaseAction.TAKE, LeaseAction.TAKEOVER, LeaseAction.REQUEST})


@dataclass(frozen=True)
class LeaseToken:
    """What a command shows: the proof of the secret, the epoch it was given, and a sequence that only grows."""

    epoch: int
    sequence: int
    proof: str = field(repr=False)


@dataclass(frozen=True)
class Lease:
    """Who holds command. `expires_s` is the time left before the holder counts as silent; None when nobody holds it."""

    holder: str | None
    epoch: int
    expires_s: float | None
    sequence: int = 0
    requested_by: tuple[str, ...] = ()


@dataclass(frozen=True)
class Asked:
    """Who asked for the lease, and the proof of the secret that is the lease's once it is granted to them."""

    who: str
    proof: str = field(repr=False)


@dataclass(frozen=True)
class LeaseBook:
    """The lease's memory. Immutable: every method returns the next one or raises `LeaseError`."""

    silent_s: float
    holder: str | None = None
    epoch: int = 0
    sequence: int = 0
    heard: float = 0.0  # when the holder was last heard, or when the lease was given up
    asked: tuple[Asked, ...] = ()
    proof: str = field(default="", repr=False)
    lapsed: bool = False  # nobody holds it since its holder may command no longer

    def view(self, now: float) -> Lease:
        """What others may see."""
        left = None if self.holder is None else max(0.0, self.heard + self.silent_s - now)
        return Lease(self.holder, self.epoch, left, self.sequence, tuple(each.who for each in self.asked))

    def silence(self, now: float) -> float:
        """How long nobody who holds the lease has been heard [s]."""
        return max(0.0, now - self.heard)

    def take(self, who: str, proof: str, now: float, *, force: bool = False) -> "LeaseBook":
        """`who` becomes the holder. From another holder only when that one is silent, or by `force` (audited)."""
        if self.holder is not None and self.silence(now) <= self.silent_s and not force:
            raise LeaseError("lease_held", f"{self.holder} holds the lease: request it, or take it over by force")
        return self._to(Asked(who, proof), now)

    def release(self, proof: str | None, now: float) -> "LeaseBook":
        """The holder gives the lease up."""
        self._must_hold(proof)
        return replace(self, holder=None, epoch=self.epoch + 1, sequence=0, heard=now, proof="")

    def lapse(self, holder: str, now: float) -> "LeaseBook":
        """`holder` may command no longer: as if unheard for `silent_s` now. No change where it is another's by now."""
        if self.holder != holder:
            return self
        asked = tuple(each for each in self.asked if each.who != holder)
        heard = min(self.heard, now - self.silent_s)
        return LeaseBook(self.silent_s, None, self.epoch + 1, 0, heard, asked, lapsed=True)

    def renew(self, proof: str | None, now: float) -> "LeaseBook":
        """The holder is still there."""
        self._must_hold(proof)
        return replace(self, heard=now)

    def request(self, who: str, proof: str) -> "LeaseBook":
        """`who` asks the holder for the lease. Who asks again, as one whose answer was lost, asks by the new secret."""
        if self.holder is None:
            raise LeaseError("lease_free", "nobody holds the lease: take it")
        asked = Asked(who, proof)
        if who in (each.who for each in self.asked):
            return replace(self, asked=tuple(asked if each.who == who else each for each in self.asked))
        return replace(self, asked=(*self.asked, asked)[-_ASKING:])

    def grant(self, proof: str | None, now: float, to: str | None = None) -> "LeaseBook":
        """The holder hands the lease to who asked first, or to `to` among those who asked."""
        self._must_hold(proof)
        if not self.asked:
            raise LeaseError("lease_not_requested", "nobody has asked for the lease")
        chosen = self.asked[0] if to is None else next((each for each in self.asked if each.who == to), None)
        if chosen is None:
            raise LeaseError("lease_not_requested", f"{to} has not asked for the lease")
        return self._to(chosen, now)

    def checked(self, token: LeaseToken | None, now: float) -> "LeaseBook":
        """The book after a command under `token`; raises where the command is not the holder's newest."""
        if token is None:
            raise LeaseError("lease_needed", LEASE_NEEDED)
        self._must_hold(token.proof)
        if token.epoch != self.epoch:
            raise LeaseError("lease_lost", f"the lease is in epoch {self.epoch}, not {token.epoch}")
        if token.sequence <= self.sequence:
            raise LeaseError(
                "stale_command", f"sequence {token.sequence} is not above {self.sequence}: doubled or late"
            )
        return replace(self, sequence=token.sequence, heard=now)

    def _must_hold(self, proof: str | None) -> None:
        if proof is None or self.holder is None:
            raise LeaseError("lease_needed", LEASE_NEEDED)
        if not hmac.compare_digest(proof.encode(), self.proof.encode()):
            raise LeaseError(
                "lease_lost", f"the lease is {self.holder}'s in epoch {self.epoch}, and this is not its secret"
            )

    def _to(self, to: Asked, now: float) -> "LeaseBook":
        asked = tuple(each for each in self.asked if each.who != to.who)
        return LeaseBook(self.silent_s, to.who, self.epoch + 1, 0, now, asked, to.proof)
