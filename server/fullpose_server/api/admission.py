"""Who may ask for what: every request and WebSocket passes here before its body is read or its route is known.

A person shows a token (`Authorization: Bearer`) or a browser's session (a cookie: HttpOnly, SameSite=Strict). A cookie
is sent by the browser whoever makes it ask, so with one only a page of this server may change anything or open a
WebSocket: what changes something shows its origin, which `origin.OriginGuard` has compared with the server's own.
"""

import asyncio
import time
from collections.abc import Awaitable
from contextlib import suppress

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fullpose_server.api.access import needed
from fullpose_server.api.close_codes import FORBIDDEN, UNKNOWN
from fullpose_server.api.origin import SAFE, is_stop
from fullpose_server.api.people import People
from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.people.admitted import STOPS_AFTER_S, Credential, shown_by
from fullpose_server.people.roles import Role

_END_S = 2.0  # for a WebSocket's own end


class Admission:
    """ASGI middleware; the app keeps its `People` in `app.state.people`. It leaves `scope["state"]["person"]`."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let it through, or answer 401 or 403 (a WebSocket is closed before it is accepted)."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        people: People = scope["app"].state.people
        try:
            person = admit(people, scope)
        except ApiError as error:
            await _refuse(error, scope, receive, send)
            return
        scope.setdefault("state", {})["person"] = person
        if person is None or scope["type"] == "http":
            await self._app(scope, receive, send)
        else:
            gone = people.ends_with(person.id, needed(scope) or Role.VIEWER)
            try:
                await _until(gone, self._app(scope, receive, sending := _Ending(send)), sending)
            finally:
                people.forget(gone)


def admit(people: People, scope: Scope) -> Credential | None:
    """Who asks; None: nobody known, and nobody need be. Raises `ApiError`."""
    if not people.admitted.people:
        return None
    headers = Headers(scope=scope)
    shown = shown_by(headers.get("authorization"), headers.get("cookie"))
    person = people.admitted.find(shown, time.time() - (STOPS_AFTER_S if is_stop(scope) else 0.0))
    role = needed(scope)
    if role is None:
        return person
    if person is None:
        told = "sign in first" if shown is None else "this token or session is not known, or has ended: sign in again"
        raise ApiError(401, "sign-in", f"{told}, or show a token: Authorization: Bearer ...")
    if person.session and "origin" not in headers and (scope["type"] == "websocket" or scope["method"] not in SAFE):
        raise ApiError(403, "origin", "a session's cookie changes nothing without an Origin: programs show a token")
    if not person.role.may(role):
        raise forbidden(person, role)
    return person


def forbidden(person: Credential, role: Role) -> ApiError:
    """403 for a person whose role is not enough."""
    return ApiError(403, "role", f"{person.who} is {person.role} here: this needs {role}")


class _Ending:
    """Sends until it has ended."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self._ended = False

    async def __call__(self, message: Message) -> None:
        if self._ended:
            return
        self._ended = message["type"] == "websocket.close"
        await self._send(message)

    async def end(self, code: int, reason: str) -> None:
        """Close it, whatever the route is doing."""
        if not self._ended:
            self._ended = True
            await self._send({"type": "websocket.close", "code": code, "reason": reason})


async def _until(gone: asyncio.Event, served: Awaitable[None], sending: _Ending) -> None:
    """Serve a WebSocket until it ends, or its person is let in no longer.

    Nothing that it sends is taken from then on, though it reads nothing and its end cannot be told.
    """
    serving, waiting = asyncio.ensure_future(served), asyncio.create_task(gone.wait())
    try:
        await asyncio.wait((serving, waiting), return_when=asyncio.FIRST_COMPLETED)
        if not serving.done():
            serving.cancel()
            with suppress(TimeoutError):
                async with asyncio.timeout(_END_S):
                    await sending.end(UNKNOWN, "this token or session has ended, or may this no longer: sign in again")
    finally:
        for task in (serving, waiting):
            task.cancel()
        with suppress(asyncio.CancelledError):
            await waiting
    with suppress(asyncio.CancelledError):
        await serving


async def _refuse(error: ApiError, scope: Scope, receive: Receive, send: Send) -> None:
    status = error.problem.status
    if scope["type"] == "websocket":
        code = UNKNOWN if status == 401 else FORBIDDEN
        await send({"type": "websocket.close", "code": code, "reason": error.problem.detail[:120]})
        return
    told = {"WWW-Authenticate": 'Bearer realm="fullpose"'} if status == 401 else {}
    await problem_response(error.problem, headers=told)(scope, receive, send)
