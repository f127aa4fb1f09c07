"""Comparisons over HTTP."""

import time
from pathlib import Path
from typing import Any

from server.store.comparisons import Comparisons
from tests.server.api.live_server import LiveServer


def ask(server: LiveServer, **changes: Any) -> dict[str, Any]:
    sha256 = server.upload().json()["sha256"]
    body = {"trajectory": sha256, "rig": "vertical-4", "methods": ["exact", "lagrange", "three_axis"], **changes}
    answer = server.http.post("/compare", json=body)
    assert answer.status_code == 202, answer.text
    job: dict[str, Any] = answer.json()
    assert answer.headers["location"] == f"/api/v1/compare/{job['id']}"
    return job


def finished(server: LiveServer, job: dict[str, Any]) -> dict[str, Any]:
    while job["status"] in ("queued", "running"):
        time.sleep(0.05)
        job = server.http.get(f"/compare/{job['id']}").json()
    return job


def test_a_comparison_is_a_job_with_a_report_and_a_page(server: LiveServer) -> None:
    asked = ask(server, start_deg=[0, 0, 0, 0])
    assert asked["report"] is None
    job = finished(server, asked)
    assert job["status"] == "done", job["error"]
    report = job["report"]
    assert report["schema"] == "fullpose.comparison/1"
    assert "quaternion spline" in report["resampling"]
    assert [method["method"] for method in report["methods"]] == ["exact", "lagrange", "three_axis"]
    assert report["methods"][0]["exact_share"] == 1.0
    page = server.http.get(f"/compare/{job['id']}/page")
    assert page.headers["content-type"].startswith("text/html")
    assert "flight on vertical-4" in page.text
    listed = server.http.get("/compare").json()
    assert [row["id"] for row in listed if row["id"] == job["id"]] == [job["id"]]
    assert listed[0]["report"] is None


def test_a_method_that_does_not_apply_is_told_apart(server: LiveServer) -> None:
    job = finished(server, ask(server, rig="vertical-3", methods=["three_axis", "alm"]))
    assert job["status"] == "done"
    assert "fourth axis" in job["report"]["methods"][1]["refusal"]
    assert "base" not in {frame for frame, peak in job["report"]["methods"][0]["peak"].items() if peak}


def test_refusals(server: LiveServer) -> None:
    sha256 = server.upload().json()["sha256"]
    body = {"trajectory": sha256, "rig": "vertical-4", "methods": ["exact", "magic"]}
    answer = server.http.post("/compare", json=body)
    assert answer.status_code == 422
    assert "magic" in answer.json()["detail"]
    assert server.http.post("/compare", json={**body, "methods": []}).status_code == 422
    assert server.http.post("/compare", json={**body, "methods": ["exact"], "rig": "none"}).status_code == 404
    unknown = {**body, "methods": ["exact"], "trajectory": "0" * 64}
    assert server.http.post("/compare", json=unknown).status_code == 404
    assert server.http.get("/compare/0123456789abcdef").status_code == 404
    assert server.http.get("/compare/0123456789abcdef/page").status_code == 404


def test_cancel_then_remove(server: LiveServer) -> None:
    first = ask(server, methods=["plan", "exact"])
    second = ask(server, methods=["exact"])
    assert server.http.get(f"/compare/{second['id']}/page").status_code == 409
    assert server.http.delete(f"/compare/{second['id']}").status_code == 204  # still waiting for its turn
    assert server.http.get(f"/compare/{second['id']}").json()["status"] == "cancelled"
    assert server.http.delete(f"/compare/{first['id']}").status_code == 204
    job = finished(server, first)
    assert job["status"] == "cancelled"
    assert job["error"]["code"] == "cancelled"
    for gone in (first, second):
        assert server.http.delete(f"/compare/{gone['id']}").status_code == 204
        assert server.http.get(f"/compare/{gone['id']}").status_code == 404


def test_found_again_by_the_next_server(server: LiveServer) -> None:
    done = finished(server, ask(server, methods=["exact"]))
    root: Path = server.settings.data_dir / "comparisons"
    half = root / "00000000deadbeef"
    half.mkdir()
    (half / "request.json").write_text((root / done["id"] / "request.json").read_text(), encoding="utf-8")
    again = Comparisons(root)
    assert again.get(done["id"]).status == "done"
    report = again.report(done["id"])
    assert report is not None
    assert report["methods"][0]["exact_share"] == done["report"]["methods"][0]["exact_share"]
    assert again.get("00000000deadbeef").status == "interrupted"
