"""Runs: what was flown is listed, tells its errors, and goes out whole in every format."""

import csv
import io
import os
import time
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from server.api.run_files import RunFiles
from server.runtime.record import RunRecord
from server.runtime.replay import read_samples
from server.runtime.telemetry import SAMPLE
from tests.server.api.live_server import LiveServer


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
    deadline = time.monotonic() + 10.0  # it goes once the last byte is sent
    while left := list((server.settings.data_dir / "exports").iterdir()):
        assert time.monotonic() < deadline, left
        time.sleep(0.01)


def test_what_is_no_run(server: LiveServer, run: str) -> None:
    for name in ("nothing", "..%2f..%2ffullpose"):
        assert server.http.get(f"/runs/{name}").status_code == 404
    assert server.http.get(f"/runs/{run}/export", params={"format": "xlsx"}).status_code == 422
    (server.settings.data_dir / "runs" / "broken.mcap").write_bytes(b"not a record")
    assert server.http.get("/runs/broken").status_code == 422
    assert server.http.get("/runs/broken/export").status_code == 422
    assert [line["id"] for line in server.http.get("/runs").json()] == [run]


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
    long_ago = time.time() - 60.0
    os.utime(path, (long_ago, long_ago))
    (cut_off,) = runs.all()
    assert (cut_off.samples, cut_off.lost_samples, cut_off.complete) == (9000, 0, False)
    assert path.with_suffix(".json").is_file()
    assert runs.get(path.stem) == cut_off
    np.testing.assert_array_equal(read_samples(path, 5000, 4500)["seq"], np.arange(5001, 9001))
    np.testing.assert_array_equal(read_samples(path, 0, 4097)["seq"], np.arange(1, 4098))
    record.finish()
    assert runs.get(path.stem).complete
