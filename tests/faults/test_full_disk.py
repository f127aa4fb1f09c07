"""The data folder's disk, really full, under a real server: what needs room says so, what needs none goes on."""

from pathlib import Path
from typing import Any

import pytest

from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tests.support.disks import fill, small_disk

MB = 1_000_000
RIG = "bench"
LONG = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 10},{k / 50},0,0\n" for k in range(1200))


def problem(answer: Any, status: int, code: str) -> str:
    assert answer.status_code == status, answer.text
    assert answer.json()["type"] == f"urn:fullpose:problem:{code}"
    return str(answer.json()["detail"])


@pytest.mark.parametrize("reserve", [8 * MB, 0])
def test_a_full_disk_refuses_uploads_and_keeps_a_flight_in_the_air(tmp_path: Path, reserve: int) -> None:
    """Without a reserve the disk itself refuses; with one it is said before."""
    with small_disk(tmp_path / "disk", 64_000) as disk:
        bounds = {"disk_reserve_bytes": reserve, "disk_alarm_bytes": 12 * MB, "rig_rate_hz": 500.0}
        (disk / "rigs").mkdir()
        rig = f'name = "{RIG}"\ngeometry = "vertical-4"\n[process]\nmin_free_mb = 0.0\n'
        (disk / "rigs" / f"{RIG}.toml").write_text(rig, encoding="utf-8")
        with live_server(disk, **bounds) as server:
            _flown_on_a_full_disk(server, disk)


def _flown_on_a_full_disk(server: LiveServer, disk: Path) -> None:
    plan = server.plan(RIG, text=LONG)
    operator = Operator(server, RIG)
    operator.to_idle()
    operator.command("load", plan=plan["id"])
    operator.command("arm")
    operator.command("start")
    operator.wait("running")
    assert not [told for told in server.http.get("/health").json()["warnings"] if "disk" in told]

    ballast = fill(disk)
    health = server.http.get("/health").json()
    assert health["status"] == "degraded"
    assert any("disk is nearly full" in told for told in health["warnings"])
    assert health["disk"]["free_bytes"] < health["disk"]["alarm_bytes"]
    problem(server.upload("time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n1,1,1,1\n"), 507, "disk-full")
    body = {"trajectory": plan["trajectory"], "rig": RIG}
    assert server.http.post("/plans", json=body).status_code in (202, 507)  # a row may find room in the log's last page
    assert server.http.get("/plans").status_code == 200
    assert server.http.get(f"/plans/{plan['id']}/samples").status_code == 200
    assert operator.lease().status_code == 200
    assert operator.session()["state"] == "running"

    ballast.unlink()
    assert server.upload().status_code in (200, 201)
    assert server.http.post(f"/rigs/{RIG}/stop").status_code == 200
    operator.wait("armed")
