"""Comparisons over HTTP."""

import json
import shutil
import threading
from pathlib import Path
from typing import Any

import pytest

from fullpose_server.api.schemas.compare import ComparisonReportOut
from fullpose_server.planning.comparisons import Comparisons
from fullpose_server.store.quarantine import Quarantine
from tests.fullpose_server.api.live_server import LiveServer
from tests.support.waiting import until


def ask(server: LiveServer, **changes: Any) -> dict[str, Any]:
    sha256 = server.upload().json()["sha256"]
    body = {"trajectory": sha256, "rig": "vertical-4", "methods": ["exact", "lagrange", "three_axis"], **changes}
    answer = server.http.post("/compare", json=body)
    assert answer.status_code == 202, answer.text
    job: dict[str, Any] = answer.json()
    assert answer.headers["location"] == f"/api/v1/compare/{job['id']}"
    return job


def finished(server: LiveServer, job: dict[str, Any]) -> dict[str, Any]:
    def ended() -> dict[str, Any] | None:
        now: dict[str, Any] = server.http.get(f"/compare/{job['id']}").json()
        return None if now["status"] in ("queued", "running") else now

    return until(ended)


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


def test_variants_have_labels_of_their_own(server: LiveServer) -> None:
    asked: list[Any] = [
        "exact",
        "alm:mode=open_loop",
        {"method": "alm", "options": {"mode": "closed_loop", "growth": 4}},
        {"method": "alm", "options": {"mode": "exact"}, "label": "the paper's"},
    ]
    job = finished(server, ask(server, methods=asked))
    assert job["status"] == "done", job["error"]
    labels = ["exact", "alm:mode=open_loop", "alm:mode=closed_loop:growth=4", "the paper's"]
    assert job["methods"] == labels
    rows = job["report"]["methods"]
    assert [row["label"] for row in rows] == labels
    assert [row["method"] for row in rows] == ["exact", "alm", "alm", "alm"]
    assert rows[2]["options"] == {"mode": "closed_loop", "growth": 4}
    # What issue 3 wants of every method, and the share as every table shows it.
    for row in rows:
        assert row["max_matrix_error"] >= 0.0
        assert row["limited_samples"] == 0
        assert (
            set(row["total_variation_deg"])
            == set(row["limit_violation_counts"])
            == {"base", "outer", "middle", "inner"}
        )
        assert set(row["limit_violation_counts"]["base"]) == {"position", "rate", "acceleration", "jerk"}
        assert 100.0 * row["exact_share"] - 0.01 < row["exact_percent"] <= 100.0 * row["exact_share"]
    assert all(
        label.replace("'", "&#x27;") in server.http.get(job["page"].removeprefix("/api/v1")).text for label in labels
    )


def test_where_no_method_applies_the_job_fails_with_the_reasons(server: LiveServer) -> None:
    job = finished(server, ask(server, rig="vertical-3", methods=["alm", "exact"]))
    assert (job["status"], job["error"]["code"]) == ("failed", "method")
    assert "alm needs the fourth axis" in job["error"]["message"]


def test_what_cannot_be_compared_is_refused_at_once(server: LiveServer) -> None:
    sha256 = server.upload().json()["sha256"]
    body = {"trajectory": sha256, "rig": "vertical-limited", "methods": ["exact"]}
    sparse = server.upload("time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n200000,1,0,0\n").json()["sha256"]
    for changes, told in (
        ({"start_deg": [0, 0, 0, 70]}, "start_deg[3] (inner): 70.0: expected -60 to 60 deg"),
        ({"start_deg": [1e7, 0, 0, 0]}, "start_deg[0] (base)"),
        ({"methods": ["exact", "exact"]}, "2 methods are called 'exact'"),
        ({"methods": ["alm", {"method": "exact", "label": "alm"}]}, "2 methods are called 'alm'"),
        ({"methods": [{"method": "alm", "options": {"speed": 1}}]}, "no option 'speed'"),
        ({"trajectory": sparse}, "200000.0: expected at most 24000 s at 500 Hz"),
    ):
        answer = server.http.post("/compare", json={**body, **changes})
        assert answer.status_code == 422, (changes, answer.text)
        assert told in answer.json()["detail"]


def test_a_report_of_an_earlier_server_is_read(server: LiveServer) -> None:
    job = finished(server, ask(server, methods=["exact"]))
    root = server.settings.data_dir / "comparisons"
    old = root / "00000000feedbeef"
    shutil.copytree(root / job["id"], old)
    for name in ("request.json", "report.json"):
        table = json.loads((old / name).read_text(encoding="utf-8"))
        if name == "request.json":
            table["methods"] = ["exact"]
        else:
            for row in table["methods"]:
                for key in ("label", "options", "exact_samples", "exact_percent"):
                    del row[key]
        (old / name).write_text(json.dumps(table), encoding="utf-8")
    again = Comparisons(root, Quarantine(root.parent / "quarantine"))
    assert [variant.label for variant in again.get("00000000feedbeef").request.methods] == ["exact"]
    report = again.report("00000000feedbeef")
    assert ComparisonReportOut.model_validate(report).methods[0].label == "exact"
    shutil.rmtree(old)


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
    again = Comparisons(root, Quarantine(root.parent / "quarantine"))
    assert again.get(done["id"]).status == "done"
    report = again.report(done["id"])
    assert report is not None
    assert report["methods"][0]["exact_share"] == done["report"]["methods"][0]["exact_share"]
    assert again.get("00000000deadbeef").status == "interrupted"


def test_a_report_is_checked_in_a_thread(server: LiveServer, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server runs in this process: its event loop has a thread of its own."""
    job = finished(server, ask(server))
    seen: list[str] = []
    check = ComparisonReportOut.model_validate

    def watched(report: dict[str, Any]) -> ComparisonReportOut:
        seen.append(threading.current_thread().name)
        return check(report)

    monkeypatch.setattr(ComparisonReportOut, "model_validate", watched)
    assert server.http.get(f"/compare/{job['id']}").json()["report"] == job["report"]
    assert len(seen) == 1
    assert seen[0].startswith("asyncio_")
