"""A real server on a loopback port, in a thread of this process."""

import asyncio
import json
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import uvicorn
from websockets.sync.client import ClientConnection

from fullpose_server.app import create_app
from fullpose_server.cli._serving import bind
from fullpose_server.settings import Settings
from tests.support.loop_watch import LoopWatch, watched_loop
from tests.support.sockets import connect
from tests.support.waiting import until

LOOP_THREAD = "live server"
FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(
    f"{k / 50},{40 * (k / 100) ** 2},{10 * (k / 100) ** 2},{-5 * (k / 100) ** 2}\n" for k in range(101)
)


class LiveServer:
    """Where the server is, and how to speak to it."""

    def __init__(self, port: int, settings: Settings) -> None:
        self.settings = settings
        self.url = f"http://127.0.0.1:{port}"
        self.ws = f"ws://127.0.0.1:{port}/api/v1"
        self.http = httpx.Client(base_url=f"{self.url}/api/v1", timeout=300.0, headers={"X-Fullpose-Client": "ann"})
        self.sequence = 0

    def upload(self, text: str | bytes = FLIGHT, file: str = "flight.csv", **fields: str) -> httpx.Response:
        return self.http.post("/trajectories", files={"file": (file, text)}, data=fields)

    def plan(self, rig: str = "vertical-4", method: str = "exact", text: str = FLIGHT) -> dict[str, Any]:
        sha256 = self.upload(text).json()["sha256"]
        made = self.http.post("/plans", json={"trajectory": sha256, "rig": rig, "method": method})
        assert made.status_code == 202, made.text
        plan: dict[str, Any] = made.json()
        while plan["status"] in ("queued", "running"):
            plan = self.http.get(f"/plans/{plan['id']}").json()
        return plan

    def stream(self, rig: str = "vertical-4", **options: Any) -> ClientConnection:
        return connect(f"{self.ws}/rigs/{rig}/stream", **options)


class Operator:
    """Commands one rig under its lease."""

    def __init__(self, server: LiveServer, rig: str = "vertical-4") -> None:
        self.server, self.rig = server, rig
        self.epoch = self.sequence = 0
        self.secret = ""

    def take(self, action: str = "takeover") -> None:
        answer = self.server.http.post(f"/rigs/{self.rig}/lease", json={"action": action})
        held = answer.raise_for_status().json()
        self.epoch, self.sequence, self.secret = held["epoch"], held["sequence"], held["secret"]

    def lease(self, action: str = "renew", **more: Any) -> httpx.Response:
        """An action under the lease."""
        body = {"action": action, "secret": self.secret, **more}
        return self.server.http.post(f"/rigs/{self.rig}/lease", json=body)

    def token(self) -> dict[str, Any]:
        """What the next command shows."""
        self.sequence += 1
        return {"epoch": self.epoch, "sequence": self.sequence, "secret": self.secret}

    def command(self, word: str, **args: Any) -> httpx.Response:
        body = {"command": word, "args": args, "lease": self.token()}
        return self.server.http.post(f"/rigs/{self.rig}/commands", json=body)

    def session(self) -> dict[str, Any]:
        answer: dict[str, Any] = self.server.http.get(f"/rigs/{self.rig}/session").json()
        return answer

    def wait(self, *states: str) -> dict[str, Any]:
        """Follow the session on the stream until it is in one of `states`, renewing the lease."""
        with self.server.stream(self.rig) as socket_:
            socket_.send(json.dumps({"type": "subscribe", "topics": ["session"]}))
            for _ in range(60):
                session = self._next(socket_)
                if session is not None and session["state"] in states:
                    return session
                self.lease()
        raise AssertionError(f"{self.session()['state']} is none of {states}")

    @staticmethod
    def _next(socket_: ClientConnection) -> dict[str, Any] | None:
        try:
            session: dict[str, Any] | None = json.loads(socket_.recv(timeout=1.0)).get("session")
        except TimeoutError:
            return None
        return session

    def to_idle(self) -> None:
        """Bring the session to idle from wherever an earlier test left it."""
        self.take()
        until(self._nearer_idle, every_s=0.1)

    def _nearer_idle(self) -> bool:
        """One step towards idle; True there. What is refused, for the rig is not at rest yet, is asked again."""
        match self.session()["state"]:
            case "idle":
                return True
            case "disconnected":
                self.command("acknowledge")  # of a process that was lost: what stands bars arming
                self.command("connect")
            case "ready":
                self.command("unload")
            case "armed":
                self.command("disarm")
            case "estopped" | "faulted":
                self.command("acknowledge")
                self.command("reset")
            case _:
                self.server.http.post(f"/rigs/{self.rig}/stop")
                self.wait("armed", "faulted", "estopped")
        return self.session()["state"] == "idle"


@contextmanager
def live_server(folder: Path, **overrides: Any) -> Iterator[LiveServer]:
    # No rig process in reserve: each server would start one more than its test has use for.
    settings = Settings(data_dir=folder, **{"spare_rig_process": False, **overrides})
    listener = bind("127.0.0.1", 0)
    with watched_loop() as watch:
        server = _Thread(settings, listener, watch)
        server.start()
        try:
            server.wait()
            live = LiveServer(listener.getsockname()[1], settings)
            with live.http:
                yield live
        finally:
            server.end()
        watch.check()


class _Thread(threading.Thread):
    def __init__(self, settings: Settings, listener: socket.socket, watch: LoopWatch) -> None:
        super().__init__(name=LOOP_THREAD)
        self._settings, self._listener, self._watch = settings, listener, watch
        self._ready = threading.Event()
        self._server: uvicorn.Server | None = None
        self._error: BaseException | None = None

    def run(self) -> None:
        try:
            asyncio.run(self._main())
        except BaseException as error:  # noqa: BLE001 - told to the test that waits
            self._error = error
        finally:
            self._ready.set()

    async def _main(self) -> None:
        app = create_app(self._settings)
        async with app.router.lifespan_context(app):
            config = uvicorn.Config(app, lifespan="off", log_config=None, timeout_graceful_shutdown=2)
            self._server = uvicorn.Server(config)
            self._watch.begin()
            self._ready.set()
            await self._server.serve(sockets=[self._listener])

    def wait(self) -> None:
        assert self._ready.wait(60.0)
        if self._error is not None:
            raise self._error

    def end(self) -> None:
        if self._server is not None:
            self._server.should_exit = True
        self.join(60.0)
        self._listener.close()
        if self._error is not None:
            raise self._error
