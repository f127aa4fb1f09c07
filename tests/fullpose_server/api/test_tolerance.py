"""Plans, comparisons and a slider's effect within a tolerance, over HTTP."""

import json
from typing import Any

import pytest

from tests.fullpose_server.api.live_server import LiveServer, Operator
from tests.support.recorded import grid, noisy, quaternion, truth
from tests.support.waiting import until

SIGMA = 0.02


@pytest.fixture
def flight(server: LiveServer) -> str:
    time = grid(500.0, 1.5)
    q = quaternion(noisy(truth("gentle", time), SIGMA))
    answer = server.http.post("/trajectories", json={"name": "noisy", "time_s": time.tolist(), "q": q.tolist()})
    assert answer.status_code in (200, 201), answer.text
    sha256: str = answer.json()["sha256"]
    return sha256


def planned(server: LiveServer, flight: str, **more: Any) -> dict[str, Any]:
    asked = server.http.post(
        "/plans", json={"trajectory": flight, "rig": "vertical-limited", "method": "exact", **more}
    )
    assert asked.status_code == 202, asked.text

    def ended() -> dict[str, Any] | None:
        now: dict[str, Any] = server.http.get(f"/plans/{asked.json()['id']}").json()
        return None if now["status"] in ("queued", "running") else now

    return until(ended)


def test_a_plan_within_a_tolerance(server: LiveServer, flight: str) -> None:
    refused = planned(server, flight)
    assert not refused["flyable"]
    assert refused["tolerance_deg"] is None
    suggested = refused["report"]["suggested_tolerance_deg"]
    assert 3.0 * SIGMA < suggested <= 6.0 * SIGMA
    plan = planned(server, flight, tolerance_deg=suggested)
    assert plan["flyable"], plan["refusal"]
    report = plan["report"]
    assert plan["tolerance_deg"] == report["tolerance_deg"] == suggested
    assert report["within_tolerance"] is True
    assert 0.0 < report["deviation_deg"]["max"] == report["max_error_deg"] <= suggested
    path = server.settings.data_dir / "plans" / plan["id"] / "plan.json"
    stored = json.loads(path.read_text())
    assert stored["tolerance_deg"] == suggested
    operator = Operator(server, "vertical-limited")
    operator.to_idle()
    path.write_text(json.dumps(stored | {"tolerance_deg": 2.0 * suggested}))
    answer = operator.command("load", plan=plan["id"])
    assert answer.status_code == 409
    assert "tolerance_deg: not as the plan was made" in answer.json()["detail"]
    path.write_text(json.dumps(stored))
    assert operator.command("load", plan=plan["id"]).status_code == 200


def test_what_a_tolerance_does_is_told_before_a_plan(server: LiveServer, flight: str) -> None:
    asked = server.http.get(f"/trajectories/{flight}/tolerance", params={"points": 100})
    assert asked.status_code == 200, asked.text
    told = asked.json()
    assert told["needed"]
    assert told["tolerance_deg"] == told["suggested_tolerance_deg"]
    assert told["tolerance_floor_deg"] < told["deviation_deg"]["max"] < told["suggested_tolerance_deg"]
    assert told["flown"]["acceleration_deg_s2"] < 0.1 * told["recorded"]["acceleration_deg_s2"]
    assert max(told["deviation_at_deg"]) == pytest.approx(told["deviation_deg"]["max"])
    tight = 0.97 * told["deviation_deg"]["max"]
    bent = server.http.get(f"/trajectories/{flight}/tolerance", params={"tolerance_deg": tight}).json()
    assert bent["within_tolerance"]
    assert bent["deviation_deg"]["max"] <= tight == bent["tolerance_deg"]
    for wrong in (0.0, -1.0, 91.0):
        refused = server.http.get(f"/trajectories/{flight}/tolerance", params={"tolerance_deg": wrong})
        assert refused.status_code == 422
    assert server.http.get(f"/trajectories/{'0' * 64}/tolerance").status_code == 404


def test_a_comparison_within_a_tolerance(server: LiveServer, flight: str) -> None:
    body = {"trajectory": flight, "rig": "vertical-limited", "methods": ["exact"], "tolerance_deg": 0.1}
    job = server.http.post("/compare", json=body).json()

    def ended() -> dict[str, Any] | None:
        now: dict[str, Any] = server.http.get(f"/compare/{job['id']}").json()
        return None if now["status"] in ("queued", "running") else now

    report = until(ended)["report"]
    assert report["tolerance_deg"] == 0.1
    assert report["deviation_deg"]["max"] <= 0.1
    assert report["methods"][0]["feasible"]
