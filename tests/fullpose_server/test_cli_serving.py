"""`serve` and `demo` as processes: the address first, a flying rig, clear errors, an orderly end."""

import json
import signal
import socket
import time
from pathlib import Path

import httpx

from fullpose_server.cli.demo import RIG
from tests.support.serving import running, start
from tests.support.sockets import connect
from tests.support.waiting import until


def test_demo_prints_the_address_and_flies_a_real_flight(tmp_path: Path) -> None:
    with running("demo", "--port", "0", "--data-dir", tmp_path) as (process, url):
        assert url.startswith("http://127.0.0.1:")
        page = httpx.get(url)
        assert page.headers["content-type"].startswith("text/html")
        with connect(f"ws{url[4:]}/api/v1/rigs/{RIG}/stream") as stream:
            stream.send(json.dumps({"type": "subscribe", "topics": ["session", "telemetry"], "rate_hz": 20}))
            moved: list[float] = []
            end = time.monotonic() + 90.0
            while len(moved) < 20 and time.monotonic() < end:
                message = json.loads(stream.recv(timeout=30.0))
                if message["type"] == "telemetry" and (message["path_time_s"][-1] or -1.0) > 0.0:
                    moved.append(message["measured"][-1][1])
                    assert message["solve_error_deg"][-1] < 1e-9
        assert len(set(moved)) > 10
        plan = httpx.get(f"{url}/api/v1/plans").json()[0]
        assert (plan["method"], plan["flyable"]) == ("plan", True)
        log = httpx.get(f"{url}/api/v1/audit").json()
        commands = [line["command"] for line in reversed(log)]
        made = ["POST /trajectories", "POST /plans"]
        assert commands == [*made, "lease take", "connect", "load", "arm", "start"]
        assert {line["who"] for line in log} == {"demo"}
        rig = httpx.get(f"{url}/api/v1/health").json()["rigs"][RIG]["rig_pid"]
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
        assert "Traceback" not in errors
    assert not Path(f"/proc/{rig}").exists()


def test_serve_ends_at_sigterm_and_two_servers_do_not_share_a_folder(tmp_path: Path) -> None:
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        assert httpx.get(f"{url}/api/v1/health").json()["status"] == "ok"
        second = start("serve", "--port", "0", "--data-dir", tmp_path)
        _, errors = second.communicate(timeout=60)
        assert (second.returncode, errors.count("\n")) == (2, 1)
        assert str(tmp_path) in errors
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=60)
        assert (process.returncode, errors) == (0, "")


def test_a_busy_port_is_named(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as busy:
        port = busy.getsockname()[1]
        process = start("demo", "--port", str(port), "--data-dir", tmp_path)
        out, errors = process.communicate(timeout=60)
    assert (process.returncode, out, errors.count("\n")) == (2, "", 1)
    assert str(port) in errors


def test_the_network_is_not_served_without_users(tmp_path: Path) -> None:
    process = start("serve", "--host", "0.0.0.0", "--port", "0", "--data-dir", tmp_path)
    _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors.count("\n")) == (2, 1)
    assert "this machine only" in errors


def test_a_setting_that_cannot_be(tmp_path: Path) -> None:
    process = start("serve", "--data-dir", tmp_path, FULLPOSE_PORT="http")
    _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors.count("\n")) == (2, 1)
    assert "FULLPOSE_PORT = 'http': expected a valid integer" in errors


def test_a_server_that_is_killed_leaves_its_rig_to_the_next_one(tmp_path: Path) -> None:
    rig = "/rigs/vertical-4"
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        with httpx.Client(base_url=f"{url}/api/v1", timeout=60.0, headers={"X-Fullpose-Client": "ann"}) as http:
            lease = http.post(f"{rig}/lease").json()
            token = {"epoch": lease["epoch"], "sequence": 1, "secret": lease["secret"]}
            assert http.post(f"{rig}/commands", json={"command": "connect", "lease": token}).is_success
            before = http.get(f"{rig}/session").json()
        process.kill()
        process.communicate(timeout=60)
    with running("serve", "--port", "0", "--data-dir", tmp_path) as (process, url):
        after = httpx.get(f"{url}/api/v1{rig}/session", timeout=60.0).json()
        renewed = {"action": "renew", "secret": lease["secret"]}  # the holder keeps the lease: a server knows no secret
        assert httpx.post(f"{url}/api/v1{rig}/lease", json=renewed, timeout=60.0).is_success
    assert (after["state"], after["health"]["rig_pid"]) == ("idle", before["health"]["rig_pid"])
    assert after["lease"]["epoch"] == before["lease"]["epoch"]
    left = Path(f"/proc/{before['health']['rig_pid']}")
    until(lambda: not left.exists())  # ended, it waits for init to take its status
