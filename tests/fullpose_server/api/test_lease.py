"""The lease through HTTP: who has its secret holds it, and it is told once, to whom it is for, and nowhere else."""

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest

from fullpose_server.client import Client, ClientError
from fullpose_server.secret import proof_of
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server

URL = "/rigs/vertical-4"


def problem(answer: Any, status: int, code: str) -> dict[str, Any]:
    assert answer.status_code == status, answer.text
    body: dict[str, Any] = answer.json()
    assert body["type"] == f"urn:fullpose:problem:{code}"
    return body


def test_who_has_name_epoch_and_sequence_and_not_the_secret_commands_nothing(
    operator: Operator, server: LiveServer
) -> None:
    public = server.http.get(f"{URL}/session").json()["lease"]
    assert public == server.http.get(f"{URL}/session").json()["lease"] | {"expires_s": public["expires_s"]}
    assert set(public) == {"holder", "epoch", "sequence", "expires_s", "requested_by"}
    guessed = {"epoch": public["epoch"], "sequence": public["sequence"] + 1, "secret": "guessed"}
    as_holder = {"X-Fullpose-Client": public["holder"]}
    body = {"command": "acknowledge", "lease": guessed}
    problem(server.http.post(f"{URL}/commands", json=body, headers=as_holder), 403, "lease-lost")
    for action in ("renew", "grant", "release"):
        body = {"action": action, "secret": "guessed"}
        problem(server.http.post(f"{URL}/lease", json=body, headers=as_holder), 403, "lease-lost")
        answer = server.http.post(f"{URL}/lease", json={"action": action}, headers=as_holder)
        assert "expected the lease's secret" in problem(answer, 422, "validation")["detail"]
    problem(server.http.post(f"{URL}/lease", headers=as_holder), 409, "lease-held")
    assert operator.command("acknowledge").status_code == 200
    assert operator.lease().json()["secret"] is None


def test_a_hand_over_gives_the_secret_of_the_request_to_who_asked(operator: Operator, server: LiveServer) -> None:
    async def hand_over() -> None:
        async with Client(server.url, name="bob") as bob:
            assert (await bob.take_lease("vertical-4", "request"))["requested_by"] == ["bob"]
            with pytest.raises(ClientError, match="take it first"):
                await bob.command("vertical-4", "acknowledge")
            assert (await asyncio.to_thread(operator.lease, "grant")).json()["holder"] == "bob"
            session = await bob.wait_lease("vertical-4")
            assert (session["lease"]["holder"], session["lease"]["epoch"]) == ("bob", operator.epoch + 1)
            await bob.command("vertical-4", "acknowledge")
            await bob.take_lease("vertical-4", "renew")
            problem(await asyncio.to_thread(operator.lease), 403, "lease-lost")
            await bob.release_lease("vertical-4")

    asyncio.run(hand_over())


def test_the_holder_keeps_the_lease_over_a_restart_of_the_server(tmp_path: Path) -> None:
    with live_server(tmp_path, rig_rate_hz=500.0, stop_rigs_on_exit=False) as first:
        operator = Operator(first)
        operator.to_idle()
    with live_server(tmp_path, rig_rate_hz=500.0) as second:
        operator.server = second
        assert operator.lease().status_code == 200
        assert operator.session()["lease"]["holder"] == "ann"
        assert operator.command("acknowledge").status_code == 200
        operator.secret = "guessed"
        problem(operator.lease(), 403, "lease-lost")


def test_a_secret_is_in_no_stream_audit_log_record_or_alarm(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    told: list[str] = []
    with caplog.at_level("INFO"), live_server(tmp_path, rig_rate_hz=500.0) as server:
        operator = Operator(server)
        operator.to_idle()
        other = server.http.post(f"{URL}/lease", json={"action": "request"}, headers={"X-Fullpose-Client": "bob"})
        given = [operator.secret, other.json()["secret"]]
        plan = server.plan()
        with server.stream() as stream:
            stream.send(json.dumps({"type": "subscribe", "topics": ["telemetry", "session"]}))
            operator.command("load", plan=plan["id"])
            operator.command("start")  # refused
            told.append(server.http.post(f"{URL}/commands", json={"command": "arm", "lease": given[0]}).text)
            operator.command("arm")
            operator.command("start")
            operator.wait("running")
            operator.command("hold")
            server.http.post(f"{URL}/estop")
            operator.wait("estopped")
            told += [str(stream.recv(timeout=30.0)) for _ in range(5)]
        problem(operator.lease("grant", to="nobody"), 409, "lease-not-requested")
        shown = (f"{URL}/session", f"{URL}/alarms", "/audit", "/runs", "/health", "/metrics")
        told += [server.http.get(path).text for path in shown]
        memory = [path for path in Path("/dev/shm").glob("fullpose-*") if path.is_file()]
        kept = [path for path in tmp_path.rglob("*") if path.is_file()] + memory
        content = {str(path): path.read_bytes() for path in kept}
        assert any(name.endswith("rig.log") for name in content)
        assert any(name.endswith(".mcap") for name in content)
        assert any("fullpose.db" in name for name in content)
        assert memory
    output = "".join(capfd.readouterr())
    content |= {"answers": "\n".join(told).encode(), "log": caplog.text.encode(), "output": output.encode()}
    for secret in given:
        for shape in (secret, proof_of(secret)):
            assert [name for name, data in content.items() if shape.encode() in data] == []
