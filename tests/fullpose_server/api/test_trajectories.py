"""Uploads through a real server: what is right is stored by its hash, what is wrong is one clear problem."""

import io
import json
import math
import socket
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.fullpose_server.api.live_server import FLIGHT, LiveServer
from tests.support.waiting import until


def stored(server: LiveServer) -> int:
    return len(server.http.get("/trajectories").json())


def problem(response: Any, status: int, code: str) -> dict[str, Any]:
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    body: dict[str, Any] = response.json()
    assert body["type"] == f"urn:fullpose:problem:{code}"
    assert body["status"] == status
    return body


def test_a_csv_is_stored_once_and_can_be_seen(server: LiveServer) -> None:
    first = server.upload(file="My flight.csv")
    assert first.status_code == 201
    body = first.json()
    assert first.headers["location"] == f"/api/v1/trajectories/{body['sha256']}"
    assert (body["name"], body["samples"], body["duration_s"], body["source_format"]) == ("My flight", 101, 2.0, "csv")
    assert server.upload(file="again.csv").status_code == 200
    assert server.http.get(f"/trajectories/{body['sha256']}").json() == body
    preview = server.http.get(f"/trajectories/{body['sha256']}/preview", params={"points": 50}).json()
    assert len(preview["time_s"]) == len(preview["yaw_deg"]) == len(preview["q"]) <= 60
    assert preview["yaw_deg"][-1] == pytest.approx(40.0)
    assert server.http.delete(f"/trajectories/{body['sha256']}").status_code == 204
    problem(server.http.get(f"/trajectories/{body['sha256']}"), 404, "not-found")


def test_parquet_and_json_give_the_same_flight(server: LiveServer) -> None:
    columns = {"time_s": [0.0, 0.1], "heading_deg": [10.0, 11.0], "pitch_deg": [1.0, 2.0], "bank_deg": [3.0, 4.0]}
    file = io.BytesIO()
    pq.write_table(pa.table(columns), file)
    parquet = server.upload(file.getvalue(), "f.parquet", convention="ned", name="given name")
    assert parquet.status_code == 201, parquet.text
    assert parquet.json()["name"] == "given name"
    posted = server.http.post("/trajectories", json={"name": "json", "convention": "ned"} | columns)
    assert posted.status_code == 200, posted.text
    assert posted.json()["sha256"] == parquet.json()["sha256"]


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [
        ("", None, None),
        ("time_s,yaw_deg,pitch_deg\n0,1,2\n", 1, "roll_deg"),
        (FLIGHT + "3,nan,0,0\n", 103, "yaw_deg"),
        (FLIGHT + "1,0,0,0\n", 103, "time_s"),
        (FLIGHT + "2.0,0,0,0\n", 103, "time_s"),
        ("time_s,qw,qx,qy,qz\n0,0,0,0,0\n", 2, "qw"),
        ("\x00\x01\x02\x03", None, None),
    ],
)
def test_a_bad_file_is_one_clear_problem_and_nothing_is_stored(
    server: LiveServer, text: str, line: int | None, column: str | None
) -> None:
    before = stored(server)
    body = problem(server.upload(text, "bad.csv"), 422, "file")
    assert body["detail"].startswith("bad.csv")
    (field,) = body["errors"]
    assert (field.get("line"), field["where"]) == (line, column or "file")
    assert stored(server) == before
    assert list((server.settings.data_dir / "uploads").iterdir()) == []


def test_radians_are_warned_about(server: LiveServer) -> None:
    body = server.upload("time_s,yaw_deg,pitch_deg,roll_deg\n0,1,1,1\n0.1,1.5,1.2,3.1\n").json()
    assert [warning["column"] for warning in body["warnings"]] == ["yaw_deg", "pitch_deg", "roll_deg"]
    assert {warning["code"] for warning in body["warnings"]} == {"angle-unit"}


def test_an_unknown_convention(server: LiveServer) -> None:
    assert "xyz" in problem(server.upload(convention="xyz"), 422, "validation")["detail"]


GAP = "time_s,heading_deg,pitch_deg,bank_deg\n" + "".join(f"{0.1 * k},{k},0,0\n" for k in range(40) if not 10 < k < 25)


def test_a_gap_is_bridged_when_asked_and_kept_with_the_flight(server: LiveServer) -> None:
    body = problem(server.upload(GAP), 422, "file")
    assert "none from 1 s to 2.5 s (15 median steps)" in body["detail"]
    stored_as = server.upload(GAP, bridge_gaps="true").json()
    told = stored_as["input"]
    assert (told["profile"], told["convention"], told["format"]) == ("fullpose-ned", "ned", "csv")
    assert [warning["code"] for warning in told["warnings"]] == ["bridged"]
    assert server.http.get(f"/trajectories/{stored_as['sha256']}").json()["input"] == told


TUM = "# timestamp tx ty tz qx qy qz qw\n" + "".join(f"{0.02 * k} 0 0 0 0 0 0 1\n" for k in range(20))


def preview(server: LiveServer, text: str, **fields: str) -> dict[str, Any]:
    answer = server.http.post("/reading", data=fields, files={"file": ("flight.txt", text)})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_preview_stores_nothing_and_says_what_would_be_taken(server: LiveServer) -> None:
    before = stored(server)
    found = preview(server, TUM)
    assert (found["profile"], found["names"][0], found["head"][0][-1]) == ("tum", "timestamp", "1")
    assert found["columns"]["quaternion"]["columns"] == ["qw", "qx", "qy", "qz"]
    assert [warning["code"] for warning in found["flight"]["warnings"]] == ["axes"]
    assert found["flight"]["samples"] == 20
    assert stored(server) == before
    # The answer is a file until the last of it is sent, which is after the client has all of it.
    until(lambda: not list((server.settings.data_dir / "uploads").iterdir()))


def test_a_preview_with_columns_as_a_person_says(server: LiveServer) -> None:
    text = "a,b,c,d\n" + "".join(f"{20 * k},0.01,0.02,0.03\n" for k in range(20))
    assert "a column time_s among a, b, c, d" in preview(server, text)["problem"]
    columns: dict[str, Any] = {"axes": "ned", "time": {"column": "a", "unit": "ms"}}
    columns["euler"] = {"columns": ["b", "c", "d"], "order": "ZYX", "unit": "rad"}
    found = preview(server, text, columns=json.dumps(columns))
    assert found["problem"] is None
    np.testing.assert_allclose(found["flight"]["time_s"], 0.02 * np.arange(20), atol=1e-15)
    np.testing.assert_allclose(found["flight"]["yaw_deg"], -np.degrees(0.01), atol=1e-12)


@pytest.mark.parametrize("fields", [{"profile": "/etc/passwd.toml"}, {"strict": "perhaps"}, {"columns": "{}"}])
def test_what_is_no_way_to_read(server: LiveServer, fields: dict[str, str]) -> None:
    answer = server.upload(TUM, "flight.txt", **fields)
    assert answer.status_code == 422
    assert next(iter(fields)) in answer.json()["detail"]


def test_a_form_without_a_file_and_a_body_that_is_neither(server: LiveServer) -> None:
    problem(server.http.post("/trajectories", data={"name": "x"}, files={"other": ("a", b"b")}), 422, "validation")
    problem(server.http.post("/trajectories", content=b"x", headers={"content-type": "text/csv"}), 415, "media-type")
    broken = {"content-type": "multipart/form-data; boundary=x"}
    problem(server.http.post("/trajectories", content=b"no form at all", headers=broken), 400, "malformed-form")


@pytest.mark.parametrize(
    "change",
    [
        {"time_s": []},
        {"time_s": [0.0, "soon"]},
        {"pitch_deg": [1.0]},
        {"q": [[1, 0, 0, 0], [1, 0, 0, 0]]},
        {"convention": "xyz"},
        {"speed": 1},
    ],
)
def test_json_that_does_not_fit(server: LiveServer, change: dict[str, Any]) -> None:
    good = {"name": "f", "time_s": [0.0, 0.1], "yaw_deg": [1.0, 2], "pitch_deg": [1.0, 2], "roll_deg": [1.0, 2]}
    body = problem(server.http.post("/trajectories", json=good | change), 422, "validation")
    assert body["errors"]


def test_json_with_time_going_backward_names_the_sample(server: LiveServer) -> None:
    flight = {"name": "f", "time_s": [1.0, 0.5], "q": [[1, 0, 0, 0], [1, 0, 0, 0]]}
    assert "sample 1" in problem(server.http.post("/trajectories", json=flight), 422, "file")["detail"]


def test_an_upload_that_says_it_is_too_large_is_refused_before_it_is_sent(server: LiveServer) -> None:
    """2 GB announced, none of them sent: the answer comes at once."""
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10.0) as connection:
        connection.sendall(
            b"POST /api/v1/trajectories HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 2000000000\r\n"
            b"Content-Type: multipart/form-data; boundary=x\r\nExpect: 100-continue\r\n\r\n"
        )
        answer = connection.recv(65536)
    assert answer.startswith(b"HTTP/1.1 413")


def test_an_upload_that_turns_out_too_large_is_refused_while_it_comes(server: LiveServer) -> None:
    """Chunked, so no length is announced; the limit of this server is 200 000 bytes."""

    def chunks() -> Any:
        yield b'--x\r\nContent-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\n'
        for _ in range(40):
            yield b"1," * 5_000
        yield b"\r\n--x--\r\n"

    headers = {"content-type": "multipart/form-data; boundary=x"}
    before = stored(server)
    problem(server.http.post("/trajectories", content=chunks(), headers=headers), 413, "too-large")
    assert stored(server) == before
    assert list((server.settings.data_dir / "uploads").iterdir()) == []


def test_a_flight_in_use_cannot_be_removed(server: LiveServer) -> None:
    plan = server.plan()
    problem(server.http.delete(f"/trajectories/{plan['trajectory']}"), 409, "in-use")


@pytest.mark.parametrize("kind", ["file", "json"])
def test_one_flight_uploaded_by_many_at_once_is_stored_once(server: LiveServer, kind: str) -> None:
    with ThreadPoolExecutor(6) as pool:
        for turn in range(5):
            columns = {"time_s": [0.0, 0.1, 0.2], "yaw_deg": [10.0, 11.0, 12.0 + turn]}
            columns |= {"pitch_deg": [1.0, 2.0, 3.0], "roll_deg": [0.0, 0.0, 1.0 if kind == "file" else 2.0]}
            rows = zip(*columns.values(), strict=True)
            text = ",".join(columns) + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)

            def post(_: int, text: str = text, columns: dict[str, Any] = columns) -> Any:
                if kind == "file":
                    return server.upload(text)
                return server.http.post("/trajectories", json={"name": "f"} | columns)

            answers = list(pool.map(post, range(6)))
            assert sorted(answer.status_code for answer in answers) == [200] * 5 + [201], answers[0].text
            assert len({answer.json()["sha256"] for answer in answers}) == 1


def test_a_preview_counts_the_turns_between_the_samples_it_keeps(server: LiveServer) -> None:
    time_s = [k / 50 for k in range(3000)]
    roll = [720.0 * at for at in time_s]
    text = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{t},0,0,{r}\n" for t, r in zip(time_s, roll, strict=True))
    sha256 = server.upload(text).json()["sha256"]
    for points in (20, 200):
        preview = server.http.get(f"/trajectories/{sha256}/preview", params={"points": points}).json()
        assert len(preview["time_s"]) <= points + 7
        assert preview["roll_deg"] == pytest.approx([720.0 * at for at in preview["time_s"]], abs=1e-6)
        assert preview["roll_deg"][-1] == pytest.approx(roll[-1])


def recorded(rate_hz: int, decimals: int, samples: int = 1001) -> str:
    """A roll of sines, rounded."""
    rows = (f"{k / rate_hz},0,0,{40 * math.sin(k / rate_hz):.{decimals}f}\n" for k in range(samples))
    return "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(rows)


def test_a_flight_is_diagnosed(server: LiveServer) -> None:
    sha256 = server.upload(recorded(500, 2)).json()["sha256"]
    # Busy is an answer too, while the worker compiles what it needs for the first time.
    until(lambda: server.http.get(f"/trajectories/{sha256}/diagnosis").is_success, every_s=0.5)
    found = server.http.get(f"/trajectories/{sha256}/diagnosis").json()
    assert found["quantum"]["unit"] == 0.01
    assert found["rig"] is None
    assert found["findings"][0]["level"] == "warning"
    assert found["findings"][0]["sentence"].startswith("Angles are rounded to 0.01 deg")
    assert sum(found["plots"]["steps"]["count"]) == 1000
    on_rig = server.http.get(f"/trajectories/{sha256}/diagnosis", params={"rig": "vertical-4"}).json()
    assert on_rig["rig"]["frames"]["inner"]["noise_acceleration_deg_s2"]["median"] > 100.0
    assert "of the frames of vertical-4" in on_rig["findings"][0]["sentence"]


def test_a_diagnosis_of_what_is_not_there_is_a_problem(server: LiveServer) -> None:
    problem(server.http.get(f"/trajectories/{'0' * 64}/diagnosis"), 404, "not-found")
    sha256 = server.upload(recorded(500, 3)).json()["sha256"]
    problem(server.http.get(f"/trajectories/{sha256}/diagnosis", params={"rig": "none-4"}), 404, "not-found")
    problem(server.http.get(f"/trajectories/{sha256}/diagnosis", params={"rig": "../x"}), 422, "validation")
    assert list(server.settings.data_dir.glob("uploads/*")) == []
