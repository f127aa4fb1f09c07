"""`fullpose export` of records that are whole, cut off, and none."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fullpose.rig import FRAMES, builtin_rigs
from fullpose_server.cli import build
from fullpose_server.formats.exporters.registry import ExportKind
from fullpose_server.formats.plan_folder import write_plan
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.command_line import typed
from tests.support.exported import READERS


@pytest.fixture
def record(tmp_path: Path) -> Path:
    (tmp_path / "runs").mkdir()
    path = tmp_path / "runs" / "20261122T030405-vertical-4-000001.mcap"
    made = RunRecord(path, {"run_id": path.stem, "who": "ann", "plan": {}}, 10**18, 0)
    rows = np.zeros(1000, SAMPLE)
    rows["seq"] = np.arange(1, 1001)
    for part in np.split(rows, 10):
        made.add_samples(part)
        made.cut()
    made.finish()
    return path


def test_mcap_is_whole_whatever_the_record_is(record: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.mcap"
    arguments = ["export", record.stem, "--data-dir", str(tmp_path), "--out", str(out)]
    assert CliRunner().invoke(build(), arguments).exit_code == 0
    assert out.read_bytes() == record.read_bytes()
    record.write_bytes(record.read_bytes()[: record.stat().st_size // 2] + bytes(4096))
    done = CliRunner().invoke(build(), arguments)
    assert done.exit_code == 0, done.output
    assert is_complete(out)
    kept = read_samples(out)["seq"]
    assert 0 < len(kept) < 1000
    np.testing.assert_array_equal(kept, read_samples(record)["seq"])


def test_a_run_and_a_plan_by_their_ids_in_every_kind(record: Path, tmp_path: Path) -> None:
    plan = plan_of(builtin_rigs()["vertical-4"], 0.1)
    write_plan(tmp_path / "plans" / "0123456789abcdef", plan)
    for kind in ExportKind:
        out = tmp_path / f"plan.{kind}"
        done = typed("export", "0123456789abcdef", "--data-dir", tmp_path, "--out", out)
        assert (done.returncode, done.stdout, done.stderr) == (0, f"{out}\n", "")
        np.testing.assert_array_equal(READERS[kind](out)["inner_deg"], np.rad2deg(plan.angles[:, 3]))
    for kind in (ExportKind.MAT, ExportKind.TDMS, ExportKind.MF4):
        out = tmp_path / f"run.{kind}"
        assert typed("export", "latest", "--data-dir", tmp_path, "--out", out).returncode == 0
        np.testing.assert_array_equal(READERS[kind](out)["seq"], np.arange(1, 1001))


def test_what_cannot_be_exported_is_one_line(record: Path, tmp_path: Path) -> None:
    for arguments, told in (
        (("none",), "no run and no plan 'none'"),
        (("latest", "--out", tmp_path / "x.xlsx"), "expected a name ending in one of .csv, .parquet"),
        (("latest", "--out", record), "another file for --out, this one is RUN"),
    ):
        done = typed("export", *arguments, "--data-dir", tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert told in done.stderr
        assert done.stderr.count("\n") == 1


def test_angles_go_out_by_the_ending_of_out(tmp_path: Path) -> None:
    flight = tmp_path / "f.csv"
    flight.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 10},{k / 10},0,0\n" for k in range(20)))
    solve = ("solve", flight, "--rig", "vertical-4", "--method", "exact", "--out")
    assert typed(*solve, tmp_path / "o.csv").returncode == 0
    wanted = READERS["csv"](tmp_path / "o.csv")
    for kind in ExportKind:
        assert typed(*solve, tmp_path / f"o.{kind}").returncode == 0
        back = READERS[kind](tmp_path / f"o.{kind}")
        for frame in FRAMES:
            np.testing.assert_array_equal(back[f"{frame}_deg"], wanted[f"{frame}_deg"])
