"""The plane of time and base angle of a plan over HTTP, and on the plot page."""

import base64
from typing import Any

import httpx
import numpy as np
import pytest

from fullpose_server.api.planes import Planes
from tests.fullpose_server.api.live_server import LiveServer

RIG = """name = "{name}"
geometry = "vertical-4"
[frames.inner]
min_deg = -60.0
max_deg = 60.0
max_rate_deg_s = {rate}
"""
SLOW = "".join(f"[frames.{frame}]\nmax_rate_deg_s = 2.0\n" for frame in ("base", "outer", "middle"))
KEYS = {"position": "position_deg", "rate": "rate_deg_s", "acceleration": "acceleration_deg_s2"}


def refused(answer: httpx.Response, status: int, code: str) -> str:
    """What a problem document of this status and code says."""
    assert answer.status_code == status, answer.text
    assert answer.json()["type"] == f"urn:fullpose:problem:{code}"
    return str(answer.json()["detail"])


def cells(seen: dict[str, Any], name: str, kind: str) -> np.ndarray:
    raw = np.frombuffer(base64.b64decode(seen[name]), kind)
    return raw.reshape(2, len(seen["time_s"]), seen["rows"])


def test_the_plane_of_a_plan(server: LiveServer) -> None:
    plan = server.plan("vertical-limited", "plan")
    answer = server.http.get(f"/plans/{plan['id']}/plane", params={"columns": 50, "rows": 40})
    assert answer.status_code == 200, answer.text
    seen = answer.json()
    margin, limits = cells(seen, "margin", "i1"), cells(seen, "limits", "u1")
    assert margin.shape == (2, 50, 40)
    assert seen["time_s"][0] == 0.0
    assert seen["time_s"][-1] == pytest.approx(plan["duration_s"])
    assert (limits % 16 <= 12).all()
    # The plan is as tight as its margins say, and where they say.
    tightest = seen["tightest"]
    own = plan["margins"][tightest["frame"]][KEYS[tightest["limit"]]]
    assert tightest["time_s"] == pytest.approx(own["time_s"], abs=0.01)
    assert f"the {tightest['frame']} frame's {tightest['limit']} limit" in tightest["sentence"]
    assert tightest["margin"] == min(seen["path"]["margin"])
    # No path leaves more of ranges and rates than the colour beneath it, but for the grid.
    low, high = seen["base_deg"]
    rows = np.round((np.array(seen["path"]["base_deg"]) - low) / (high - low) * 39).astype(int)
    beneath = margin[seen["path"]["side"], np.arange(50), rows]
    assert (np.array(seen["path"]["margin"]) <= beneath + 5).all()
    again = server.http.get(f"/plans/{plan['id']}/plane", params={"columns": 50, "rows": 40})
    assert again.content == answer.content


def test_a_plan_that_is_not_feasible_has_one_too(server: LiveServer) -> None:
    (server.settings.data_dir / "rigs" / "slow.toml").write_text(RIG.format(name="slow", rate=2.0) + SLOW)
    plan = server.plan("slow", "exact")
    assert not plan["feasible"]
    seen = server.http.get(f"/plans/{plan['id']}/plane", params={"columns": 20, "rows": 20}).json()
    # The limits are kept and the attitude is not; a time at which no base angle does shows why.
    assert seen["tightest"]["sentence"].endswith(f"the {seen['tightest']['frame']} frame's rate limit, 0 % left.")
    assert (cells(seen, "margin", "i1")[:, -1] < 0).all()
    assert (cells(seen, "margin", "i1")[:, 0] >= 0).any()


def test_what_has_no_plane_says_why(server: LiveServer) -> None:
    refused(server.http.get("/plans/none/plane"), 404, "not-found")
    three = server.plan("vertical-3", "three_axis")
    assert "three axes" in refused(server.http.get(f"/plans/{three['id']}/plane"), 409, "no-plane")
    file = server.settings.data_dir / "rigs" / "changing.toml"
    file.write_text(RIG.format(name="changing", rate=600.0))
    plan = server.plan("changing", "exact")
    file.write_text(RIG.format(name="changing", rate=500.0))
    refused(server.http.get(f"/plans/{plan['id']}/plane"), 409, "rig-changed")
    refused(server.http.get(f"/plans/{plan['id']}/plane", params={"columns": 1}), 422, "validation")
    refused(server.http.get(f"/plans/{plan['id']}/plane", params={"rows": 100_000}), 422, "validation")


def test_what_was_asked_for_last_is_kept() -> None:
    kept = Planes(most=10)
    kept.put("a", b"12345")
    kept.put("b", b"1234")
    assert kept.get("a") == b"12345"
    kept.put("c", b"123")  # b was not asked for the longest
    assert (kept.get("a"), kept.get("b"), kept.get("c")) == (b"12345", None, b"123")
    kept.put("c", b"1")
    kept.put("d", b"1234")
    assert kept.get("a") == b"12345"
    kept.put("e", b"more than there is room for")
    assert all(kept.get(key) is None for key in "abcde")
