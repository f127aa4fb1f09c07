"""The gate in front of a server with people: any of them stops a rig though the server does not answer; no stranger."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from fullpose_server.api.deps import Services
from fullpose_server.api.front import FrontStatus
from fullpose_server.api.problems import ApiError
from fullpose_server.gate import messages
from fullpose_server.gate.beat import Beat
from fullpose_server.gate.keeper import GateProcess, Keeper
from fullpose_server.gate.served import Connections
from fullpose_server.gate.who import Who
from fullpose_server.logs import LogFormat, LogLevel, LogSettings
from fullpose_server.people.admitted import Admitted, Credential
from fullpose_server.people.roles import Role
from fullpose_server.secret import proof_of
from fullpose_server.store.database import Database
from fullpose_server.store.people import PeopleStore
from tests.support.serving import running
from tests.support.sockets import connect

API = "/api/v1"
RIG = f"{API}/rigs/vertical-4"


def let_in(who: Who, secret: str) -> str | None:
    """The name of whose token it is; None: nobody need be known."""
    found = who.admit(f"Bearer {secret}", None)
    return None if found is None else found.who


def test_who_is_let_in_is_told_in_parts_and_in_force_with_the_last() -> None:
    people = [
        Credential(str(k), proof_of(f"secret{k}"), f"p{k}", Role.VIEWER, None, session=False) for k in range(1200)
    ]
    who = Who()
    assert let_in(who, "anything") is None  # it was told nothing yet: a stop is better than none
    parts = messages.let_in(Admitted(True, people))
    assert len(parts) > 1
    assert all(len(part.credentials) <= 500 for part in parts)
    for part in parts[:-1]:
        who.take(part)
        assert let_in(who, "anything") is None
    who.take(parts[-1])
    assert [let_in(who, f"secret{k}") for k in (0, 600, 1199)] == ["p0", "p600", "p1199"]
    with pytest.raises(ApiError):
        let_in(who, "anything")
    for part in messages.let_in(Admitted(True, people[:1])):
        who.take(part)
    with pytest.raises(ApiError):
        let_in(who, "secret600")
    for part in messages.let_in(Admitted(False)):
        who.take(part)
    assert let_in(who, "anything") is None


class _Nobody:
    """Of a gate's process: nothing is to become of it here."""

    pid = 0

    def kill(self) -> None:
        raise AssertionError("a gate that is slow is not one that is lost")

    def wait(self, _longest_s: float = 0.0) -> None:
        """It has ended."""


def test_a_gate_is_told_of_more_people_than_its_link_takes_at_once() -> None:
    """Otherwise one viewer with a loop that makes tokens takes the server from everybody, and the E-stop too."""
    people = [Credential(str(k), proof_of(str(k)), f"p{k}", Role.VIEWER, None, session=False) for k in range(20_000)]
    admitted = Admitted(True, people)

    async def told() -> Who:
        ours, theirs = messages.link()
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 300_000)
        beat, memory = Beat.made()
        os.close(memory)
        log = LogSettings(LogFormat.TEXT, LogLevel.WARNING)
        gate = GateProcess(cast("subprocess.Popen[bytes]", _Nobody()), ours, beat, log, ())
        running = SimpleNamespace(watch=lambda _tell: None, all=list)
        tells: list[Callable[[Admitted], None]] = []
        services = SimpleNamespace(
            hosts=SimpleNamespace(running=running),
            people=SimpleNamespace(may_stop=Admitted(True, people[:9_000]), watch=tells.append),
            trail=None,
            front=FrontStatus(),
        )
        keeper = Keeper(socket.socket(), gate, cast(Connections, []), 1, cast(Services, services))
        tells[0](admitted)  # and again, before the first was taken
        who = Who()

        def hear() -> None:
            match messages.for_gate(theirs):
                case messages.LetIn() as part:
                    who.take(part)
                    if part.last and len(who_knows(who)) == len(people):
                        done.set()

        done = asyncio.Event()
        asyncio.get_running_loop().add_reader(theirs, hear)
        async with asyncio.timeout(60.0):
            await done.wait()
        asyncio.get_running_loop().remove_reader(theirs)
        await keeper.close()
        theirs.close()
        return who

    assert let_in(asyncio.run(told()), "19999") == "p19999"


def who_knows(who: Who) -> list[Credential]:
    """All that it was told."""
    return [] if who._admitted is None else who._admitted.all()


def test_what_has_run_out_stops_for_a_day_and_what_was_revoked_does_not() -> None:
    now = time.time()
    ages = {"new": -60.0, "hour": 3600.0, "week": 7 * 86400.0}
    people = [
        Credential(name, proof_of(name), name, Role.VIEWER, now - age, session=False) for name, age in ages.items()
    ]
    who = Who()
    for part in messages.let_in(Admitted(True, people)):
        who.take(part)
    assert [let_in(who, name) for name in ("new", "hour")] == ["new", "hour"]
    for name in ("week", "revoked"):
        with pytest.raises(ApiError):
            let_in(who, name)


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[tuple[int, str, dict[str, str]]]:
    database = Database(tmp_path / "fullpose.db")
    people = PeopleStore(database)
    people.add("ann", Role.ADMIN, None)
    people.add("bob", Role.VIEWER, None)
    tokens = {name: people.make_token(name, "a test's", None, None).secret for name in ("ann", "bob")}
    database.close()
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        yield process.pid, url, tokens


def bearer(token: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {token}"}


def test_a_viewer_stops_a_rig_without_the_server_and_a_stranger_does_not(lab: tuple[int, str, dict[str, str]]) -> None:
    pid, url, tokens = lab
    with httpx.Client(base_url=url, timeout=180.0, headers=bearer(tokens["ann"])) as ann:
        held = ann.post(f"{RIG}/lease").raise_for_status().json()
        lease = {"epoch": held["epoch"], "sequence": 1, "secret": held["secret"]}
        ann.post(f"{RIG}/commands", json={"command": "connect", "lease": lease}).raise_for_status()
        channel = connect(f"ws{url[4:]}{API}/stop", additional_headers=bearer(tokens["bob"]))
        with channel:
            os.kill(pid, signal.SIGSTOP)
            try:
                for path in (f"{RIG}/estop", f"{RIG}/stop"):
                    stranger = httpx.post(f"{url}{path}", timeout=60.0)
                    assert (stranger.status_code, stranger.json()["type"]) == (401, "urn:fullpose:problem:sign-in")
                with pytest.raises(InvalidStatus):
                    connect(f"ws{url[4:]}{API}/stop")
                done = httpx.post(f"{url}{RIG}/estop", headers=bearer(tokens["bob"]), timeout=60.0)
                assert (done.status_code, done.json()["state_after"]) == (200, "estopped")
                channel.send(json.dumps({"type": "estop", "rig": "vertical-4", "client": "ann", "id": 7}))
                answer = json.loads(channel.recv(timeout=60.0))
                assert (answer["type"], answer["id"]) == ("stopped", 7)
            finally:
                os.kill(pid, signal.SIGCONT)
        lines = ann.get(f"{API}/audit", params={"rig": "vertical-4"}).json()
        assert {line["who"] for line in lines if line["command"] == "estop"} == {"bob"}
