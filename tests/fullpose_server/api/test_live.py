"""A live source over the WebSocket, into a real rig process: JSON and binary, its loss, and who may open it."""

import json
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection

from fullpose.kinematics import payload_attitude
from fullpose.rig import builtin_rigs
from fullpose_server.api.schemas.live import LiveReplyOut
from fullpose_server.api.streams.live_link import split
from fullpose_server.runtime.live.packets import REPLY_SIZE, Kind, LiveStatus, decode_reply, encode_sample
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tests.fullpose_server.api.test_stream import received
from tests.support.sockets import connect
from tests.support.waiting import until

RIG = "vertical-4"
FOLLOWED = 300


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    # The machine of the tests may starve the sender: bridged longer than on a quiet one.
    patient = {"live_delay_ms": 20.0, "live_extrapolate_ms": 2000.0}
    with live_server(tmp_path_factory.mktemp("data"), rig_rate_hz=500.0, **patient) as live:
        yield live


def source(server: LiveServer, rig: str = RIG, **options: Any) -> ClientConnection:
    headers = {"X-Fullpose-Client": "ann"}
    return connect(f"{server.ws}/rigs/{rig}/live", proxy=None, compression=None, additional_headers=headers, **options)


def euler(t: float) -> tuple[float, float, float]:
    """yaw, pitch, roll [deg] of a swing that begins at rest; slow, so that a starved sender is predicted well."""
    u = min(1.0, t / 1.5)
    ramp = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
    return 5 * ramp * math.sin(1.9 * t), 3 * ramp * math.sin(2.5 * t), 4 * ramp * math.sin(1.4 * t)


def opened(stream: ClientConnection, operator: Operator | None = None, **settings: Any) -> dict[str, Any]:
    lease = {} if operator is None else {"lease": operator.token()}
    stream.send(json.dumps({"type": "open"} | lease | settings))
    answer: dict[str, Any] = json.loads(stream.recv(timeout=30.0))
    return answer


def fly(
    operator: Operator,
    stream: ClientConnection,
    send: Callable[[int, float], int],
    enough: Callable[[str | bytes], bool],
) -> list[str | bytes]:
    """Send (it returns how many samples), wait for a reply, renew the lease, until `FOLLOWED` replies are `enough`."""
    begun, renewed, sent, count, followed = time.monotonic(), 0.0, 0, 0, 0
    replies: list[str | bytes] = []
    while followed < FOLLOWED:
        t = time.monotonic() - begun
        sent += send(count, t)
        count += 1
        if t - renewed > 1.0:
            renewed = t
            operator.lease()
        while len(replies) < sent:
            replies.append(stream.recv(timeout=60.0))
            followed += enough(replies[-1])
    return replies


def test_json_samples_are_followed_and_the_sockets_end_is_a_controlled_stop(
    server: LiveServer, operator: Operator
) -> None:
    with source(server) as stream:
        answer = opened(stream, operator, method="exact")
        assert answer == {"type": "opened", "rig": RIG, "state": "ready", "rate_hz": 500.0, "loaded": True}
        assert operator.command("arm").is_success
        assert operator.command("go_live").is_success

        def send(_: int, t: float) -> int:
            stream.send(json.dumps({"type": "sample", "time_s": 50.0 + t, "euler_deg": euler(t)}))
            return 1

        def followed(text: str | bytes) -> bool:
            return LiveReplyOut.model_validate_json(text).status == ["followed"]

        replies = [LiveReplyOut.model_validate_json(text) for text in fly(operator, stream, send, followed)]
        now = operator.session()
        assert now["state"] == "live", now["alarms"]
        health = now["health"]["live"]
        assert 0 < health["accepted"] <= len(replies)  # told four times a second
        assert (health["bad"], health["way_age_ms"]) == (0, None)
        assert health["rate_hz"] >= 0.0
        assert health["age_ms"] is not None
    assert [reply.sequence for reply in replies] == list(range(len(replies)))
    last = [reply for reply in replies if reply.status == ["followed"]]
    assert all(reply.error_deg is not None and reply.error_deg <= 1e-9 for reply in last)
    assert all(reply.lag_deg is not None for reply in last)
    assert all(reply.margin is not None and 0.0 <= reply.margin <= 1.0 for reply in last)
    assert all(reply.server_latency_us is not None and reply.server_latency_us > reply.latency_us for reply in last)
    session = operator.wait("armed", "faulted", "estopped")
    assert session["state"] == "armed", session["alarms"]
    assert "live_source_lost" in [alarm["code"] for alarm in session["alarms"]]


def test_binary_samples_are_the_datagrams_and_ned_is_turned(server: LiveServer, operator: Operator) -> None:
    loaded = operator.command("load", live={"method": "exact"})
    assert operator.session()["plan"]["live"] is True
    with source(server) as stream:
        assert opened(stream, key=loaded.json()["live_key"])["loaded"] is True  # no lease: the operator has loaded it
        assert operator.command("arm").is_success
        assert operator.command("go_live").is_success

        def sample(sequence: int, t: float) -> bytes:
            yaw, pitch, roll = euler(t)
            return encode_sample(Kind.EULER_NED, sequence, t, (-yaw, pitch, roll), ())

        def send(count: int, t: float) -> int:
            stream.send(sample(2 * count, t - 0.0005) + sample(2 * count + 1, t))
            return 2

        def is_followed(row: str | bytes) -> bool:
            reply = decode_reply(row) if isinstance(row, bytes) else None
            return reply is not None and reply.status == LiveStatus.FOLLOWED

        data = fly(operator, stream, send, is_followed)
        replies = [decode_reply(row) for row in data if isinstance(row, bytes)]
        assert len(replies) == len(data)
        assert all(reply is not None for reply in replies)
        assert operator.session()["state"] == "live", operator.session()["alarms"]
        followed = [reply for reply in replies if reply is not None and reply.status == LiveStatus.FOLLOWED]
        reply = followed[-1]
        # Where the rig was sent is, but for the delay, where the sample says.
        F, G = np.empty((3, 3)), np.empty((3, 3))
        payload_attitude(builtin_rigs()[RIG].axes, np.radians(reply.angles), F)
        yaw, pitch, roll = (math.radians(a) for a in euler(reply.time_s))
        payload_attitude(builtin_rigs()["vertical-3"].axes, np.array([0.0, yaw, pitch, roll]), G)
        assert math.degrees(math.acos(min(1.0, (np.trace(F @ G.T) - 1.0) / 2.0))) == pytest.approx(
            reply.lag_deg, abs=0.1
        )
    operator.wait("armed")


def test_before_it_is_live_samples_are_answered_and_nothing_moves(server: LiveServer, operator: Operator) -> None:
    with source(server) as stream:
        assert opened(stream, operator)["loaded"] is True
        stream.send(json.dumps({"type": "sample", "time_s": 1.0, "q": [1, 0, 0, 0], "body_rate_deg_s": [0, 0, 0]}))
        assert json.loads(stream.recv(timeout=5.0))["status"] == ["idle"]
        stream.send(encode_sample(Kind.QUATERNION, 7, 1.1, (1.0, 0.0, 0.0, 0.0), ()))
        data = stream.recv(timeout=5.0)
        assert isinstance(data, bytes)
        assert len(data) == REPLY_SIZE
        reply = decode_reply(data)
        assert reply is not None
        assert (reply.sequence, reply.status) == (7, LiveStatus.IDLE)
    assert operator.session()["state"] == "ready"


def test_a_source_shows_the_lease_or_the_key_that_its_load_was_answered(server: LiveServer, operator: Operator) -> None:
    key = operator.command("load", live={"method": "exact"}).json()["live_key"]
    assert operator.command("acknowledge").json()["live_key"] is None
    sample = json.dumps({"type": "sample", "time_s": 1.0, "q": [1, 0, 0, 0]})
    with source(server) as stream:
        for proof in ({}, {"lease": operator.token(), "key": key}, {"key": None}, {"key": "no key"}):
            assert opened(stream, **proof)["problem"]["status"] == 422
        refused = opened(stream, key="guessed")["problem"]
        assert (refused["status"], refused["type"]) == (403, "urn:fullpose:problem:live-key")
        assert opened(stream, key=key)["loaded"] is True
        stream.send(sample)
        assert received(stream, "reply")["status"] == ["idle"]
        # Loaded anew, for another: who had the earlier key is not that one.
        assert operator.command("unload").is_success
        another = operator.command("load", live={"method": "exact"}).json()["live_key"]
        assert another != key
        stream.send(sample)
        assert received(stream, "reply")["status"] == ["unproven"]
        assert opened(stream, key=another)["type"] == "opened"
        stream.send(sample)
        assert received(stream, "reply")["status"] == ["idle"]
    told = [server.http.get(path).text for path in (f"/rigs/{RIG}/session", "/audit", "/metrics")]
    told += [path.read_bytes().decode("latin-1") for path in server.settings.data_dir.rglob("*") if path.is_file()]
    assert not any(secret in text for secret in (key, another) for text in told)


def test_what_is_no_sample_is_a_problem_and_the_connection_goes_on(server: LiveServer, operator: Operator) -> None:
    with source(server) as stream:
        stream.send(json.dumps({"type": "sample", "time_s": 1.0, "q": [1, 0, 0, 0]}))
        assert received(stream, "problem")["problem"]["type"].endswith("not-open")
        for settings, word in (({"method": "magic"}, "magic"), ({"method": "lagrange"}, "limits")):
            answer = opened(stream, operator, **settings)
            assert word in answer["problem"]["detail"]
        assert opened(stream, None, lease={"epoch": 0, "sequence": 1, "secret": "guessed"})["problem"]["status"] == 403
        assert opened(stream, operator)["type"] == "opened"
        for data in (
            '{"type": "sample", "time_s": 1.0}',
            '{"type": "sample", "time_s": 1.0, "q": [1, 0, 0, 0], "euler_deg": [0, 0, 0]}',
            '{"type": "sample", "time_s": NaN, "q": [1, 0, 0, 0]}',
            '{"type": "sample", "time_s": 1.0, "q": [9, 0, 0, 0]}',
            "no JSON",
            b"FPA1",
            encode_sample(Kind.QUATERNION, 0, math.nan, (1.0, 0.0, 0.0, 0.0), ()),
        ):
            stream.send(data)
            assert received(stream, "problem")["problem"]["status"] == 422
        stream.send(json.dumps({"type": "sample", "time_s": 1.0, "q": [1, 0, 0, 0]}))
        assert received(stream, "reply")["sequence"] == 0


def test_one_source_a_rig_and_none_from_foreign_pages(server: LiveServer, operator: Operator) -> None:
    key = operator.command("load", live={"method": "exact"}).json()["live_key"]
    with source(server) as stream:
        opened(stream, key=key)
        with pytest.raises(InvalidStatus) as refused, source(server):
            pass
        assert refused.value.response.status_code == 409

    def taken() -> bool:
        try:
            with source(server) as stream:
                return bool(opened(stream, key=key)["type"] == "opened")
        except InvalidStatus:
            return False

    until(taken)  # once the place of the source that has gone is free
    for rig, origin, status in ((RIG, "http://evil.example", 403), ("nowhere", server.url, 404)):
        with pytest.raises(InvalidStatus) as refused, source(server, rig, origin=origin):
            pass
        assert refused.value.response.status_code == status


def test_load_is_a_plan_or_a_live_source(operator: Operator) -> None:
    for args in ({}, {"plan": "x", "live": {}}, {"live": {"method": "exact", "magic": 1}}):
        assert operator.command("load", **args).status_code == 422


def test_binary_messages_are_whole_samples(tmp_path: Path) -> None:
    one = encode_sample(Kind.QUATERNION, 0, 0.0, (1.0, 0.0, 0.0, 0.0), ())
    assert split(one * 3) == [one] * 3
    assert split(b"") is None
    assert split(one[:-1]) is None
