"""Which pages a browser may let talk to this server: its own, and those named in the settings.

Every WebSocket and every request that changes something must come from an allowed origin, or from no page at all (no
Origin header: a program). A browser is also kept from being led here under a foreign name (DNS rebinding): a name must
be this machine's own or in the settings. An address cannot be rebound: any is taken where the network may come.
A stop is refused to nobody: whoever sends it, the rig is safer for it (decision 0023).
"""

import ipaddress
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from fullpose_server.api.close_codes import FORBIDDEN
from fullpose_server.api.paths import API, STOP_CHANNEL, of_rig
from fullpose_server.api.problems import ApiError, problem_response
from fullpose_server.session.states import NEEDS_NO_LEASE
from fullpose_server.settings import Settings, is_loopback

SAFE = frozenset({"GET", "HEAD", "OPTIONS"})


class OriginGuard:
    """ASGI middleware."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let it through, or answer 403 (a WebSocket is closed before it is accepted)."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        reason = None if is_stop(scope) else self._refuse(scope)
        if reason is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": FORBIDDEN, "reason": reason[:120]})
        else:
            await problem_response(ApiError(403, "origin", reason).problem)(scope, receive, send)

    def _refuse(self, scope: Scope) -> str | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._host_allowed(host):
            return f"host {host[:80]!r} is not this server: name it in allowed_hosts"
        origin = headers.get("origin")
        if origin is None or (scope["type"] == "http" and scope["method"] in SAFE):
            return None
        if origin in self._settings.allowed_origins or _netloc(origin) == host:
            return None
        return f"origin {origin[:80]!r} may not use this server: name it in allowed_origins"

    def _host_allowed(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:  # brackets that do not pair
            return False
        if is_loopback(name) or (_is_address(name) and not self._settings.loopback):
            return True
        return name in {known.lower() for known in (self._settings.host, *self._settings.allowed_hosts)}


def is_stop(scope: Scope) -> bool:
    """Whether it asks for a stop by its path."""
    path = str(scope["path"])
    if scope["type"] == "websocket":
        return path == f"{API}{STOP_CHANNEL}"
    target = of_rig(path) if scope["method"] == "POST" else None
    return target is not None and target[1] in NEEDS_NO_LEASE


def _netloc(origin: str) -> str | None:
    try:
        return urlsplit(origin).netloc
    except ValueError:  # brackets that do not pair
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
