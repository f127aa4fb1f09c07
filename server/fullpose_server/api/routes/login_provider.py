"""Signing in at a provider: a browser is sent there, and comes back signed in, or to a page that says why not."""

import asyncio
import html
from typing import Annotated, Any

from fastapi import APIRouter, Cookie, Header, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from fullpose_server.api.commanding import audit_of_people
from fullpose_server.api.deps import Services, ServicesDep, address_of
from fullpose_server.api.paths import API
from fullpose_server.api.problems import ApiError
from fullpose_server.api.provider import PENDING_S, Provider
from fullpose_server.api.routes.login import sign_in
from fullpose_server.api.stopping import is_name
from fullpose_server.store.people import PersonError

PATH = "/login/provider"
COOKIE = "fullpose_leaving"
_ONLY_TEXT = "default-src 'none'; style-src 'unsafe-inline'"
_HTML: dict[str, Any] = {"content": {"text/html": {}}}  # it is a browser that is told
NONE: dict[int | str, dict[str, Any]] = {404: {"description": "No provider is set"}}
REFUSED: dict[int | str, dict[str, Any]] = {
    401: {"description": "The provider did not sign them in, or this was not begun here"} | _HTML,
    403: {"description": "Nobody that may sign in here"} | _HTML,
    409: {"description": "Their name is another person's here"} | _HTML,
    502: {"description": "The provider does not answer, or its answer does not hold"} | _HTML,
}
router = APIRouter(prefix=PATH, tags=["people"], responses=NONE)
_PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><meta name="color-scheme" content="dark light">
<title>Fullpose: not signed in</title>
<body style="font:16px/1.5 system-ui;max-width:36em;margin:4em auto;padding:0 1em">
<h1>Not signed in</h1><p>{why}</p><p><a href="/">Back</a></p>
"""


@router.get(
    "",
    status_code=303,
    response_class=RedirectResponse,
    responses={502: {"description": "The provider does not answer"}},
)
async def leave(request: Request, services: ServicesDep) -> Response:
    """Send a browser to the provider."""
    leaving = await _provider(services).leave(_back(request))
    response = RedirectResponse(leaving.address, 303)
    # Lax: it must come along when the provider sends the browser back.
    response.set_cookie(
        COOKIE,
        leaving.secret,
        max_age=int(PENDING_S),
        path=f"{API}{PATH}",
        httponly=True,
        samesite="lax",
        secure=request.url.scheme == "https",
    )
    return response


@router.get("/answer", status_code=303, response_class=RedirectResponse, responses=REFUSED)
async def arrive(
    request: Request,
    services: ServicesDep,
    fullpose_leaving: Annotated[str | None, Cookie(include_in_schema=False)] = None,
    user_agent: Annotated[str, Header(include_in_schema=False)] = "",
) -> Response:
    """A browser that the provider sent back: signed in, and at the console."""
    provider = _provider(services)
    try:
        arrived = await provider.arrive(fullpose_leaving, dict(request.query_params))
        if not is_name(arrived.name):
            told = f"{arrived.name[:80]!r} cannot be a name here: expected up to 64 letters, digits or . @ : + - _"
            raise ApiError(403, "name", told)
        try:
            row = await asyncio.to_thread(services.people.store.sign_in_from, *arrived)
        except PersonError as error:
            raise ApiError(409, "person", f"{arrived.name} cannot sign in: {error}") from None
        if row.disabled:
            raise ApiError(403, "login", f"{row.name} is let in no longer")
    except ApiError as error:
        if error.problem.status in (403, 409):  # whom the provider knows; of strangers' guesses there is no end
            audit_of_people(services, "nobody", "login", address_of(request), refused=error.problem.detail)
        page = _PAGE.format(why=html.escape(error.problem.detail))
        return HTMLResponse(page, error.problem.status, {"Content-Security-Policy": _ONLY_TEXT})
    response = RedirectResponse("/", 303)
    response.delete_cookie(COOKIE, path=f"{API}{PATH}")
    await sign_in(services, request, response, row.name, user_agent)
    return response


def _provider(services: Services) -> Provider:
    if services.provider is None:
        raise ApiError(404, "no-provider", "people sign in here by name and password: oidc_issuer is not set")
    return services.provider


def _back(request: Request) -> str:
    """Where the provider sends the browser: here, under the name that the browser knows us by."""
    return f"{request.url.scheme}://{request.url.netloc}{API}{PATH}/answer"
