"""`fullpose backup` of a server that serves, and another server on what `fullpose restore` makes of it."""

from pathlib import Path

import httpx

from tests.fullpose_server.api.live_server import FLIGHT
from tests.support.command_line import typed
from tests.support.serving import running

PATIENT_S = 300.0


def test_a_server_that_serves_is_backed_up_and_comes_back(tmp_path: Path) -> None:
    file, new = tmp_path / "b.tar", tmp_path / "new"
    with running("serve", "--port", "0", "--data-dir", tmp_path / "data") as (_, url):
        stored = httpx.post(
            f"{url}/api/v1/trajectories", files={"file": ("flight.csv", FLIGHT)}, timeout=PATIENT_S
        ).json()
        done = typed("backup", file, "--data-dir", tmp_path / "data")
        assert (done.returncode, done.stderr) == (0, "")
        assert "database revision" in done.stdout
        assert typed("restore", file, "--check").returncode == 0
        busy = typed("restore", file, "--data-dir", tmp_path / "data")
        assert (busy.returncode, busy.stderr.count("\n")) == (2, 1)
    assert typed("restore", file, "--data-dir", new).returncode == 0
    with running("serve", "--port", "0", "--data-dir", new) as (_, url):
        assert [row["sha256"] for row in httpx.get(f"{url}/api/v1/trajectories", timeout=PATIENT_S).json()] == [
            stored["sha256"]
        ]
        assert httpx.get(f"{url}/api/v1/health", timeout=PATIENT_S).json()["status"] == "ok"
