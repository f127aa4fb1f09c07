"""Signing in and out: by name and password, for a browser's session. Programs show a token instead."""

import asyncio
import time
from datetime import UTC, datetime
from typing import Annotated, Any

from fastapi import APIRouter, Header, Request, Response

from fullpose_server.api.changing_people import NO_PEOPLE, changed, signed_in
from fullpose_server.api.commanding import audit_of_people
from fullpose_server.api.deps import PersonDep, Services, ServicesDep, address_of
from fullpose_server.api.problems import ApiError
from fullpose_server.api.schemas.people import LoginIn, MeOut, PasswordIn, PersonOut
from fullpose_server.people.admitted import COOKIE, Credential, Shown
from fullpose_server.people.passwords import matches

router = APIRouter(tags=["people"])
UNKNOWN = "(unknown name)"  # in the audit; no name of a person has a bracket
WRONG: dict[int | str, dict[str, Any]] = {
    401: {"description": "No such name with this password"},
    409: {"description": "No users are configured"},
    429: {"description": "Too many attempts: `Retry-After` tells when to try again"},
}


@router.get("/me")
async def me(services: ServicesDep, person: PersonDep) -> MeOut:
    """Whether one must sign in here, and who one is."""
    return MeOut(people=services.people.admitted.people, person=person_out(person), provider=_provider(services))


@router.post("/login", responses=WRONG)
async def login(
    request: Request,
    response: Response,
    services: ServicesDep,
    body: LoginIn,
    user_agent: Annotated[str, Header(include_in_schema=False)] = "",
) -> MeOut:
    """Sign in: the answer sets the session's cookie. The name may be spelled in any capitals."""
    if not services.people.admitted.people:
        raise ApiError(409, "no-people", NO_PEOPLE)
    address = address_of(request) or "nowhere"
    async with services.hashing:  # what is turned away here is not counted either, or a flood would fill the memory
        _try(services, body.name, address)
        row = await asyncio.to_thread(services.people.store.get, body.name)
        right, anew = await asyncio.to_thread(matches, body.password, None if row is None else row.password)
    if row is None or not right or row.disabled:
        # People type passwords where the name goes: what is nobody's name is not written down.
        who = UNKNOWN if row is None else row.name
        audit_of_people(services, who, "login", address, refused="wrong name or password, or disabled")
        raise ApiError(401, "login", "no such name with this password")
    services.attempts.succeeded(body.name, address)
    if anew is not None:
        await asyncio.to_thread(services.people.store.rehash, row.name, anew)
    person = await sign_in(services, request, response, row.name, user_agent)
    return MeOut(people=True, person=person_out(person), provider=_provider(services))


@router.post("/logout", status_code=204)
async def logout(request: Request, services: ServicesDep, person: PersonDep) -> Response:
    """Sign out: the session ends, everywhere at once. A token is revoked elsewhere."""
    if person is not None and person.session:
        await asyncio.to_thread(services.people.store.revoke, person.id)
        await services.people.refresh()
        audit_of_people(services, person.who, "logout", address_of(request))
    response = Response(status_code=204)
    response.delete_cookie(COOKIE, path="/", httponly=True, samesite="strict", secure=request.url.scheme == "https")
    return response


@router.put("/me/password", status_code=204, responses=WRONG)
async def change_password(request: Request, services: ServicesDep, person: PersonDep, body: PasswordIn) -> None:
    """Change one's own password: every other session of one's own ends, and every other token where it is asked for."""
    person = signed_in(person)
    address = address_of(request) or "nowhere"
    _try(services, person.who, address)
    store = services.people.store
    row = await asyncio.to_thread(store.get, person.who)
    async with services.hashing:
        right, _ = await asyncio.to_thread(matches, body.current, None if row is None else row.password)
        if not right:
            raise ApiError(401, "login", "this is not the current password")
        await changed(
            services,
            lambda: store.set_password(person.who, body.new, keep=person.id, revoke_tokens=body.revoke_tokens),
        )
    services.attempts.succeeded(person.who, address)
    about = "tokens revoked" if body.revoke_tokens else None
    audit_of_people(services, person.who, "password", address, about=about)


async def sign_in(services: Services, request: Request, response: Response, name: str, label: str) -> Credential | None:
    """Open a browser's session, its cookie in the answer. None where it ended at once: the person was shut out."""
    hours = services.settings.session_hours
    address = address_of(request)
    store = services.people.store
    given = await asyncio.to_thread(store.open_session, name, hours, label[:200], address)
    await services.people.refresh()
    audit_of_people(services, name, "login", address)
    secure = request.url.scheme == "https"
    response.set_cookie(
        COOKIE, given.secret, max_age=int(3600 * hours), path="/", httponly=True, samesite="strict", secure=secure
    )
    return services.people.admitted.find(Shown(given.secret, cookie=True), time.time())


def person_out(person: Credential | None) -> PersonOut | None:
    """Who is signed in, on the wire."""
    if person is None:
        return None
    until = None if person.until is None else datetime.fromtimestamp(person.until, UTC)
    return PersonOut(name=person.who, role=person.role, via="session" if person.session else "token", until=until)


def _provider(services: Services) -> str | None:
    return None if services.provider is None else services.settings.oidc_name


def _try(services: Services, name: str, address: str) -> None:
    """Raises `ApiError` where it was tried too often. It is not audited: a stranger would fill the disk with it."""
    wait_s = services.attempts.begin(name, address)
    if wait_s > 0:
        told = f"too many attempts to sign in: try again in {wait_s} s"
        raise ApiError(429, "attempts", told, headers={"Retry-After": str(wait_s)})
