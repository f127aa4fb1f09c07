"""People, tokens and signing in, on the wire."""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from fullpose_server.api.schemas.base import CLIENT_NAME, Number, Truth, Wire
from fullpose_server.people.passwords import LONGEST
from fullpose_server.people.roles import Role

if TYPE_CHECKING:
    RoleName = Role
else:
    RoleName = Literal[*Role]
UserName = Annotated[str, Field(pattern=CLIENT_NAME)]
Password = Annotated[str, Field(max_length=LONGEST)]


class PersonOut(Wire):
    """Who is signed in, and by what."""

    name: str
    role: RoleName
    via: Literal["session", "token"]
    until: datetime | None = Field(description="When the session or token ends by itself")


class MeOut(Wire):
    """What a console asks first."""

    people: bool = Field(description="Whether one must sign in: people are configured")
    person: PersonOut | None = Field(description="Null: nobody known")
    provider: str | None = Field(description="What the provider is called that one can sign in at as well")


class LoginIn(Wire):
    name: str = Field(max_length=64)
    password: Password = Field(repr=False)


class PasswordIn(Wire):
    """One's own password, changed: every other session of the person ends."""

    current: Password = Field(repr=False)
    new: Password = Field(repr=False)
    revoke_tokens: Truth = Field(default=False, description="Also every token, but one that asks for it")


class UserOut(Wire):
    name: str
    role: RoleName
    disabled: bool = Field(description="Nothing of theirs is let in; all of it is again once they are enabled")
    password: bool = Field(description="Whether they have one here")
    created: datetime


class UserIn(Wire):
    name: UserName
    role: RoleName
    password: Password | None = Field(
        default=None, repr=False, description="Without: they sign in at the provider, or by token"
    )


class UserChange(Wire):
    """What is left out stays."""

    role: RoleName | None = None
    disabled: Truth | None = None
    password: Password | None = Field(
        default=None, repr=False, description="With another one their sessions end, but one that asks for it"
    )
    revoke_tokens: Truth | None = Field(default=None, description="Every token of theirs, but one that asks for it")


class TokenIn(Wire):
    label: str = Field(min_length=1, max_length=200, description="What it is for")
    role: RoleName | None = Field(default=None, description="Less than the person's; null: what the person is")
    days: Annotated[Number, Field(gt=0.0, le=3650.0)] | None = Field(default=None, description="Null: until revoked")


class TokenOut(Wire):
    id: str
    user: str
    role: RoleName | None = Field(description="Null: what the person is")
    label: str
    created: datetime
    until: datetime | None


class TokenGiven(TokenOut):
    """A new token. `secret` is told here once, and nowhere else."""

    secret: str = Field(repr=False)


class AliveOut(Wire):
    """The server answers; how it does is in /health, for those who are signed in."""

    status: Literal["ok", "degraded"]
    dead: list[Literal["planner", "rig", "recorder"]] = Field(
        description="What of the server's own processes does not live; `status` may be degraded for other reasons too"
    )
