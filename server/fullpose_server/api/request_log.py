"""Every request in the log and in the metrics: what was asked, what was answered, and how long it took."""

import logging
import time
from typing import Any

from prometheus_client import CollectorRegistry, Histogram
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from fullpose_server.api.errors import METHODS

log = logging.getLogger(__name__)
BUCKETS = (0.005, 0.02, 0.1, 0.5, 2.0, 10.0)  # [s]
NOWHERE = "none"  # the route of a path that there is not; a name of its own for each would be a client's to multiply


class RequestTimes:
    """How often what was asked for, and how long it took, by method, route and status."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self._seconds = Histogram(
            "fullpose_request_seconds",
            "Time from a request's head to the end of its answer",
            ["method", "route", "status"],
            registry=self.registry,
            buckets=BUCKETS,
        )

    def count(self, method: str, route: str, status: int, seconds: float) -> None:
        """One more."""
        self._seconds.labels(method, route, str(status)).observe(seconds)


class RequestLog:
    """ASGI middleware."""

    def __init__(self, app: ASGIApp, times: RequestTimes) -> None:
        self._app = app
        self._times = times

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have it answered, and tell how."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        begun, status = time.perf_counter(), 500  # where the answer never begins

        async def watched(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self._app(scope, receive, watched)
        finally:
            self._tell(scope, status, time.perf_counter() - begun)

    def _tell(self, scope: Scope, status: int, seconds: float) -> None:
        method = scope["method"] if scope["method"] in METHODS else "other"
        self._times.count(method, _route(scope), status, seconds)
        if log.isEnabledFor(logging.INFO):
            client = (scope.get("client") or ("-",))[0]
            asked: dict[str, Any] = {"method": method, "path": scope["path"], "status": status, "client": client}
            told = "%s %r %d in %.1f ms, from %s"
            log.info(told, method, scope["path"], status, 1e3 * seconds, client, extra=asked | {"seconds": seconds})


def _route(scope: Scope) -> str:
    """The route's own path, `/api/v1/plans/{plan}`."""
    found = scope.get("route")
    return str(found.path) if found is not None else NOWHERE
