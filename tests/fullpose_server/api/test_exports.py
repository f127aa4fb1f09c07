"""Plans and runs as files: every kind, by the ids that people see."""

from pathlib import Path

import numpy as np
import pytest

from fullpose_server.formats.exporters.registry import ExportKind
from fullpose_server.formats.plan_folder import read_plan
from fullpose_server.runtime.recording.mcap_reader import read_samples
from tests.fullpose_server.api.live_server import LiveServer
from tests.support.exported import READERS
from tests.support.waiting import until


def downloaded(server: LiveServer, what: str, kind: ExportKind, folder: Path) -> Path:
    answer = server.http.get(f"/{what}/export", params={"format": kind})
    assert answer.status_code == 200, answer.text
    assert f'filename="{what.split("/")[1]}.{kind}"' in answer.headers["content-disposition"]
    path = folder / f"out.{kind}"
    path.write_bytes(answer.content)
    return path


def test_the_kinds_are_listed_with_what_the_server_needs_for_them(server: LiveServer) -> None:
    rows = server.http.get("/exports").json()
    assert [row["format"] for row in rows] == list(ExportKind)
    assert all(row["available"] for row in rows)
    assert {row["install"] for row in rows} == {None, "pip install 'fullpose[tdms]'", "pip install 'fullpose[mdf]'"}


def test_a_plan_goes_out_as_every_kind(server: LiveServer, tmp_path: Path) -> None:
    plan = server.plan()["id"]
    angles = np.rad2deg(read_plan(server.settings.data_dir / "plans" / plan).angles)
    for kind in ExportKind:
        back = READERS[kind](downloaded(server, f"plans/{plan}", kind, tmp_path))
        np.testing.assert_array_equal(back["middle_deg"], angles[:, 2])
        assert abs(back["middle_rate_deg_s"]).max() > 0.0
    until(lambda: not list((server.settings.data_dir / "uploads").iterdir()))  # they go once the last byte is sent


def test_a_run_goes_out_as_every_kind(server: LiveServer, run: str, tmp_path: Path) -> None:
    rows = read_samples(server.settings.data_dir / "runs" / f"{run}.mcap")
    for kind in (ExportKind.MAT, ExportKind.TDMS, ExportKind.MF4, ExportKind.PLAYBACK):
        back = READERS[kind](downloaded(server, f"runs/{run}", kind, tmp_path))
        name = "outer_deg" if kind is ExportKind.PLAYBACK else "demand_outer_deg"
        np.testing.assert_array_equal(back[name], rows["demand"][:, 1])


def test_what_is_no_plan_and_no_kind(server: LiveServer) -> None:
    assert server.http.get("/plans/0123/export").status_code == 404
    assert server.http.get("/plans/0123/export", params={"format": "xlsx"}).status_code == 422


def test_a_plan_that_a_server_lacks_the_library_for(server: LiveServer, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = server.plan()["id"]
    monkeypatch.setattr("fullpose_server.formats.exporters.registry.find_spec", lambda _name: None)
    answer = server.http.get(f"/plans/{plan}/export", params={"format": "mf4"})
    assert (answer.status_code, answer.json()["type"]) == (422, "urn:fullpose:problem:file")
    assert "pip install 'fullpose[mdf]'" in answer.json()["detail"]
    rows = {row["format"]: row["available"] for row in server.http.get("/exports").json()}
    assert (rows["mf4"], rows["mat"]) == (False, True)
