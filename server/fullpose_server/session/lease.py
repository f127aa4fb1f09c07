"""The lease: who may command. Pure; every method is told the time [s, monotonic].

One operator holds it, others watch. Every change of hands gives a new epoch; inside an epoch each command carries a
sequence higher than the last. So a command that was delayed, doubled or sent by a former holder is known as such, down
to the drive.
"""

from dataclasses import dataclass, replace

from fullpose_server.session.errors import LeaseError

LEASE_NEEDED = "this command needs the lease: take it first"


@dataclass(frozen=True)
class LeaseToken:
    """What a command shows: the epoch it was given, and a sequence that only grows."""

    epoch: int
    sequence: int


@dataclass(frozen=True)
class Lease:
    """Who holds command. `expires_s` is the time left before the holder counts as silent; None when nobody holds it."""

    holder: str | None
    epoch: int
    expires_s: float | None
    sequence: int = 0
    requested_by: tuple[str, ...] = ()


@dataclass(frozen=True)
class LeaseBook:
    """The lease's memory. Immutable: every method returns the next one or raises `LeaseError`."""

    silent_s: float
    holder: str | None = None
    epoch: int = 0
    sequence: int = 0
    heard: float = 0.0  # when the holder was last heard, or when the lease was given up
    requested_by: tuple[str, ...] = ()

    def view(self, now: float) -> Lease:
        """What others may see."""
        left = None if self.holder is None else max(0.0, self.heard + self.silent_s - now)
        return Lease(self.holder, self.epoch, left, self.sequence, self.requested_by)

    def silence(self, now: float) -> float:
        """How long nobody who holds the lease has been heard [s]."""
        return max(0.0, now - self.heard)

    def take(self, who: str, now: float, *, force: bool = False) -> "LeaseBook":
        """`who` becomes the holder. From another holder only when that one is silent, or by `force` (audited)."""
        if self.holder == who:
            return replace(self, heard=now)
        if self.holder is not None and self.silence(now) <= self.silent_s and not force:
            raise LeaseError("lease_held", f"{self.holder} holds the lease: request it, or take it over by force")
        return self._to(who, now)

    def release(self, who: str, now: float) -> "LeaseBook":
        """The holder gives the lease up."""
        self._must_hold(who)
        return replace(self, holder=None, epoch=self.epoch + 1, sequence=0, heard=now)

    def renew(self, who: str, now: float) -> "LeaseBook":
        """The holder is still there."""
        self._must_hold(who)
        return replace(self, heard=now)

    def request(self, who: str) -> "LeaseBook":
        """`who` asks the holder for the lease."""
        if self.holder is None:
            raise LeaseError("lease_free", "nobody holds the lease: take it")
        if who == self.holder or who in self.requested_by:
            return self
        return replace(self, requested_by=(*self.requested_by, who)[-8:])

    def grant(self, who: str, now: float, to: str | None = None) -> "LeaseBook":
        """The holder hands the lease to who asked first, or to `to` among those who asked."""
        self._must_hold(who)
        if not self.requested_by:
            raise LeaseError("lease_not_requested", "nobody has asked for the lease")
        chosen = to or self.requested_by[0]
        if chosen not in self.requested_by:
            raise LeaseError("lease_not_requested", f"{chosen} has not asked for the lease")
        return self._to(chosen, now)

    def checked(self, who: str, token: LeaseToken | None, now: float) -> "LeaseBook":
        """The book after a command of `who` under `token`; raises where the command is not the holder's newest."""
        if token is None or self.holder is None:
            raise LeaseError("lease_needed", LEASE_NEEDED)
        if token.epoch != self.epoch or who != self.holder:
            raise LeaseError("lease_lost", f"the lease is {self.holder}'s in epoch {self.epoch}, not {token.epoch}")
        if token.sequence <= self.sequence:
            raise LeaseError(
                "stale_command", f"sequence {token.sequence} is not above {self.sequence}: doubled or late"
            )
        return replace(self, sequence=token.sequence, heard=now)

    def _must_hold(self, who: str) -> None:
        if self.holder != who:
            raise LeaseError("lease_lost", f"the lease is {self.holder or 'nobody'}'s, not {who}'s")

    def _to(self, who: str, now: float) -> "LeaseBook":
        asked = tuple(name for name in self.requested_by if name != who)
        return LeaseBook(self.silent_s, who, self.epoch + 1, 0, now, asked)
