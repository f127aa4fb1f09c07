"""The audit of a server that serves: who did what from where, changes beside the session too; proved meanwhile."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.store.hash_chain import GENESIS, is_as_written
from tests.fullpose_server.api.live_server import LiveServer, Operator


def verify(folder: Path, *more: str) -> tuple[int, str]:
    done = CliRunner().invoke(build(), ["audit", "verify", "--data-dir", str(folder), *more])
    return done.exit_code, done.output


def test_every_line_says_from_where(operator: Operator, server: LiveServer) -> None:
    assert server.http.post("/rigs/vertical-4/estop").status_code == 200
    operator.to_idle()
    lines = server.http.get("/audit", params={"rig": "vertical-4"}).json()
    assert {"estop", "acknowledge", "reset"} <= {line["command"] for line in lines}
    assert {line["address"] for line in lines} == {"127.0.0.1"}


def test_what_changes_something_is_in_it(server: LiveServer) -> None:
    sha256 = server.upload().json()["sha256"]
    plan = server.plan()["id"]
    assert server.http.delete(f"/trajectories/{sha256}").status_code == 409
    assert server.http.delete(f"/plans/{plan}").status_code == 204
    assert server.http.delete("/runs/nothing").status_code == 404
    assert server.http.put("/runs/nothing/pin").status_code == 404
    assert server.http.get("/plans").status_code == 200  # changes nothing
    lines = server.http.get("/audit").json()[:6]
    told = [(line["command"], line["args"], line["accepted"], line["who"], line["address"]) for line in reversed(lines)]
    by = "ann", "127.0.0.1"
    assert told == [
        ("POST /trajectories", {"made": f"/trajectories/{sha256}"}, True, *by),
        ("POST /plans", {"made": f"/plans/{plan}"}, True, *by),
        ("DELETE /trajectories/{sha256}", {"sha256": sha256}, False, *by),
        ("DELETE /plans/{plan}", {"plan": plan}, True, *by),
        ("DELETE /runs/{run}", {"run": "nothing"}, False, *by),
        ("PUT /runs/{run}/pin", {"run": "nothing"}, False, *by),
    ]
    assert lines[3]["detail"].startswith("in-use: ")
    assert {line["state_after"] for line in lines} == {None}


def test_the_lines_prove_each_other_while_the_server_serves(operator: Operator, server: LiveServer) -> None:
    folder = server.settings.data_dir
    lines = server.http.get("/audit", params={"limit": 1000}).json()[::-1]
    assert lines[0]["previous"] == GENESIS
    assert [line["previous"] for line in lines[1:]] == [line["hash"] for line in lines[:-1]]
    status, output = verify(folder)
    assert (status, f"{len(lines)} lines" in output, lines[-1]["hash"] in output) == (0, True, True)
    server.upload()
    server.http.get("/audit")
    status, output = verify(folder, "--expect", lines[-1]["hash"].upper())
    assert (status, f"{len(lines) + 1} lines" in output) == (0, True)
    listed = CliRunner().invoke(build(), ["audit", "list", "--data-dir", str(folder)]).stdout.splitlines()
    assert [json.loads(line)["hash"] for line in listed[: len(lines)]] == [line["hash"] for line in lines]
    assert all(is_as_written(json.loads(line)) for line in listed)


@pytest.mark.parametrize("expect", ["f" * 64, "0x12", ""])
def test_a_hash_that_is_not_there_is_told(server: LiveServer, expect: str) -> None:
    status, output = verify(server.settings.data_dir, "--expect", expect)
    assert (status, "fullpose: " in output) == (2, True)


def test_no_database_is_one_line(tmp_path: Path) -> None:
    done = CliRunner().invoke(build(), ["audit", "verify", "--data-dir", str(tmp_path / "nothing")])
    assert "the database of a server" in str(done.exception)
