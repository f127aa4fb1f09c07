"""Tokens of the API: what programs show. Everybody makes and revokes their own; admins see and revoke all."""

import asyncio
import time
from datetime import UTC, datetime

from fastapi import APIRouter, Request

from fullpose_server.api.admission import forbidden
from fullpose_server.api.changing_people import REFUSED, changed, signed_in
from fullpose_server.api.commanding import audit_of_people
from fullpose_server.api.deps import PersonDep, ServicesDep, address_of
from fullpose_server.api.schemas.people import TokenGiven, TokenIn, TokenOut
from fullpose_server.people.admitted import Credential
from fullpose_server.people.roles import Role
from fullpose_server.store.people import Given
from fullpose_server.store.tables import CredentialRow

router = APIRouter(prefix="/tokens", tags=["people"], responses=REFUSED)


@router.get("")
async def list_tokens(services: ServicesDep, person: PersonDep) -> list[TokenOut]:
    """One's own, newest first; an admin sees everybody's."""
    rows = await asyncio.to_thread(services.people.store.tokens, _whose(signed_in(person)))
    return [_out(row) for row in rows]


@router.post("", status_code=201)
async def make_token(request: Request, services: ServicesDep, person: PersonDep, body: TokenIn) -> TokenGiven:
    """A token of one's own, of at most one's own role. One that is made by a token ends with it at the latest."""
    owner = signed_in(person)
    store = services.people.store
    given: list[Given] = []
    role = None if body.role is None else Role(body.role)
    if role is None and not owner.session:
        role = owner.role  # a token that is less than its person makes none that is more
    if role is not None and not owner.role.may(role):
        raise forbidden(owner, role)
    days = body.days
    if not owner.session and owner.until is not None:
        left = (owner.until - time.time()) / 86400.0
        days = left if days is None else min(days, left)
    await changed(services, lambda: given.append(store.make_token(owner.who, body.label, role, days)))
    made = given[0]
    audit_of_people(services, owner.who, "token create", address_of(request), about=f"{made.id}: {body.label}")
    row = next(row for row in await asyncio.to_thread(store.tokens, owner.who) if row.id == made.id)
    return TokenGiven(**_out(row).model_dump(), secret=made.secret)


@router.delete("/{token}", status_code=204)
async def revoke_token(request: Request, services: ServicesDep, person: PersonDep, token: str) -> None:
    """End a token of one's own, or as an admin anybody's: in force at once, on open connections too."""
    owner = signed_in(person)
    await changed(services, lambda: services.people.store.revoke(token, _whose(owner)))
    audit_of_people(services, owner.who, "token revoke", address_of(request), about=token)


def _whose(person: Credential) -> str | None:
    return None if person.role is Role.ADMIN else person.who


def _out(row: CredentialRow) -> TokenOut:
    return TokenOut(
        id=row.id,
        user=row.user,
        role=None if row.role is None else Role(row.role),
        label=row.label,
        created=datetime.fromtimestamp(row.created, UTC),
        until=None if row.until is None else datetime.fromtimestamp(row.until, UTC),
    )
