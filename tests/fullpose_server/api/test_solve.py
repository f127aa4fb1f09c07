"""Solving over the wire, checked against rotations by SciPy."""

import json
import threading
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from websockets.exceptions import ConnectionClosedError
from websockets.sync.client import ClientConnection

from fullpose_server.api.attitudes import attitudes
from tests.fullpose_server.api.live_server import LOOP_THREAD, LiveServer
from tests.support.sockets import connect

TIME = np.arange(300) * 0.01
EULER = np.column_stack([40 * np.sin(TIME), 30 * np.sin(2 * TIME), 20 * np.sin(3 * TIME)])
Q = Rotation.from_euler("YZX", EULER, degrees=True).as_quat(scalar_first=True)


def attitude(angles_deg: Any) -> np.ndarray[Any, Any]:
    """Payload attitude of vertical-4 (axes y, z, y, x): passive turns are the transposes of SciPy's active ones."""
    d = np.array(angles_deg)
    turned = Rotation.from_euler("Y", d[:, :1], degrees=True) * Rotation.from_euler("ZYX", d[:, 1:], degrees=True)
    return turned.as_matrix().swapaxes(1, 2)


def wanted() -> np.ndarray[Any, Any]:
    return Rotation.from_quat(Q, scalar_first=True).as_matrix().swapaxes(1, 2)


@pytest.mark.parametrize("attitudes", [{"q": Q.tolist()}, {"euler_deg": EULER.tolist()}])
def test_a_batch_of_attitudes(server: LiveServer, attitudes: dict[str, Any]) -> None:
    body = {"rig": "vertical-4", "method": "exact", "time_s": TIME.tolist(), "start_deg": [10, 0, 0, 0]} | attitudes
    answer = server.http.post("/solve", json=body)
    assert answer.status_code == 200, answer.text
    solved = answer.json()
    np.testing.assert_allclose(attitude(solved["angles_deg"]), wanted(), atol=1e-13)
    assert solved["report"]["feasible"]
    assert solved["limited"] == []


def test_limits_are_named_sample_by_sample(server: LiveServer) -> None:
    fast = [[0.0, 0.0, 40.0 * k] for k in range(20)]
    body = {"rig": "vertical-4", "time_s": [0.01 * k for k in range(20)], "euler_deg": fast}
    solved = server.http.post("/solve", json=body).json()
    assert not solved["report"]["feasible"]
    assert {line["frame"] for line in solved["limited"]} <= {"base", "outer", "middle", "inner"}
    assert len(solved["limited"]) == solved["report"]["limited_samples"] > 0


@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"rig": "nowhere"}, 404),
        ({"method": "magic"}, 422),
        ({"options": {"nonsense": 1}}, 422),
        ({"time_s": [0.0, 0.0]}, 422),
        ({"time_s": [0.0, 1e-300]}, 422),
        ({"time_s": [-1e308, 1.5e308]}, 422),
        ({"q": [[0, 0, 0, 0], [1, 0, 0, 0]]}, 422),
        ({"q": [[1, 0, 0, 0]]}, 422),
        ({"euler_deg": [[0, 0, 0], [0, 0, 0]]}, 422),
        ({"start_deg": [0, 0, 0]}, 422),
        ({"method": "three_axis", "options": {"x": "y"}}, 422),
    ],
)
def test_what_cannot_be_solved_is_a_problem(server: LiveServer, change: dict[str, Any], status: int) -> None:
    body = {"rig": "vertical-4", "time_s": [0.0, 0.1], "q": [[1, 0, 0, 0], [1, 0, 0, 0]]} | change
    answer = server.http.post("/solve", json=body)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"


def exchange(stream: ClientConnection, message: dict[str, Any] | str) -> dict[str, Any]:
    stream.send(message if isinstance(message, str) else json.dumps(message))
    answer: dict[str, Any] = json.loads(stream.recv(timeout=30.0))
    return answer


def test_samples_are_solved_as_they_come_and_give_what_the_batch_gives(server: LiveServer) -> None:
    rows: list[list[float]] = []
    errors: list[float] = []
    with connect(f"{server.ws}/solve") as stream:
        opened = exchange(stream, {"type": "open", "rig": "vertical-4", "method": "exact"})
        assert opened == {"type": "opened", "rig": "vertical-4", "method": "exact"}
        for part in (slice(0, 1), slice(1, 2), slice(2, 200), slice(200, 300)):
            message = {"type": "samples", "time_s": TIME[part].tolist(), "q": Q[part].tolist()}
            solved = exchange(stream, message)
            assert solved["type"] == "solved", solved
            rows += solved["angles_deg"]
            errors += solved["error_deg"]
    np.testing.assert_allclose(attitude(rows), wanted(), atol=1e-13)
    assert max(errors) < 1e-11
    batch = server.http.post("/solve", json={"rig": "vertical-4", "time_s": TIME.tolist(), "q": Q.tolist()}).json()
    np.testing.assert_array_equal(rows, batch["angles_deg"])


def test_a_refused_message_leaves_the_flight_as_it_was(server: LiveServer) -> None:
    one = {"type": "samples", "time_s": [0.0], "q": [[1, 0, 0, 0]]}
    with connect(f"{server.ws}/solve") as stream:
        assert exchange(stream, one)["problem"]["type"].endswith("not-open")
        assert exchange(stream, "{")["type"] == "problem"
        assert exchange(stream, {"type": "open", "rig": "vertical-4", "method": "plan"})["type"] == "problem"
        assert exchange(stream, {"type": "open", "rig": "vertical-4"})["type"] == "opened"
        assert exchange(stream, one)["type"] == "solved"
        assert "after" in exchange(stream, one)["problem"]["detail"]
        assert exchange(stream, one | {"time_s": [0.01], "q": [[0, 0, 0, 0]]})["type"] == "problem"
        assert exchange(stream, one | {"time_s": [0.01]})["type"] == "solved"


OPEN = {"type": "open", "rig": "vertical-4"}
ONE = {"type": "samples", "time_s": [0.0], "q": [[1, 0, 0, 0]]}


@pytest.mark.parametrize(
    "message",
    [
        "[" * 200_000,
        '{"type": "samples", "q": [[1, 0, 0, 0]], "time_s": [' + "1" * 5000 + "]}",
        '{"type": "samples", "q": [[1, 0, 0, 0]], "time_s": [NaN]}',
        "",
        "null",
    ],
)
def test_every_message_that_is_none_has_an_answer_and_changes_nothing(server: LiveServer, message: str) -> None:
    with connect(f"{server.ws}/solve") as stream:
        assert exchange(stream, OPEN)["type"] == "opened"
        stream.send(message)
        answer = json.loads(stream.recv(timeout=30.0))
        assert answer["problem"]["status"] == 422, answer
        assert exchange(stream, ONE)["type"] == "solved"


@pytest.mark.parametrize("path", ["/solve", "/rigs/vertical-4/stream"])
def test_a_binary_frame_where_messages_are_json_closes_with_its_own_code(server: LiveServer, path: str) -> None:
    with connect(f"{server.ws}{path}", proxy=None) as stream:
        stream.send(b"\x00\x01")
        answers: list[dict[str, Any]] = []
        with pytest.raises(ConnectionClosedError):
            answers.extend(map(json.loads, stream))
        assert answers[-1]["problem"]["status"] == 422
        assert stream.close_code == 1003


@pytest.mark.parametrize("times", [[1e-300], [1e308], [-1.0], [0.0], [0.1, 0.1 + 1e-12]])
def test_times_beyond_reason_are_refused_and_do_not_spoil_the_flight(server: LiveServer, times: list[float]) -> None:
    with connect(f"{server.ws}/solve") as stream:
        exchange(stream, OPEN)
        assert exchange(stream, ONE)["type"] == "solved"
        refused = exchange(stream, ONE | {"time_s": times, "q": [[1, 0, 0, 0]] * len(times)})
        assert refused["problem"]["status"] == 422
        assert "expected" in refused["problem"]["detail"]
        assert exchange(stream, ONE | {"time_s": [0.01]})["angles_deg"] == [[0.0] * 4]


def test_a_rig_file_that_is_broken_is_a_problem_and_the_stream_goes_on(server: LiveServer) -> None:
    broken = server.settings.data_dir / "rigs" / "broken.toml"
    with connect(f"{server.ws}/solve") as stream:
        broken.write_text("name = 1")
        try:
            assert exchange(stream, OPEN | {"rig": "broken"})["problem"]["type"].endswith(":file")
        finally:
            broken.unlink()
        assert exchange(stream, OPEN)["type"] == "opened"


def test_a_fault_of_the_servers_own_is_told_and_the_stream_is_closed(
    server: LiveServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("a fault")

    with connect(f"{server.ws}/solve") as stream:
        exchange(stream, OPEN)
        monkeypatch.setattr("fullpose_server.api.routes.solve.attitude_errors", fail)
        assert exchange(stream, ONE)["problem"]["type"].endswith(":internal")
        with pytest.raises(ConnectionClosedError) as closed:
            stream.recv(timeout=30.0)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1011


def test_no_first_sample_is_solved_on_the_event_loop(server: LiveServer, monkeypatch: pytest.MonkeyPatch) -> None:
    """It compiles its method's kernels, for seconds; with those there, a few samples take less than a thread does."""
    threads: list[str] = []

    def noted(message: Any) -> Any:
        threads.append(threading.current_thread().name)
        return attitudes(message)

    monkeypatch.setattr("fullpose_server.api.routes.solve.attitudes", noted)
    with connect(f"{server.ws}/solve") as stream:
        exchange(stream, OPEN)
        assert exchange(stream, ONE)["type"] == "solved"
    assert server.http.post("/solve", json={"rig": "vertical-4"} | {k: ONE[k] for k in ("time_s", "q")}).is_success
    assert len(threads) == 1  # a batch is solved in another process
    assert LOOP_THREAD not in threads
