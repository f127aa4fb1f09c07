"""A server whose rows are in a PostgreSQL: the whole of it, what it is when that hangs, and what is there after."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.store.belonging import ForeignDatabaseError
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tests.support.postgresql import Server, programs, running_postgresql
from tests.support.waiting import until


@pytest.fixture(scope="module")
def own() -> Iterator[Server]:
    """One that the tests may hurt."""
    if programs() is None:
        pytest.skip("PostgreSQL is not installed (Debian's package: postgresql)")
    with running_postgresql() as server:
        yield server


def flown(server: LiveServer) -> str:
    """A flight, flown on the demo's rig; the plan."""
    plan, operator = server.plan(), Operator(server)
    operator.to_idle()
    for word, args in (("load", {"plan": plan["id"]}), ("arm", {}), ("start", {})):
        assert operator.command(word, **args).status_code == 200
    operator.wait("running")
    operator.wait("armed")
    return str(plan["id"])


def test_a_flight_is_uploaded_planned_flown_and_there_after_a_restart(own: Server, tmp_path: Path) -> None:
    url = own.made().url
    with live_server(tmp_path / "data", rig_rate_hz=500.0, database_url=url) as server:
        plan = flown(server)
        server.http.patch(f"/plans/{plan}", json={"tags": ["release"]})
        (run,) = until(lambda: [one for one in server.http.get("/runs").json() if one["complete"]])
        evidence = server.http.get(f"/runs/{run['id']}/evidence", timeout=300.0)
        assert (evidence.status_code, evidence.content[:2]) == (200, b"PK")
        assert server.http.get("/health").json()["status"] == "ok"
    assert not (tmp_path / "data" / "fullpose.db").exists()
    with live_server(tmp_path / "data", rig_rate_hz=500.0, database_url=url) as server:
        assert [row["id"] for row in server.http.get("/plans", params={"tag": "release"}).json()] == [plan]
        assert [row["id"] for row in server.http.get("/runs", params={"tag": "release"}).json()] == [run["id"]]
        words = [row["command"] for row in server.http.get("/audit").json()]
        assert {"load", "arm", "start", "POST /plans"} <= set(words)
    with pytest.raises(ForeignDatabaseError), live_server(tmp_path / "other", database_url=url):
        pass


def test_one_that_hangs_delays_neither_stop_nor_lease_and_is_said(own: Server, tmp_path: Path) -> None:
    with live_server(tmp_path / "data", rig_rate_hz=500.0, database_url=own.made().url) as server:
        plan, operator = server.plan(), Operator(server)
        operator.to_idle()
        operator.command("load", plan=plan["id"])
        operator.command("arm")
        own.stop_answering()
        try:
            assert server.http.get("/trajectories").status_code == 503
            assert operator.command("start").status_code == 200
            operator.wait("running", "positioning")
            stopped = server.http.post(f"/rigs/{operator.rig}/stop")
            assert stopped.status_code == 200
            operator.wait("armed")
            assert operator.lease("renew").status_code == 200
            told = until(lambda: [one for one in server.http.get("/health").json()["warnings"] if "audit" in one])
            assert "the database does not answer" in told[0]
        finally:
            own.answer()
        until(lambda: "stop" in [row["command"] for row in server.http.get("/audit").json()])
