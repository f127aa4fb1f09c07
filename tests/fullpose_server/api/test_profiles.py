"""Profiles that people save on a server: by name, beside those that ship."""

import json

from tests.fullpose_server.api.live_server import LiveServer

MAP = {
    "axes": "ned",
    "time": {"column": "clock", "unit": "ms", "epoch": "first"},
    "euler": {"columns": ["psi", "theta", "phi"], "order": "ZYX", "unit": "rad"},
}
LOG = "clock,psi,theta,phi\n" + "".join(f"{20 * k},{0.01 * k},0.3,-0.2\n" for k in range(60))


def test_a_column_map_is_saved_asked_for_and_removed(server: LiveServer) -> None:
    files = {"file": ("ours.csv", LOG)}
    by_hand = server.http.post("/trajectories", data={"columns": json.dumps(MAP)}, files=files).json()
    saved = server.http.put("/profiles/ours", json={"about": "our logger", "columns": MAP})
    assert saved.status_code == 200, saved.text
    assert saved.json() == {"name": "ours", "about": "our logger", "axes": "ned", "saved": True}
    assert [each["name"] for each in server.http.get("/profiles").json() if each["saved"]] == ["ours"]
    looked = server.http.post("/reading", files=files).json()
    assert "ours" in [each["name"] for each in looked["profiles"]]
    asked = server.http.post("/trajectories", data={"profile": "ours"}, files=files).json()
    assert asked["sha256"] == by_hand["sha256"]
    preview = server.http.get(f"/trajectories/{asked['sha256']}/preview").json()
    assert abs(preview["pitch_deg"][0] - 17.188733853924695) < 1e-9
    assert server.http.delete("/profiles/ours").status_code == 204
    assert server.http.delete("/profiles/ours").status_code == 404
    refused = server.http.post("/trajectories", data={"profile": "ours"}, files=files)
    assert refused.status_code == 422
    assert "tum" in refused.json()["detail"]


def test_a_profile_that_ships_stays_as_it_is(server: LiveServer) -> None:
    assert server.http.put("/profiles/tum", json={"columns": MAP}).status_code == 409
    assert server.http.delete("/profiles/tum").status_code == 409
    assert "tum" in [each["name"] for each in server.http.get("/profiles").json() if not each["saved"]]


def test_what_is_no_name_and_no_map_is_refused(server: LiveServer) -> None:
    assert server.http.put("/profiles/..%2Frigs%2Fx", json={"columns": MAP}).status_code in (404, 422)
    assert server.http.put("/profiles/.hidden", json={"columns": MAP}).status_code == 422
    assert server.http.put("/profiles/x", json={"columns": {**MAP, "euler": None}}).status_code == 422
