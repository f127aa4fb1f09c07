"""The scene through the API: a plan's pose beside the rig; a payload that cannot be shown."""

from pathlib import Path

import httpx
import numpy as np
import pytest
from websockets.exceptions import InvalidStatus

from fullpose.kinematics import payload_attitude
from fullpose.rig import FRAMES, builtin_rigs
from fullpose_server.formats.plan_folder import read_plan
from tests.fullpose_server.api.live_server import LiveServer
from tests.fullpose_server.scene.browser_side import Viewer
from tests.support.sockets import connect

PREVIEW = ("preview", *FRAMES)


def viewer(server: LiveServer, name: str = "vertical-4") -> Viewer:
    return Viewer(f"ws{server.url[4:]}/scene/{name}/")


def test_a_plan_is_scrubbed_beside_the_rig(server: LiveServer) -> None:
    plan = server.plan()
    folder = read_plan(server.settings.data_dir / "plans" / plan["id"])
    rig = builtin_rigs()["vertical-4"]
    with viewer(server) as browser:
        for time_s in (0.0, 0.731, plan["duration_s"]):
            answer = server.http.post("/rigs/vertical-4/scene/pose", json={"plan_id": plan["id"], "time_s": time_s})
            assert answer.status_code == 200, answer.text
            row = round(time_s * folder.info.rate_hz) + folder.info.lead_in_samples
            assert answer.json()["angles_deg"] == pytest.approx(np.rad2deg(folder.angles[row]).tolist())
            assert answer.json()["q"] == pytest.approx(folder.target[row].tolist())
            assert answer.json()["time_s"] == pytest.approx(time_s, abs=0.5001 / folder.info.rate_hz)
            F = np.empty((3, 3))
            payload_attitude(rig.axes, np.array(folder.angles[row]), F)

            def there(seen: Viewer, F: np.ndarray = F) -> bool:
                shown = seen.nodes.get("/preview", {}).get("visible") is True
                return shown and bool(np.abs(seen.quaternion(*PREVIEW) - F.T).max() < 1e-6)

            browser.until(there)
        null = {"content": b"null", "headers": {"content-type": "application/json"}}
        assert server.http.post("/rigs/vertical-4/scene/pose", **null).json() is None
        browser.until(lambda seen: seen.nodes["/preview"]["visible"] is False)


def test_leads_have_no_attitude(server: LiveServer) -> None:
    plan = server.plan()
    assert plan["lead_out_s"] > 0.0
    late = {"plan_id": plan["id"], "time_s": plan["duration_s"] + 0.5 * plan["lead_out_s"]}
    shown = server.http.post("/rigs/vertical-4/scene/pose", json=late).json()
    assert shown["q"] is None
    assert shown["error_deg"] is None


def test_poses_that_are_not_there(server: LiveServer) -> None:
    plan = server.plan()
    end = plan["duration_s"] + plan["lead_out_s"]
    for rig, time_s, plan_id, status in (
        ("vertical-4", end + 0.01, plan["id"], 422),
        ("vertical-4", -plan["lead_in_s"] - 0.01, plan["id"], 422),
        ("vertical-4", 0.0, "nothing", 404),
        ("horizontal-4", 0.0, plan["id"], 409),
        ("nowhere", 0.0, plan["id"], 404),
    ):
        answer = server.http.post(f"/rigs/{rig}/scene/pose", json={"plan_id": plan_id, "time_s": time_s})
        assert answer.status_code == status, answer.text


def test_a_payload_that_cannot_be_shown_is_a_problem(server: LiveServer) -> None:
    rigs: Path = server.settings.data_dir / "rigs"
    rigs.mkdir(exist_ok=True)
    file = rigs / "lost-seeker.toml"
    file.write_text('name = "lost-seeker"\ngeometry = "vertical-4"\n[payload]\nmesh = "seeker.stl"\n')
    try:
        answer = httpx.get(f"{server.url}/scene/lost-seeker/")
        assert answer.status_code == 422
        assert answer.headers["content-type"] == "application/problem+json"
        assert answer.json()["type"].endswith("payload-mesh")
        assert "seeker.stl: there is no such file" in answer.json()["detail"]
        with pytest.raises(InvalidStatus) as refused, connect(f"ws{server.url[4:]}/scene/lost-seeker/"):
            pass
        assert refused.value.response.status_code == 422
    finally:
        file.unlink()
    unknown = httpx.get(f"{server.url}/scene/nowhere/")
    assert (unknown.status_code, unknown.headers["content-type"]) == (404, "application/problem+json")
