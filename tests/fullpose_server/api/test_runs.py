"""Runs: what was flown is listed, tells its errors, and goes out whole in every format."""

import csv
import io
import os
import time
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from mcap.reader import make_reader

from fullpose_server.formats.exporters.registry import ExportKind
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording import run_index
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from fullpose_server.runtime.recording.run_index import RunFiles
from fullpose_server.runtime.recording.run_summary import RunSummary
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tests.fullpose_server.api.test_stream import received
from tests.support.sockets import connect
from tests.support.waiting import until


def test_a_run_tells_what_was_flown_and_how_well(server: LiveServer, run: str) -> None:
    body = server.http.get(f"/runs/{run}").json()
    assert (body["rig"], body["who"], body["lost_samples"]) == ("vertical-4", "ann", 0)
    assert body["samples"] > 2.0 * server.settings.rig_rate_hz
    assert body["max_solve_error_deg"] < 1e-12
    assert 0.0 < body["max_tracking_error_deg"] < 1.0
    assert server.http.get("/runs", params={"rig": "vertical-3"}).json() == []
    assert [line["id"] for line in server.http.get("/runs").json()] == [run]


def test_csv_parquet_and_mcap_are_the_same_samples(server: LiveServer, run: str, tmp_path: Path) -> None:
    mcap = tmp_path / "run.mcap"
    mcap.write_bytes(server.http.get(f"/runs/{run}/export", params={"format": "mcap"}).content)
    rows = read_samples(mcap)
    assert len(rows) == server.http.get(f"/runs/{run}").json()["samples"]
    answer = server.http.get(f"/runs/{run}/export", params={"format": "parquet"})
    assert f'filename="{run}.parquet"' in answer.headers["content-disposition"]
    table = pq.read_table(io.BytesIO(answer.content))
    np.testing.assert_array_equal(table.column("seq").to_numpy(), rows["seq"])
    np.testing.assert_array_equal(table.column("measured_inner_deg").to_numpy(), rows["measured"][:, 3])
    lines = list(csv.DictReader(io.StringIO(server.http.get(f"/runs/{run}/export").text)))
    assert list(lines[0]) == table.column_names
    np.testing.assert_array_equal([float(line["demand_base_deg"]) for line in lines], rows["demand"][:, 0])
    assert {line["state"] for line in lines} >= {"positioning", "running"}
    until(lambda: not list((server.settings.data_dir / "uploads").iterdir()))  # it goes once the last byte is sent


def test_what_is_no_run(server: LiveServer, run: str) -> None:
    for name in ("nothing", "..%2f..%2ffullpose"):
        assert server.http.get(f"/runs/{name}").status_code == 404
    assert server.http.get(f"/runs/{run}/export", params={"format": "xlsx"}).status_code == 422
    broken = server.settings.data_dir / "runs" / "broken.mcap"
    broken.write_bytes(b"not a record")
    assert server.http.get("/runs/broken").status_code == 422
    for kind in ExportKind:
        assert server.http.get("/runs/broken/export", params={"format": kind}).status_code == 422
    # It may be a run whose first bytes are on their way, until it has not grown for a while.
    assert [line["id"] for line in server.http.get("/runs").json()] == [run]
    make_old(broken)
    lines = {line["id"]: line for line in server.http.get("/runs").json()}
    assert set(lines) == {"broken", run}
    assert lines["broken"]["error"] == "not a record: it does not begin as one"
    assert (lines["broken"]["samples"], lines["broken"]["complete"]) == (None, False)
    assert (lines[run]["error"], lines[run]["incident"]) == (None, None)
    broken.unlink()


def within_a_chunk(record: Path) -> int:
    """Where in the file the middle of its middle chunk is: what lies between chunks nobody need miss."""
    with record.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    chunk = summary.chunk_indexes[len(summary.chunk_indexes) // 2]
    return int(chunk.chunk_start_offset + chunk.chunk_length // 2)


@pytest.mark.parametrize("damage", ["power cut", "flipped byte"])
def test_a_damaged_record_is_listed_exported_and_spoils_nothing(server: LiveServer, run: str, damage: str) -> None:
    runs = server.settings.data_dir / "runs"
    data = bytearray((runs / f"{run}.mcap").read_bytes())
    if damage == "power cut":
        data[len(data) // 2 :] = bytes(8192)
    else:
        data[within_a_chunk(runs / f"{run}.mcap")] ^= 0x55
    path = runs / "20261122T030405-vertical-4-000007.mcap"
    path.write_bytes(data)
    make_old(path)
    try:
        lines = {line["id"]: line for line in server.http.get("/runs").json()}
        assert set(lines) == {path.stem, run}
        line, sound = lines[path.stem], lines[run]
        assert (line["rig"], line["who"], line["complete"], line["error"]) == ("vertical-4", "ann", False, None)
        assert 0 < line["samples"] < sound["samples"]
        if damage == "flipped byte":
            assert line["lost_samples"] == sound["samples"] - line["samples"]
        assert server.http.get(f"/runs/{path.stem}").json() == line
        answer = server.http.get(f"/runs/{path.stem}/export", params={"format": "mcap"})
        assert f'filename="{path.name}"' in answer.headers["content-disposition"]
        repaired = server.settings.data_dir / "repaired.mcap"
        repaired.write_bytes(answer.content)
        assert is_complete(repaired)
        np.testing.assert_array_equal(read_samples(repaired)["seq"], read_samples(path)["seq"])
        assert len(read_samples(path)) == line["samples"]
        assert server.http.get(f"/runs/{path.stem}/export").text.count("\n") == line["samples"] + 1
    finally:
        path.unlink()


def test_a_whole_record_is_exported_as_it_is(server: LiveServer, run: str) -> None:
    record = server.settings.data_dir / "runs" / f"{run}.mcap"
    assert server.http.get(f"/runs/{run}/export", params={"format": "mcap"}).content == record.read_bytes()


def test_an_incident_is_listed_as_one_and_can_be_played(server: LiveServer, run: str) -> None:
    operator = Operator(server)
    operator.to_idle()
    server.http.post("/rigs/vertical-4/estop")
    operator.wait("estopped")

    def others() -> list[dict[str, object]]:
        lines = [line for line in server.http.get("/runs").json() if line["id"] != run]
        return lines if lines and lines[0]["complete"] else []

    (line,) = until(others)
    operator.to_idle()
    assert "-vertical-4-incident-" in line["id"]
    assert (line["incident"], line["rig"], line["who"]) == ("estop", "vertical-4", "ann")
    assert (line["complete"], line["plan_id"]) == (True, None)
    assert line["duration_s"] > 1.0
    with connect(f"{server.ws}/runs/{line['id']}/stream") as stream:
        assert received(stream, "hello")["rig"] == "vertical-4"
    (server.settings.data_dir / "runs" / f"{line['id']}.mcap").unlink()


def test_what_is_missing_is_counted_to_the_run_s_end(tmp_path: Path) -> None:
    path = tmp_path / "20261122T030405-vertical-4-000001.mcap"
    record = RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {}}, 10**18, 0)
    rows = np.zeros(100, SAMPLE)
    rows["seq"] = np.arange(951, 1051)
    record.add_event({"kind": "run_begin", "time_ns": 0, "wall_ns": 0, "head": 1000})
    record.add_samples(rows[:70])
    record.add_samples(rows[75:])
    record.add_event({"kind": "run_end", "time_ns": 0, "wall_ns": 0, "head": 1084})
    record.finish()
    (run,) = RunFiles(tmp_path).all()
    assert (run.samples, run.lost_samples, run.complete) == (95, 5 + 34, True)


def test_a_disk_that_is_full_does_not_hide_the_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "20261122T030405-vertical-4-000001.mcap"
    RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {}}, 10**18, 0).finish()

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    (run,) = RunFiles(tmp_path).all()
    assert (run.id, run.complete, run.error) == (path.stem, True, None)


def make_old(path: Path) -> None:
    """As one that nobody writes to any more."""
    long_ago = time.time() - 60.0
    os.utime(path, (long_ago, long_ago))


def test_a_run_that_is_being_written_is_not_read_through_and_one_that_was_cut_off_is_once(tmp_path: Path) -> None:
    path = tmp_path / "20261122T030405-vertical-4-000001.mcap"
    record = RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {"rig": "vertical-4"}}, 10**18, 0)
    rows = np.zeros(9000, SAMPLE)
    rows["seq"] = np.arange(1, 9001)
    rows["time_ns"] = rows["wall_ns"] = rows["seq"] * 10**6
    record.add_samples(rows)
    record.cut()
    runs = RunFiles(tmp_path)
    (written,) = runs.all()
    assert (written.rig, written.who, written.samples, written.complete) == ("vertical-4", "ann", None, False)
    assert written.started is not None
    assert time.gmtime(written.started)[:6] == (2026, 11, 22, 3, 4, 5)
    make_old(path)
    (cut_off,) = runs.all()
    assert (cut_off.samples, cut_off.lost_samples, cut_off.complete) == (9000, 0, False)
    assert path.with_suffix(".json").is_file()
    assert runs.get(path.stem) == cut_off
    np.testing.assert_array_equal(read_samples(path, 5000, 4500)["seq"], np.arange(5001, 9001))
    np.testing.assert_array_equal(read_samples(path, 0, 4097)["seq"], np.arange(1, 4098))
    record.finish()
    assert runs.get(path.stem).complete


def three_records(folder: Path) -> list[Path]:
    """Of eight rows each, oldest first."""
    paths = [folder / f"20261122T03040{k}-vertical-4-00000{k}.mcap" for k in range(3)]
    for path in paths:
        record = RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {}}, 10**18, 0)
        rows = np.zeros(8, SAMPLE)
        rows["seq"] = np.arange(1, 9)
        record.add_samples(rows)
        record.finish()
    return paths


def test_what_is_read_ahead_is_looked_at_no_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    three_records(tmp_path)
    runs, looked_at = RunFiles(tmp_path), []
    kept_summary = run_index.kept_summary

    def counted(path: Path) -> RunSummary | None:
        looked_at.append(path)
        return kept_summary(path)

    runs.read_ahead()
    runs.read_ahead()
    monkeypatch.setattr(run_index, "kept_summary", counted)
    runs.read_ahead()
    assert looked_at == []


def test_a_list_reads_no_more_records_than_it_has_time_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = three_records(tmp_path)
    runs = RunFiles(tmp_path)
    monkeypatch.setattr(run_index, "READING_S", 0.0)
    assert [(run.who, run.samples) for run in runs.all()] == [("ann", None)] * 3
    runs.read_ahead()
    assert [run.samples for run in runs.all()] == [8] * 3
    for path in paths:
        path.with_suffix(".json").unlink()
    runs.close()
    runs.read_ahead()
    assert [run.samples for run in runs.all()] == [8, None, None]  # the one that was in work


def test_a_run_can_be_pinned_and_deleted(server: LiveServer, run: str) -> None:
    runs = server.settings.data_dir / "runs"
    own = runs / "20261122T030405-vertical-4-000008.mcap"  # the module's run is that of other tests too, in any order
    own.write_bytes((runs / f"{run}.mcap").read_bytes())
    mine = f"/runs/{own.stem}"
    assert server.http.get(mine).json()["pinned"] is False
    assert server.http.put(f"{mine}/pin").status_code == 204
    assert [line["pinned"] for line in server.http.get("/runs").json()] == [False, True]
    refused = server.http.delete(mine)
    assert (refused.status_code, refused.json()["type"]) == (409, "urn:fullpose:problem:in-use")
    assert server.http.delete(f"{mine}/pin").status_code == 204
    assert server.http.delete(mine).status_code == 204
    assert server.http.get(mine).status_code == 404
    assert server.http.delete(mine).status_code == 404
    assert not own.exists()


def test_runs_come_in_pages(tmp_path: Path) -> None:
    names = [f"20260101T00000{k}-vertical-4-00000{k}" for k in range(5)]
    with live_server(tmp_path, max_page_rows=3) as server:
        for name in names:
            (tmp_path / "runs" / f"{name}.mcap").write_bytes(b"no record")
            os.utime(tmp_path / "runs" / f"{name}.mcap", (1.0, 1.0))
        seen, path = [], "/runs?limit=2"
        while path:
            page = server.http.get(path if path.startswith("/runs") else server.url + path)
            assert len(page.json()) <= 2
            seen += [run["id"] for run in page.json()]
            path = page.links.get("next", {}).get("url", "")
        assert seen == names[::-1]
        assert server.http.get("/runs?limit=4").status_code == 422
        assert server.http.get("/runs?before=x").status_code == 422
