"""What a request may cost: each bound is met by a hostile client, and answered by a problem that names it."""

import io
import json
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fullpose_server.settings import Settings
from tests.fullpose_server.api.live_server import LiveServer, live_server

GUIDE = Path(__file__).parents[3] / "docs" / "guide" / "deployment.md"
MB = 1_000_000


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    bounds = {
        "max_upload_bytes": 80 * MB,
        "max_upload_rows": 1000,
        "max_upload_columns": 20,
        "max_upload_memory_bytes": 200 * MB,
        "max_solve_samples": 500,
        "max_json_bytes": 70 * MB,
        "max_plan_samples": 5000,
        "max_idle_s": 1.0,
    }
    with live_server(tmp_path_factory.mktemp("data"), **bounds) as live:
        yield live


def refused(answer: httpx.Response, status: int, code: str) -> str:
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["type"] == f"urn:fullpose:problem:{code}"
    return str(answer.json()["detail"])


def test_every_setting_is_in_the_guide() -> None:
    text = GUIDE.read_text("utf-8")
    missing = [name for name in Settings.model_fields if f"`FULLPOSE_{name.upper()}`" not in text]
    assert missing == []


@pytest.mark.parametrize("path", ["/plans", "/compare", "/rigs/vertical-4/commands", "/solve"])
def test_a_body_that_says_it_is_large_is_refused_before_it_is_sent(server: LiveServer, path: str) -> None:
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10.0) as connection:
        connection.sendall(
            f"POST /api/v1{path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100000000\r\n"
            "Content-Type: application/json\r\nExpect: 100-continue\r\n\r\n".encode()
        )
        assert connection.recv(65536).startswith(b"HTTP/1.1 413")


@pytest.mark.parametrize("path", ["/plans", "/compare", "/rigs/vertical-4/lease", "/solve"])
def test_a_body_in_chunks_is_counted_while_it_comes(server: LiveServer, path: str) -> None:
    def chunks() -> Iterator[bytes]:
        yield b'{"a": "'
        for _ in range(1100 if path == "/solve" else 40):
            yield b"x" * 65536

    answer = server.http.post(path, content=chunks(), headers={"content-type": "application/json"})
    assert "larger than this server takes" in refused(answer, 413, "too-large")


def test_a_body_that_stops_coming_is_given_up(server: LiveServer) -> None:
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=20.0) as connection:
        connection.sendall(
            b"POST /api/v1/plans HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100\r\n"
            b"Content-Type: application/json\r\n\r\n{"
        )
        assert connection.recv(65536).startswith(b"HTTP/1.1 408")


def parquet(columns: dict[str, Any], **options: Any) -> bytes:
    file = io.BytesIO()
    pq.write_table(pa.table(columns), file, **options)
    return file.getvalue()


def flight(rows: int, **more: Any) -> dict[str, Any]:
    names = ("time_s", "yaw_deg", "pitch_deg", "roll_deg")
    return {name: np.zeros(rows) for name in names} | more


def test_a_small_file_of_many_rows_is_refused_by_its_metadata(server: LiveServer) -> None:
    bomb = parquet(flight(20 * MB), compression="zstd")
    assert len(bomb) < 20 * MB * 32 / 1000
    assert "at most 1000 rows" in refused(server.upload(bomb, "bomb.parquet"), 413, "too-large")


def test_too_many_columns(server: LiveServer) -> None:
    wide = parquet(flight(2, **{f"c{k}": np.zeros(2) for k in range(30)}))
    assert "at most 20 columns" in refused(server.upload(wide, "wide.parquet"), 413, "too-large")
    text = ",".join(f"c{k}" for k in range(30)) + "\n"
    assert "at most 20 columns" in refused(server.upload(text), 413, "too-large")


def test_a_column_that_unpacks_to_more_than_its_rows_can_be(server: LiveServer) -> None:
    """Metadata that says so; a nested column of one row and twenty million numbers is none of ours anyway."""
    nested = pa.array([np.zeros(20 * MB)], pa.list_(pa.float64()))
    file = io.BytesIO()
    names = ["time_s", "yaw_deg", "pitch_deg", "roll_deg"]
    zero = pa.array([0.0])
    pq.write_table(pa.table([nested, zero, zero, zero], names=names), file)
    answer = server.upload(file.getvalue(), "nested.parquet")
    assert answer.status_code == 422
    assert "a column of numbers" in answer.json()["detail"]


def test_what_takes_more_memory_than_there_is_costs_its_own_process_alone(server: LiveServer) -> None:
    text = b'{"name": "f", "time_s": [' + b"1," * (30 * MB) + b"1]}"
    answer = server.http.post("/trajectories", content=text, headers={"content-type": "application/json"})
    assert "more than this server gives one request" in refused(answer, 413, "memory")
    assert server.upload().status_code in (200, 201)


def test_rows_of_text_are_counted_while_they_are_read(server: LiveServer) -> None:
    text = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k},0,0,0\n" for k in range(1001))
    assert "at most 1000 rows" in refused(server.upload(text), 413, "too-large")
    columns = {name: [0.0] * 1001 for name in ("yaw_deg", "pitch_deg", "roll_deg")}
    body = {"name": "f", "time_s": [float(k) for k in range(1001)]} | columns
    assert "at most 1000 rows" in refused(server.http.post("/trajectories", json=body), 413, "too-large")


def test_samples_of_a_batch(server: LiveServer) -> None:
    body = {"rig": "vertical-4", "time_s": list(range(501)), "q": [[1, 0, 0, 0]] * 501}
    assert "up to 500" in refused(server.http.post("/solve", json=body), 413, "too-large")


def test_a_flight_that_is_too_long_at_the_rigs_rate(server: LiveServer) -> None:
    text = "time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n6,0,0,0\n"
    sha256 = server.upload(text).json()["sha256"]
    plan = server.http.post("/plans", json={"trajectory": sha256, "rig": "vertical-4"})
    assert "at most 5 s" in refused(plan, 422, "too-long")
    body = {"trajectory": sha256, "rig": "vertical-4", "methods": ["exact"]}
    assert "at most 5 s" in refused(server.http.post("/compare", json=body), 422, "too-long")


@pytest.mark.parametrize(
    "fields", [{"convension": "ned"}, {"convention": ["nue", "ned"]}, {"file": "again"}, {"name": ["a", "b"]}]
)
def test_a_form_s_unknown_and_doubled_fields_are_refused(server: LiveServer, fields: dict[str, Any]) -> None:
    answer = server.http.post("/trajectories", files={"file": ("f.csv", b"time_s")}, data=fields)
    refused(answer, 422, "validation")


@pytest.mark.parametrize(
    ("method", "path", "allowed"),
    [
        ("PUT", "/health", "GET"),
        ("GET", "/solve", "POST"),
        ("PATCH", "/trajectories", "GET, POST"),
        ("POST", "/trajectories/abc", "GET, PATCH, DELETE"),
    ],
)
def test_a_method_that_a_path_does_not_take(server: LiveServer, method: str, path: str, allowed: str) -> None:
    answer = server.http.request(method, path)
    refused(answer, 405, "method")
    refused(server.http.delete("/trajectories/..%2F..%2Fetc"), 404, "http")  # and not 405 without an Allow
    assert answer.headers["allow"] == allowed


@pytest.mark.parametrize("key", ["\\ud800", "x" * 5000])
def test_what_json_can_say_and_text_cannot(server: LiveServer, key: str) -> None:
    body = '{"trajectory": "' + key + '", "' + key + '": 1}'
    refused(server.http.post("/plans", content=body, headers={"content-type": "application/json"}), 422, "validation")
    assert len(json.dumps(body)) < 100_000


def test_jobs_of_one_client_and_of_all(tmp_path: Path) -> None:
    with live_server(tmp_path, max_queued_jobs=4, max_queued_jobs_per_client=3) as server:
        long = "time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n200,90,20,10\n400,0,60,0\n"  # none is done while we ask
        sha256 = server.upload(long).json()["sha256"]
        slow = {"trajectory": sha256, "rig": "vertical-4", "method": "plan"}

        def ask(who: str) -> httpx.Response:
            return server.http.post("/plans", json=slow, headers={"X-Fullpose-Client": who})

        made = [ask("bob") for _ in range(3)]
        assert [one.status_code for one in made] == [202] * 3
        assert "3 jobs of bob" in refused(ask("bob"), 429, "queue-full")
        assert ask("eve").status_code == 202
        fifth = ask("joe")
        assert "4 jobs are waiting" in refused(fifth, 429, "queue-full")
        assert int(fifth.headers["retry-after"]) > 0
        assert server.http.delete(f"/plans/{made[2].json()['id']}").status_code == 204
        assert ask("joe").status_code == 202


def test_a_file_that_is_looked_at_may_be_as_large_as_an_upload(server: LiveServer) -> None:
    pad = "0" * 1500
    text = "time_s,yaw_deg,pitch_deg,roll_deg,pad\n" + "".join(f"{0.01 * k:.2f},1,2,3,{pad}\n" for k in range(1000))
    assert len(text) > server.settings.max_body_bytes
    answer = server.http.post("/reading", files={"file": ("flight.csv", text)})
    assert answer.status_code == 200, answer.text
    assert answer.json()["flight"]["samples"] == 1000
