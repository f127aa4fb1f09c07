"""The gate in front of a real server: a stop gets through whatever has become of the rest."""

import json
import os
import resource
import signal
import socket
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from tests.support.serving import few_files, running
from tests.support.sockets import connect
from tests.support.waiting import until

RIG = "/api/v1/rigs/vertical-4"
STOPS = [("stop", 2), ("estop", 1)]


class Served:
    """A server as a process, with a rig that is connected."""

    def __init__(self, process: "subprocess.Popen[str]", url: str) -> None:
        self.process, self.url = process, url
        self.at = ("127.0.0.1", int(urlsplit(url).port or 0))
        self.http = httpx.Client(base_url=url, timeout=60.0, headers={"X-Fullpose-Client": "ann"})
        held = self.http.post(f"{RIG}/lease").json()
        token = {"epoch": held["epoch"], "sequence": 1, "secret": held["secret"]}
        assert self.http.post(f"{RIG}/commands", json={"command": "connect", "lease": token}).is_success

    @property
    def gates(self) -> list[int]:
        """The process that serves, and the one in reserve: the older first."""
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        return [int(pid) for pid in children if "gate.process" in Path(f"/proc/{pid}/cmdline").read_text()]

    @property
    def gate(self) -> int:
        """The process that serves."""
        return self.gates[0]

    @property
    def rig(self) -> int:
        """Its process."""
        pid: int = self.http.get(f"{RIG}/session").json()["health"]["rig_pid"]
        return pid

    def say(self, data: bytes) -> dict[str, Any]:
        """What the server answers to these bytes, whole and on a connection of its own."""
        with socket.create_connection(self.at, timeout=60.0) as connection:
            connection.sendall(data)
            head, _, body = b"".join(iter(lambda: connection.recv(65536), b"")).partition(b"\r\n\r\n")
        assert b"connection: close" in head.lower()
        answer: dict[str, Any] = json.loads(body)
        return answer | {"status": int(head.split()[1])}


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        served = Served(process, url)
        yield served
        served.http.close()


def test_a_stop_needs_neither_the_server_nor_the_end_of_its_body(served: Served) -> None:
    rig = served.rig
    os.kill(served.process.pid, signal.SIGSTOP)
    try:
        head = "HTTP/1.1\r\nHost: x\r\nX-Fullpose-Client: joe b\r\nContent-Length: 100000000\r\n\r\n"
        endless = f"POST {RIG}/estop {head}"
        done = served.say(endless.encode() + b"x" * 4096)
        assert (done["status"], done["state_before"], done["state_after"]) == (200, "idle", "estopped")
        for word, _ in STOPS:
            body = json.dumps({"command": word}).encode()
            head = f"POST {RIG}/commands HTTP/1.1\r\nHost: x\r\nContent-Length: {len(body)}\r\n\r\n".encode()
            answer = served.say(head + body)
            assert answer["status"] == {"stop": 409, "estop": 200}[word]  # a stop of what is E-stopped is none
        os.kill(rig, signal.SIGSTOP)
        try:
            unknown = served.say(f"POST {RIG}/estop HTTP/1.1\r\nHost: x\r\n\r\n".encode())
        finally:
            os.kill(rig, signal.SIGCONT)
        assert (unknown["status"], unknown["stop_category"]) == (202, 1)
        assert f"the order stands in the memory of rig process {rig}" in unknown["unknown"]
    finally:
        os.kill(served.process.pid, signal.SIGCONT)
    log = served.http.get("/api/v1/audit").json()
    assert {line["address"] for line in log[:4]} == {"127.0.0.1"}
    told = [(line["command"], line["who"], line["accepted"]) for line in reversed(log)][2:]
    here = "anonymous@127.0.0.1"
    assert told == [("estop", "joe_b", True), ("stop", here, False), ("estop", here, True), ("estop", here, True)]
    assert "not known" in log[0]["detail"]


def test_the_channel_outlives_a_server_that_hangs(served: Served) -> None:
    with connect(f"ws{served.url[4:]}/api/v1/stop") as channel:
        os.kill(served.process.pid, signal.SIGSTOP)
        try:
            channel.send(json.dumps({"type": "ping", "t": 2.5}))
            assert json.loads(channel.recv(60.0))["t"] == 2.5
            for text in ("nonsense", "{}", '{"type":"estop"}', '{"type":"go","rig":"vertical-4"}'):
                channel.send(text)
                assert json.loads(channel.recv(60.0))["problem"]["status"] == 422
            channel.send(b"estop")
            assert json.loads(channel.recv(60.0))["problem"]["status"] == 422
            for word, category in STOPS[::-1]:
                channel.send(json.dumps({"type": word, "rig": "vertical-4", "client": "a b", "id": category}))
            answers = {answer["id"]: answer for answer in (json.loads(channel.recv(60.0)) for _ in STOPS)}
            assert answers[1]["done"]["state_after"] == "estopped"
            assert answers[1]["done"]["stop_category"] == 1
            channel.send(json.dumps({"type": "stop", "rig": "nowhere"}))
            assert "no rig process runs" in json.loads(channel.recv(60.0))["done"]["unknown"]
        finally:
            os.kill(served.process.pid, signal.SIGCONT)


def test_an_orderly_end_closes_the_channels_without_a_word(tmp_path: Path) -> None:
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        with connect(f"ws{url[4:]}/api/v1/stop") as channel:
            channel.send(json.dumps({"type": "ping", "t": 0}))
            assert json.loads(channel.recv(60.0))["type"] == "pong"
            process.send_signal(signal.SIGTERM)
            with pytest.raises(ConnectionClosed):
                channel.recv(60.0)
        _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (0, "")


def test_a_gate_that_is_suspended_is_woken_and_one_that_is_killed_has_another_behind_it(served: Served) -> None:
    def stops() -> bool:
        answer = served.http.post(f"{RIG}/estop")
        return (answer.status_code, answer.json()["state_after"]) == (200, "estopped")

    first = served.gate
    os.kill(first, signal.SIGTSTP)  # Ctrl-Z at the server's terminal is none of its business
    os.kill(first, signal.SIGSTOP)
    assert stops()
    assert served.gate == first
    spare = until(lambda: [pid for pid in served.gates if pid != first])
    os.kill(first, signal.SIGKILL)
    assert stops()
    assert until(lambda: first not in served.gates)
    assert served.gate == spare[0]
    os.kill(spare[0], signal.SIGKILL)  # before there is another in reserve
    assert stops()
    assert until(lambda: served.http.get("/api/v1/health").json()["status"] == "ok")


def test_idle_connections_take_nothing_from_a_stop(tmp_path: Path) -> None:
    """As many as the limit of files allows, and more."""
    limit = 256
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with ExitStack() as stack:
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
        stack.callback(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        process, url = stack.enter_context(
            running("serve", "--port", "0", "--data-dir", tmp_path, within=few_files(limit))
        )
        served = Served(process, url)
        for _ in range(2 * limit):
            stack.enter_context(socket.create_connection(served.at))
        half = [stack.enter_context(socket.create_connection(served.at)) for _ in range(limit)]
        for connection in half:
            connection.send(b"POST /api/v1/rigs/vertical-4/est")
        for _ in range(20):
            assert served.http.post(f"{RIG}/estop").json()["state_after"] == "estopped"
        assert served.http.get("/api/v1/health").status_code == 200
