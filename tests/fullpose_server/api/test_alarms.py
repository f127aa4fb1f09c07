"""The alarm history by the API: it outlives rig processes and servers, and so do the shelves."""

import os
import signal
import sqlite3
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tests.support.waiting import until

RATE_HZ = 500.0


def estopped(server: LiveServer) -> dict[str, Any]:
    """An E-stop on an idle rig: its alarm, as the history has it."""
    operator = Operator(server)
    operator.to_idle()
    server.http.post("/rigs/vertical-4/estop")
    operator.wait("estopped")
    newest: dict[str, Any] = server.http.get("/alarms", params={"code": "estop"}).json()[0]
    return newest


def locked_history_is_told(server: LiveServer, database: Path) -> None:
    """Raised while the database is locked: nobody waits, health says so, and the row comes."""
    locked = sqlite3.connect(database, isolation_level=None)
    locked.execute("BEGIN EXCLUSIVE")
    server.http.post("/rigs/vertical-4/estop")
    until(lambda: [w for w in server.http.get("/health").json()["warnings"] if "written to the alarm history" in w])
    locked.execute("ROLLBACK")
    locked.close()
    until(lambda: server.http.get("/alarms", params={"code": "estop"}).json())


def test_history_and_shelves_outlive_server_and_rig_process(tmp_path: Path) -> None:
    with live_server(tmp_path, rig_rate_hz=RATE_HZ) as server:
        operator = Operator(server)
        operator.to_idle()
        locked_history_is_told(server, tmp_path / "fullpose.db")
        (first,) = server.http.get("/alarms", params={"code": "estop"}).json()
        told = (first["rig"], first["severity"], first["standing"], first["first"], first["acknowledged_s"])
        assert told == ("vertical-4", "emergency", True, True, None)
        operator.to_idle()
        (seen,) = server.http.get("/alarms", params={"code": "estop"}).json()
        assert (seen["id"], seen["standing"], seen["acknowledged_by"]) == (first["id"], False, "ann")
        assert seen["acknowledged_s"] >= seen["time_s"]
        assert operator.command("shelve", code="lateness", minutes=60.0, reason="known").status_code == 200
        assert operator.command("shelve", code="late", minutes=60.0).status_code == 422
        (shelf,) = operator.session()["shelves"]
        pid = operator.session()["health"]["rig_pid"]
        os.kill(pid, signal.SIGKILL)
        until(lambda: operator.session()["health"]["rig_pid"] != pid and operator.session()["health"]["rig_alive"])
        assert operator.session()["shelves"] == [shelf]
        assert (
            server.http.get("/alarms", params={"code": "rig_process_lost", "standing": True}).json()[0]["number"] == 1
        )
        earlier = {row["id"] for row in server.http.get("/alarms").json()}
        assert first["id"] in earlier
    with live_server(tmp_path, rig_rate_hz=RATE_HZ) as server:
        rows = server.http.get("/alarms").json()
        assert earlier <= {row["id"] for row in rows}
        assert not any(row["standing"] for row in rows)
        second = estopped(server)
        assert Operator(server).session()["shelves"] == [shelf]
        assert second["id"] not in earlier
        pages_and_filters(server, first, second)


def pages_and_filters(server: LiveServer, first: dict[str, Any], second: dict[str, Any]) -> None:
    page = server.http.get("/alarms", params={"limit": 1, "code": "estop"})
    assert [row["id"] for row in page.json()] == [second["id"]]
    rest = server.http.get(f"{server.url}{page.links['next']['url']}")
    assert [row["id"] for row in rest.json()] == [first["id"]]
    assert "next" not in rest.links
    between = datetime.fromtimestamp((first["time_s"] + second["time_s"]) / 2, UTC).isoformat()
    for query, found in (
        ({"standing": True}, [second["id"]]),
        ({"standing": False}, [first["id"]]),
        ({"from": between}, [second["id"]]),
        ({"to": between}, [first["id"]]),
        ({"severity": "warning"}, []),
        ({"rig": "horizontal-4"}, []),
    ):
        asked = {"code": "estop", **query}
        assert [row["id"] for row in server.http.get("/alarms", params=asked).json()] == found, query
    assert server.http.get("/alarms", params={"severity": "dire"}).status_code == 422
    assert server.http.get("/alarms", params={"from": "yesterday"}).status_code == 422
    whole = [line["id"] for line in server.http.get("/audit", params={"limit": 1000}).json()]
    found, asked_for = [], "/api/v1/audit?limit=3"
    while asked_for:
        part = server.http.get(f"{server.url}{asked_for}")
        found += [line["id"] for line in part.json()]
        asked_for = part.links.get("next", {}).get("url", "")
    assert found == whole
    assert len(whole) > 3
