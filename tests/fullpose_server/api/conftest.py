"""One server for a test module; its rigs are processes of their own."""

from collections.abc import Iterator

import pytest

from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    with live_server(tmp_path_factory.mktemp("data"), max_upload_bytes=200_000, rig_rate_hz=500.0) as live:
        yield live


@pytest.fixture
def operator(server: LiveServer) -> Operator:
    made = Operator(server)
    made.to_idle()
    return made


@pytest.fixture(scope="module")
def run(server: LiveServer) -> str:
    """A flight, flown."""
    operator = Operator(server)
    operator.to_idle()
    plan = server.plan()
    operator.command("load", plan=plan["id"])
    operator.command("arm")
    operator.command("start")
    operator.wait("running")
    operator.wait("armed")
    operator.to_idle()
    for _ in range(200):
        runs = server.http.get("/runs").json()
        if runs and runs[0]["complete"]:
            assert runs[0]["plan_hash"] == plan["plan_hash"]
            return str(runs[0]["id"])
    raise AssertionError(f"no complete run: {runs}")
