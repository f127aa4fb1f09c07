"""People: who they are and what they may do. For admins; the first one is made on the command line."""

import asyncio
from datetime import UTC, datetime

from fastapi import APIRouter, Request

from fullpose_server.api.changing_people import REFUSED, changed, signed_in
from fullpose_server.api.commanding import audit_of_people
from fullpose_server.api.deps import PersonDep, Services, ServicesDep, address_of
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.people import UserChange, UserIn, UserOut
from fullpose_server.people.roles import Role
from fullpose_server.store.tables import UserRow

router = APIRouter(prefix="/users", tags=["people"], responses=REFUSED)


@router.get("")
async def list_users(services: ServicesDep) -> list[UserOut]:
    """Everybody, by name."""
    return [_out(row) for row in await asyncio.to_thread(services.people.store.all)]


@router.post("", status_code=201)
async def add_user(request: Request, services: ServicesDep, person: PersonDep, body: UserIn) -> UserOut:
    """A new person."""
    admin = signed_in(person)
    store = services.people.store
    async with services.hashing:
        await changed(services, lambda: store.add(body.name, Role(body.role), body.password))
    audit_of_people(services, admin.who, "user add", address_of(request), about=f"{body.name}: {body.role}")
    return await _found(services, body.name)


@router.put("/{name}")
async def change_user(
    request: Request, services: ServicesDep, person: PersonDep, name: str, body: UserChange
) -> UserOut:
    """Another role, another password, shut out or let in again: in force at once, on open connections too."""
    admin = signed_in(person)
    store = services.people.store
    role = None if body.role is None else Role(body.role)

    def change() -> None:
        store.change(
            name,
            role=role,
            disabled=body.disabled,
            password=body.password,
            keep=admin.id,
            revoke_tokens=bool(body.revoke_tokens),
        )

    async with services.hashing:
        await changed(services, change)
    told = body.model_dump(exclude_none=True, exclude={"password", "revoke_tokens"})
    told |= {"password": "another"} if body.password else {}
    told |= {"tokens": "revoked"} if body.revoke_tokens else {}
    about = f"{name}: {', '.join(f'{key} {value}' for key, value in told.items()) or 'nothing'}"
    audit_of_people(services, admin.who, "user change", address_of(request), about=about)
    return await _found(services, name)


async def _found(services: Services, name: str) -> UserOut:
    row = await asyncio.to_thread(services.people.store.get, name)
    if row is None:
        raise ApiError(404, "not-found", f"no user named {name!r}")
    return _out(row)


def _out(row: UserRow) -> UserOut:
    return UserOut(
        name=row.name,
        role=Role(row.role),
        disabled=row.disabled,
        password=row.password is not None,
        created=datetime.fromtimestamp(row.created, UTC),
    )
