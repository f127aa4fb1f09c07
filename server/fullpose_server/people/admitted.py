"""Who is let in: the credentials that hold, as the server knows them and as it tells the stop gate.

A secret is kept nowhere: what is known of it is its sha-256, for a secret is 256 random bits. Passwords are another
matter (`passwords`).
"""

from collections.abc import Iterable
from typing import NamedTuple

import msgspec

from fullpose_server.people.roles import Role
from fullpose_server.secret import proof_of

COOKIE = "fullpose_session"
TOKEN_PREFIX = "fp_"  # so that a token that was left in a file is known for one
# So long after a session or token has run out it still stops a rig: its person stands beside it, and a clock that is
# set forward runs out everybody's. One that was revoked does not.
STOPS_AFTER_S = 86400.0
_BEARER = "bearer "
_LONGEST = 512


class Credential(msgspec.Struct, frozen=True):
    """A token or a browser's session: whose it is, and until when it holds [s since 1970]."""

    id: str
    proof: str
    who: str
    role: Role
    until: float | None
    session: bool  # of a browser: it comes in a cookie


class Shown(NamedTuple):
    """A secret as a request shows it."""

    secret: str
    cookie: bool


class Admitted:
    """The credentials that hold. Where there are no people, whoever reaches the server is let in."""

    def __init__(
        self, people: bool, credentials: Iterable[Credential] = (), commanders: frozenset[str] | None = None
    ) -> None:
        """`commanders`: who may command, signed in or not; None where that is not known, or nobody need sign in."""
        self.people = people
        self.commanders = commanders
        self._by_proof = {each.proof: each for each in credentials}
        self._ids = {each.id: each for each in self._by_proof.values()}

    def all(self) -> list[Credential]:
        """Every one of them."""
        return list(self._by_proof.values())

    def find(self, shown: Shown | None, now: float) -> Credential | None:
        """Whose secret it is, where it holds at `now` [s since 1970]. A cookie is a session's, a token never."""
        if shown is None:
            return None
        found = self._by_proof.get(proof_of(shown.secret))
        if found is None or found.session != shown.cookie:
            return None
        return found if holds(found, now) else None

    def still(self, credential: str, role: Role, now: float) -> bool:
        """Whether the credential of this id holds, and may what needs `role`."""
        found = self._ids.get(credential)
        return found is not None and holds(found, now) and found.role.may(role)


def holds(credential: Credential, now: float) -> bool:
    """Whether it has not run out."""
    return credential.until is None or now < credential.until


def shown_by(authorization: str | None, cookie: str | None) -> Shown | None:
    """The secret in the headers of a request: a bearer token, else the session's cookie. Never one in an address."""
    if authorization is not None:
        if authorization[: len(_BEARER)].lower() != _BEARER:
            return None  # a way to sign in that there is not is none, though a cookie came with it
        return Shown(authorization[len(_BEARER) :].strip()[:_LONGEST], cookie=False)
    if cookie is None:
        return None
    # Not by http.cookies, which finds none where one of another program on this host is not as it expects.
    named = (each.partition("=") for each in cookie.split(";"))
    found = [value.strip().strip('"') for name, _, value in named if name.strip() == COOKIE]
    return Shown(found[-1][:_LONGEST], cookie=True) if found else None
