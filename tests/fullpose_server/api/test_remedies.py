"""Remedies as jobs: asked of a plan, cancelled, made, and flown where the rig allows it."""

import math
from typing import Any

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion, euler_from_dcm
from fullpose_server.formats.plan_folder import read_plan
from tests.fullpose_server.api.live_server import LiveServer, Operator
from tests.support.waiting import until

# From rest to rest, 1250 deg/s of roll between, where the inner frame has 600.
S = np.linspace(0.0, 1.0, 121)
FAST = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(
    f"{1.2 * s},10,20,{800 * s**3 * (10 - 15 * s + 6 * s * s)}\n" for s in S
)


@pytest.fixture(scope="module")
def infeasible(server: LiveServer) -> dict[str, Any]:
    plan = server.plan(text=FAST, method="plan")
    assert (plan["status"], plan["flyable"], plan["remedy"]) == ("done", False, None)
    return plan


def asked(server: LiveServer, plan: str, **body: Any) -> dict[str, Any]:
    answer = server.http.post(f"/plans/{plan}/remedies", json=body)
    assert answer.status_code == 202, answer.text
    assert answer.headers["location"] == f"/api/v1/plans/{answer.json()['id']}"
    made: dict[str, Any] = answer.json()
    return made


def ended(server: LiveServer, plan: str) -> dict[str, Any]:
    def at_its_end() -> dict[str, Any] | None:
        made: dict[str, Any] = server.http.get(f"/plans/{plan}").json()
        return None if made["status"] in ("queued", "running") else made

    return until(at_its_end)


def test_slowed_down_it_is_a_plan_that_loads(
    server: LiveServer, operator: Operator, infeasible: dict[str, Any]
) -> None:
    queued = asked(server, infeasible["id"], kind="slow_down")
    assert queued["remedy"] == {
        "of": infeasible["id"],
        "kind": "slow_down",
        "frame": None,
        "limit": None,
        "change": None,
        "sufficient": None,
        "alternatives": [],
    }
    made = ended(server, queued["id"])
    assert (made["status"], made["flyable"], made["refusal"]) == ("done", True, None), made["error"]
    change = made["remedy"]["change"]
    assert made["remedy"]["sufficient"] is True
    assert change["unit"] == "times"
    assert 1.1 < change["value"] < 1250 / 600 * 1.02
    assert made["duration_s"] == pytest.approx(1.2 * change["value"], rel=0.01)
    assert f"{change['value']:.4g} times as slow" in change["statement"]
    assert made["margins"]["inner"]["rate_deg_s"]["value"] >= 0.0
    assert operator.command("load", plan=made["id"]).is_success
    # The very flight, later: its last attitude is the same.
    folder = read_plan(server.settings.data_dir / "plans" / made["id"])
    last = folder.target[folder.info.samples - folder.info.lead_out_samples - 1]
    np.testing.assert_allclose(
        np.rad2deg(euler_from_dcm(dcm_from_quaternion(last[None]))).ravel(), [10.0, 20.0, 80.0], atol=0.5
    )
    assert operator.command("unload").is_success


def test_a_raised_limit_must_be_the_rigs_before_it_is_flown(
    server: LiveServer, operator: Operator, infeasible: dict[str, Any]
) -> None:
    made = ended(server, asked(server, infeasible["id"], kind="relax", frame="inner", limit="rate")["id"])
    assert made["status"] == "done", made["error"]
    change = made["remedy"]["change"]
    assert (change["what"], change["unit"]) == ("inner rate", "deg/s")
    assert 600.0 < change["value"] < 1300.0
    assert made["feasible"] is True
    assert made["flyable"] is False
    assert change["statement"] in made["refusal"]
    assert made["report"]["peak"]["inner"]["rate_deg_s"] <= change["value"] * (1 + 1e-6)
    answer = operator.command("load", plan=made["id"])
    assert (answer.status_code, answer.json()["type"]) == (409, "urn:fullpose:problem:not-flyable")


def test_where_no_limit_alone_is_enough_the_job_fails_with_the_reason(
    server: LiveServer, infeasible: dict[str, Any]
) -> None:
    made = ended(server, asked(server, infeasible["id"], kind="relax", frame="outer", limit="acceleration")["id"])
    assert made["status"] == "failed"
    assert made["error"]["code"] == "no-remedy"
    assert "outer acceleration" in made["error"]["message"]


def test_a_search_is_cancelled_before_its_end(server: LiveServer, infeasible: dict[str, Any]) -> None:
    job = asked(server, infeasible["id"], kind="mounting_offset")["id"]

    def searching() -> dict[str, Any] | None:
        progress: dict[str, Any] = server.http.get(f"/plans/{job}").json()["progress"]
        return progress if progress["phase"] == "solve" and progress["done"] >= 1 else None

    progress = until(searching)
    assert 0.0 < progress["fraction"] < 1.0
    assert server.http.delete(f"/plans/{job}").status_code == 204
    assert ended(server, job)["status"] == "cancelled"  # one that went on to its end would be done


def test_a_flight_that_fits_needs_no_limit_raised(server: LiveServer) -> None:
    plan = server.plan(method="plan")
    assert plan["report"]["verdict"]["decided_by"] == "checked"
    assert plan["report"]["verdict"]["statement"] == plan["verdict"]
    assert plan["report"]["leads"]["lead_in_s"] == pytest.approx(plan["lead_in_s"])
    made = ended(server, asked(server, plan["id"], kind="relax")["id"])
    assert (made["status"], made["flyable"]) == ("done", True), (made["error"], made["refusal"])
    assert made["remedy"]["sufficient"] is True
    assert made["remedy"]["change"]["what"] == "nothing"
    assert made["remedy"]["change"]["statement"] == "flown as it is: no limit need be raised"


def test_a_frame_that_the_rig_has_not_is_refused_at_once(server: LiveServer) -> None:
    plan = server.plan("vertical-3", "three_axis")
    answer = server.http.post(f"/plans/{plan['id']}/remedies", json={"kind": "relax", "frame": "base"})
    assert answer.status_code == 422
    assert "vertical-3 has no base frame" in answer.json()["detail"]


def test_a_start_outside_the_range_is_refused_at_once(server: LiveServer) -> None:
    sha256 = server.upload().json()["sha256"]
    body = {"trajectory": sha256, "rig": "vertical-limited", "start_deg": [0, 0, 0, 70]}
    answer = server.http.post("/plans", json=body)
    assert answer.status_code == 422
    assert "start_deg[3] (inner): 70.0: expected -60 to 60 deg" in answer.json()["detail"]


def test_what_cannot_be_asked(server: LiveServer, infeasible: dict[str, Any]) -> None:
    for plan, body, status in (
        (infeasible["id"], {"kind": "magic"}, 422),
        (infeasible["id"], {"kind": "slow_down", "frame": "base"}, 422),
        (infeasible["id"], {"kind": "relax", "frame": "middel"}, 422),
        ("nothing", {"kind": "slow_down"}, 404),
    ):
        assert server.http.post(f"/plans/{plan}/remedies", json=body).status_code == status


def test_margins_tell_how_near_a_plan_comes(server: LiveServer) -> None:
    plan = server.plan()
    margins = plan["margins"]
    for frame, limit in (("base", 200.0), ("inner", 600.0)):
        peak = plan["report"]["peak"][frame]["rate_deg_s"]
        assert margins[frame]["rate_deg_s"]["value"] == pytest.approx(limit - peak, abs=1e-6 * limit)
        assert 0.0 <= margins[frame]["rate_deg_s"]["time_s"] <= plan["duration_s"]
    assert 0.0 < margins["singularity"]["value"] <= 2.0
    assert math.isfinite(margins["singularity"]["time_s"])
