"""The stream as clients see it: real WebSockets, JSON and binary, slow clients, foreign pages."""

import json
import socket
import struct
import time
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection

from fullpose_server.runtime.contract.telemetry import SAMPLE
from tests.fullpose_server.api.live_server import LiveServer, Operator


def received(stream: ClientConnection, kind: str, timeout: float = 10.0) -> Any:
    """The next message of a type; the others pass."""
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        data = stream.recv(timeout=timeout)
        if isinstance(data, bytes):
            if kind == "binary":
                return data
            continue
        message = json.loads(data)
        if message["type"] == kind:
            return message
    raise AssertionError(f"no {kind} within {timeout} s")


def subscribe(stream: ClientConnection, **wanted: Any) -> None:
    stream.send(json.dumps({"type": "subscribe"} | wanted))


def test_hello_says_what_will_come(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        hello = received(stream, "hello")
    assert hello["schema"] == "fullpose.stream/1"
    assert hello["session"]["state"] == "idle"
    assert hello["fields"] == list(SAMPLE.names or ())
    assert hello["record"]["size"] == SAMPLE.itemsize
    offsets = {field["name"]: field["offset"] for field in hello["record"]["fields"]}
    assert SAMPLE.fields is not None
    assert offsets == {name: SAMPLE.fields[name][1] for name in SAMPLE.names or ()}


def test_frames_carry_the_newest_sample(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        subscribe(stream, topics=["telemetry"], rate_hz=50)
        frames = [received(stream, "telemetry") for _ in range(5)]
    assert all(len(frame["time_ns"]) == len(frame["measured"]) == 1 for frame in frames)
    steps = np.diff([frame["seq"] for frame in frames])
    assert (steps > 0).all()
    assert frames[-1]["sample_seq"] == [frames[-1]["seq"]]
    assert all(len(frame["measured"][0]) == 4 for frame in frames)


def test_health_is_told_though_nothing_changes(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        subscribe(stream, topics=["session"])
        first, second = (received(stream, "session") for _ in range(2))
    assert first["revision"] == second["revision"]
    assert second["session"]["health"]["ticks"] > first["session"]["health"]["ticks"]


def test_every_sample_in_binary_without_a_gap(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        subscribe(stream, topics=["telemetry"], rate_hz=20, encoding="binary", every_sample=True)
        sequences: list[int] = []
        while len(sequences) <= 50:
            data = received(stream, "binary")
            magic, version, count, seq, _, dropped = struct.unpack_from("<4sHHQdQ", data)
            rows = np.frombuffer(data, SAMPLE, offset=32)
            assert (magic, version, count, dropped) == (b"FPT1", 1, len(rows), 0)
            assert seq == rows["seq"][-1]
            sequences += rows["seq"].tolist()
    assert sequences == list(range(sequences[0], sequences[0] + len(sequences)))


def test_a_client_that_comes_back_is_sent_what_it_missed(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        subscribe(stream, topics=["telemetry"])
        last = received(stream, "telemetry")["seq"]
    with server.stream() as other:
        subscribe(other, topics=["telemetry"])
        while received(other, "telemetry")["seq"] < last + 50:
            pass
    with server.stream() as stream:
        subscribe(stream, topics=["telemetry"], since_seq=last)
        frame = received(stream, "telemetry")
    assert frame["sample_seq"][0] == last + 1
    assert frame["dropped"] == 0
    assert len(frame["sample_seq"]) > 20


def test_what_the_ring_no_longer_holds_is_counted(operator: Operator, server: LiveServer) -> None:
    with server.stream() as stream:
        hello = received(stream, "hello")
        subscribe(stream, topics=["telemetry"], since_seq=0, rate_hz=5)
        frame = received(stream, "telemetry")
        assert hello["type"] == "hello"
        assert frame["dropped"] == frame["sample_seq"][0] - 1


def test_a_session_change_is_told_at_once(operator: Operator, server: LiveServer) -> None:
    plan = server.plan()
    with server.stream() as stream:
        subscribe(stream, topics=["session"])
        assert received(stream, "session")["session"]["state"] == "idle"
        operator.command("load", plan=plan["id"])
        while (message := received(stream, "session"))["session"]["state"] == "idle":
            pass
        assert message["session"]["plan"]["plan_id"] == plan["id"]
        assert message["revision"] == message["session"]["revision"]


def test_ping_and_what_is_not_understood(server: LiveServer) -> None:
    with server.stream() as stream:
        stream.send(json.dumps({"type": "ping", "t": 12.5}))
        assert received(stream, "pong")["t"] == 12.5
        for nonsense in ("{", json.dumps({"type": "subscribe", "rate_hz": 0}), json.dumps({"type": "fly"})):
            stream.send(nonsense)
            assert received(stream, "problem")["problem"]["status"] == 422
        stream.send(json.dumps({"type": "ping", "t": 1.0}))
        assert received(stream, "pong")["t"] == 1.0


def test_a_client_that_does_not_read_holds_nobody_up_and_is_told_what_it_missed(
    operator: Operator, server: LiveServer
) -> None:
    host, port = server.url.removeprefix("http://").split(":")
    narrow = socket.socket()
    narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    narrow.connect((host, int(port)))
    with server.stream(sock=narrow, max_queue=1) as slow, server.stream() as quick:
        subscribe(slow, topics=["telemetry"], rate_hz=500)
        subscribe(quick, topics=["telemetry"], rate_hz=50)
        frame = received(quick, "telemetry")
        far = frame["seq"] + 3000
        while frame["seq"] < far:
            frame = received(quick, "telemetry")
        newest, missed = frame["seq"], frame["dropped"]
        frames = [received(slow, "telemetry")]
        while frames[-1]["seq"] < newest:
            frames.append(received(slow, "telemetry"))
    # Little was held for it: it is sent what is new, and told of the rest. How much depends on the machine's load.
    assert frames[-1]["dropped"] > 50 + missed
    assert np.diff([frame["seq"] for frame in frames]).max() > 50


def test_an_unknown_rig_and_a_foreign_page_get_no_stream(server: LiveServer) -> None:
    with pytest.raises(InvalidStatus), server.stream("nowhere"):
        pass
    with pytest.raises(InvalidStatus) as caught, server.stream(origin="http://evil.example"):
        pass
    assert caught.value.response.status_code == 403
    with server.stream(origin=server.url) as stream:
        assert received(stream, "hello")


def test_the_stream_of_a_rig_without_a_process_waits_for_it(server: LiveServer) -> None:
    with server.stream("vertical-3") as stream:
        assert received(stream, "hello")["session"]["state"] == "disconnected"
        subscribe(stream, topics=["session", "telemetry"])
        other = Operator(server, "vertical-3")
        other.to_idle()
        while received(stream, "session", 30.0)["session"]["state"] != "idle":
            pass
        assert received(stream, "telemetry")


@pytest.mark.parametrize("word", ["stop", "estop"])
def test_stop_and_estop_over_the_stream_need_no_lease(operator: Operator, server: LiveServer, word: str) -> None:
    long = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 10},0,0,0\n" for k in range(300))
    operator.command("load", plan=server.plan(text=long)["id"])
    operator.command("arm")
    with server.stream() as stream:
        operator.command("start")
        operator.wait("running")
        stream.send(json.dumps({"type": word, "client": "a-passer-by"}))
        stopped = received(stream, "stopped")
        assert (stopped["command"], stopped["state_before"]) == (word, "running")
        assert stopped["state_after"] in {"stop": ("stopping", "armed"), "estop": ("estopped",)}[word]
        operator.wait({"stop": "armed", "estop": "estopped"}[word])
        entry = server.http.get("/audit").json()[0]
        assert (entry["who"], entry["command"], entry["accepted"]) == ("a-passer-by", word, True)
        operator.to_idle()
        stream.send(json.dumps({"type": "stop"}))
        refused = received(stream, "problem")["problem"]
        assert (refused["status"], refused["state"], refused["command"]) == (409, "idle", "stop")
        stream.send(json.dumps({"type": "ping", "t": 1.0}))
        assert received(stream, "pong")["t"] == 1.0
