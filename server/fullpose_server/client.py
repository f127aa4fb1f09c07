"""A client of the API: what a program does from outside, the demo included. Degrees and seconds, as on the wire."""

import asyncio
import base64
import json
import ssl
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from fullpose_server.processes import START_S

API = "/api/v1"
POLL_S = 0.1


class ClientError(Exception):
    """The server refused, or does not answer. `problem` is its problem document, empty where it sent none."""

    def __init__(self, message: str, status: int | None = None, problem: dict[str, Any] | None = None) -> None:
        super().__init__(message)
        self.status = status
        self.problem = problem or {}


@dataclass
class _Lease:
    """The lease of one rig, as this client knows it: its secret, its epoch, and the sequence of the last command."""

    epoch: int = 0
    sequence: int = 0
    secret: str | None = None
    requested: str | None = None  # the secret that is the lease's once it is granted to us

    def next(self) -> dict[str, Any] | None:
        """What the next command shows; None where there was never a lease."""
        if self.secret is None:
            return None
        self.sequence += 1
        return {"epoch": self.epoch, "sequence": self.sequence, "secret": self.secret}


class Client:
    """One server, one operator. Use `async with`; raises `ClientError` from every call.

    A proxy's name and password may be in the address, `https://name:password@host`; they are in no message.
    `token`: of a server with users (`fullpose token create`); its person is who commands then.
    `tls`: whom an https server is to be known by; by default the system's authorities (or those of SSL_CERT_FILE).
    """

    def __init__(
        self,
        url: str,
        name: str = "python",
        timeout_s: float = 30.0,
        token: str | None = None,
        tls: ssl.SSLContext | None = None,
    ) -> None:
        address = httpx.URL(url)
        self.url = str(address.copy_with(userinfo=b"")).rstrip("/")
        self.name = name
        self._headers = {"X-Fullpose-Client": name} | _authorization(address)
        self._leases: dict[str, _Lease] = {}  # by rig: each rig has epochs of its own
        self._live_keys: dict[str, str] = {}  # of the live sources that were loaded last, by rig
        if token is not None:
            self._headers["Authorization"] = f"Bearer {token}"
        tls = tls or ssl.create_default_context()
        self._tls = tls if self.url.startswith("https:") else None  # of the WebSockets, which have none without it
        self._http = httpx.AsyncClient(
            base_url=self.url + API, headers=self._headers, timeout=timeout_s, trust_env=False, verify=tls
        )

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._http.aclose()

    async def health(self) -> dict[str, Any]:
        """How the server does."""
        return await self._object("GET", "/health")

    async def rigs(self) -> list[dict[str, Any]]:
        """All rigs."""
        return await self._array("GET", "/rigs")

    async def upload(self, file: Path, convention: str = "", name: str = "", **how: str | bool) -> dict[str, Any]:
        """Upload a flight; returns it as stored. how: other fields of the form, `profile` or `bridge_gaps`."""
        fields = {key: value for key, value in {"convention": convention, "name": name, **how}.items() if value}
        content = await asyncio.to_thread(file.read_bytes)
        return await self._object("POST", "/trajectories", data=fields, files={"file": (file.name, content)})

    async def plan(
        self,
        trajectory: str,
        rig: str,
        method: str = "plan",
        options: dict[str, Any] | None = None,
        start_deg: list[float] | None = None,
        tolerance_deg: float | None = None,
    ) -> dict[str, Any]:
        """Ask for a plan and wait until its job has ended; look at `status` and `flyable`."""
        body: dict[str, Any] = {"trajectory": trajectory, "rig": rig, "method": method, "options": options or {}}
        body |= {"start_deg": start_deg, "tolerance_deg": tolerance_deg}
        made = await self._object("POST", "/plans", json=body)
        while made["status"] in ("queued", "running"):
            await asyncio.sleep(POLL_S)
            made = await self._object("GET", f"/plans/{made['id']}")
        return made

    async def plans(self, trajectory: str | None = None, rig: str | None = None) -> list[dict[str, Any]]:
        """All plans, newest first."""
        wanted = {"trajectory": trajectory, "rig": rig}
        return await self._array("GET", "/plans", params={k: v for k, v in wanted.items() if v is not None})

    async def runs(self, rig: str | None = None) -> list[dict[str, Any]]:
        """All recorded runs, newest first."""
        return await self._array("GET", "/runs", params={} if rig is None else {"rig": rig})

    async def delete_run(self, run: str) -> None:
        """Remove a run that is neither pinned nor being written."""
        await self._call("DELETE", f"/runs/{quote(run)}")

    async def pin_run(self, run: str, *, pinned: bool = True) -> None:
        """Keep a run whatever its age, or no longer."""
        await self._call("PUT" if pinned else "DELETE", f"/runs/{quote(run)}/pin")

    async def alarms(self, **wanted: Any) -> list[dict[str, Any]]:
        """The alarm history, newest first; `rig`, `severity`, `code`, `standing`, `to` as GET /alarms has them."""
        return await self._array("GET", "/alarms", params=wanted)

    async def session(self, rig: str) -> dict[str, Any]:
        """The session as of now."""
        return await self._object("GET", f"/rigs/{quote(rig)}/session")

    async def take_lease(self, rig: str, action: str = "take", reason: str | None = None) -> dict[str, Any]:
        """Take (or takeover, for a `reason`; request, renew, grant) the lease; commands carry it from here on.

        To take what is ours already renews it. One that was requested is ours once `wait_lease` has returned.
        """
        lease = self._lease(rig)
        if action == "take" and lease.secret is not None:
            try:
                return await self.take_lease(rig, "renew")
            except ClientError as error:
                if error.status != 403:
                    raise
        body = {"action": action} if action in ("take", "takeover", "request") else self._proving(rig, action)
        if reason is not None:
            body["reason"] = reason
        # What answers a secret tells it once: it is waited for though the rig's process has to start before.
        held = await self._object("POST", f"/rigs/{quote(rig)}/lease", json=body, timeout=START_S)
        given = held.pop("secret", None)
        if action == "request":
            lease.requested = given
        elif given is not None:
            self._leases[rig] = _Lease(held["epoch"], held["sequence"], given)
        return held

    async def wait_lease(self, rig: str) -> dict[str, Any]:
        """Wait until the lease that was requested is granted; returns the session then."""

        def granted(session: dict[str, Any]) -> bool:
            lease = session["lease"]
            return lease["holder"] == self.name and self.name not in lease["requested_by"]

        session = await self._wait(rig, granted)
        held, lease = session["lease"], self._lease(rig)
        self._leases[rig] = _Lease(held["epoch"], held["sequence"], lease.requested)
        return session

    async def release_lease(self, rig: str) -> dict[str, Any]:
        """Give the lease up."""
        held = await self._object("POST", f"/rigs/{quote(rig)}/lease", json=self._proving(rig, "release"))
        self._leases.pop(rig, None)
        return held

    async def command(self, rig: str, command: str, **args: Any) -> dict[str, Any]:
        """Command the session under the lease."""
        body = {"command": command, "args": args, "lease": self._lease(rig).next()}
        done = await self._object("POST", f"/rigs/{quote(rig)}/commands", json=body)
        if done.get("live_key") is not None:
            self._live_keys[rig] = done["live_key"]
        return done

    async def stop(self, rig: str) -> dict[str, Any]:
        """Brake inside the limits; needs no lease."""
        return await self._object("POST", f"/rigs/{quote(rig)}/stop")

    async def estop(self, rig: str) -> dict[str, Any]:
        """Brake as fast as the limits allow; needs no lease."""
        return await self._object("POST", f"/rigs/{quote(rig)}/estop")

    async def wait_state(self, rig: str, *states: str) -> dict[str, Any]:
        """Follow the session until it is in one of `states`; returns it then."""
        return await self._wait(rig, lambda session: session["state"] in states)

    async def _wait(self, rig: str, there: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        async with self.stream(rig, topics=["session"]) as socket:
            async for text in socket:
                session: dict[str, Any] | None = json.loads(text).get("session")
                if session is not None and there(session):
                    return session
        raise ClientError(f"the stream of {rig} ended before the session was as awaited")

    @asynccontextmanager
    async def stream(self, rig: str, **subscription: Any) -> AsyncIterator[ClientConnection]:
        """The rig's stream, subscribed; the first message is the server's hello."""
        url = f"ws{self.url.removeprefix('http')}{API}/rigs/{quote(rig)}/stream"
        try:
            async with connect(
                url, proxy=None, additional_headers=self._headers, max_size=None, ssl=self._tls
            ) as socket:
                await socket.send(json.dumps({"type": "subscribe"} | subscription))
                yield socket
        except (ConnectionClosed, InvalidHandshake, OSError) as error:
            raise ClientError(f"the stream of {rig} at {self.url} broke off: {error}") from error

    @asynccontextmanager
    async def live(self, rig: str, *, load: bool = True, **settings: Any) -> AsyncIterator[ClientConnection]:
        """The rig's live source: opened, and with `load` loaded under the lease (`method`, `options`, `convention`).

        Without `load`, `key` is what who loaded it was answered, `live_key`; by default what this client was answered.
        Send samples, receive replies (docs/guide/live.md). The rig stops where the connection ends while it is live.
        """
        message: dict[str, Any] = {"type": "open"} | settings
        if load:
            message["lease"] = self._lease(rig).next()
        else:
            message.setdefault("key", self._live_keys.get(rig))
        url = f"ws{self.url.removeprefix('http')}{API}/rigs/{quote(rig)}/live"
        try:
            async with connect(
                url, proxy=None, additional_headers=self._headers, compression=None, ssl=self._tls
            ) as socket:
                await socket.send(json.dumps(message))
                opened = json.loads(await socket.recv())
                if opened["type"] != "opened":
                    raise ClientError(opened["problem"]["detail"], opened["problem"]["status"], opened["problem"])
                yield socket
        except (ConnectionClosed, InvalidHandshake, OSError) as error:
            raise ClientError(f"the live source of {rig} at {self.url} broke off: {error}") from error

    def _proving(self, rig: str, action: str) -> dict[str, Any]:
        """The body of an action under the lease."""
        secret = self._lease(rig).secret
        if secret is None:
            raise ClientError(f"{action}: this client does not hold the lease of {rig}")
        return {"action": action, "secret": secret}

    def _lease(self, rig: str) -> "_Lease":
        return self._leases.setdefault(rig, _Lease())

    async def _object(self, method: str, path: str, **content: Any) -> dict[str, Any]:
        answer: dict[str, Any] = await self._call(method, path, **content)
        return answer

    async def _array(self, method: str, path: str, **content: Any) -> list[dict[str, Any]]:
        """All pages of a list."""
        response = await self._answer(method, path, **content)
        rows: list[dict[str, Any]] = response.json()
        while (following := response.links.get("next")) is not None:
            response = await self._answer(method, self.url + following["url"])
            rows += response.json()
        return rows

    async def _call(self, method: str, path: str, **content: Any) -> Any:
        response = await self._answer(method, path, **content)
        return response.json() if response.content else None

    async def _answer(self, method: str, path: str, **content: Any) -> httpx.Response:
        try:
            response = await self._http.request(method, path, **content)
        except httpx.HTTPError as error:
            raise ClientError(f"{self.url} does not answer: {str(error) or type(error).__name__}") from error
        if response.is_success:
            return response
        try:
            problem = response.json()
        except ValueError:
            problem = {}
        raise ClientError(problem.get("detail") or response.reason_phrase, response.status_code, problem)


def _authorization(address: httpx.URL) -> dict[str, str]:
    """The header for what the address names; by hand, for WebSockets take it from an address undecoded."""
    if not address.userinfo:
        return {}
    credentials = f"{address.username}:{address.password}".encode()
    return {"Authorization": f"Basic {base64.b64encode(credentials).decode()}"}
