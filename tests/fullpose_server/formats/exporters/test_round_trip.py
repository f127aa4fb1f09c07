"""Every export, read back by a library of the format's own: every bit of every column, and its unit."""

from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from asammdf import MDF
from nptdms import TdmsFile
from scipy.io import loadmat

from fullpose.rig import FRAMES, builtin_rigs
from fullpose.verify import differences
from fullpose_server.errors import FileError
from fullpose_server.formats.exporters.registry import EXPORTERS, ExportKind, exporter_of, write_table
from fullpose_server.formats.exporters.table import ExportTable, motion_of, unit_of
from fullpose_server.formats.plan_export import plan_table
from fullpose_server.runtime.contract.telemetry import SAMPLE, Samples
from fullpose_server.runtime.recording.export import run_table
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.exported import READERS

TABULAR = [kind for kind in ExportKind if kind is not ExportKind.PLAYBACK]
PLAN = plan_of(builtin_rigs()["vertical-limited"], 0.5)


def samples(n: int = 200) -> Samples:
    rng = np.random.default_rng(7)
    rows = np.zeros(n, SAMPLE)
    rows["seq"] = np.arange(10, n + 10)
    rows["time_ns"] = 10**15 + np.arange(n) * 1_000_003
    rows["wall_ns"] = 1_795_000_000_000_000_123 + rows["time_ns"]
    rows["state"] = rng.integers(0, 4, n)
    for name in ("demand", "demand_rate", "demand_acceleration", "measured", "target"):
        rows[name] = rng.standard_normal((n, 4))
    rows["target"][:20] = np.nan
    return rows


@pytest.mark.parametrize("kind", TABULAR)
def test_a_plan_comes_back_bit_by_bit(tmp_path: Path, kind: ExportKind) -> None:
    table = plan_table(PLAN)
    write_table(table, tmp_path / "draft", kind, "plan")
    back = READERS[kind](tmp_path / "draft")
    assert sorted(back) == sorted(table.columns)
    for name, values in table.columns.items():
        np.testing.assert_array_equal(back[name], values, err_msg=name)


@pytest.mark.parametrize("kind", [kind for kind in TABULAR if kind is not ExportKind.MCAP])
def test_a_run_comes_back_bit_by_bit_text_and_whole_numbers_too(tmp_path: Path, kind: ExportKind) -> None:
    table = run_table(samples())
    write_table(table, tmp_path / "draft", kind, "run")
    back = READERS[kind](tmp_path / "draft")
    assert sorted(back) == sorted(table.columns)
    for name, values in table.columns.items():
        np.testing.assert_array_equal(back[name], values, err_msg=name)
    if kind not in (ExportKind.CSV, ExportKind.PARQUET):
        assert back["wall_ns"].dtype == np.int64


def test_a_plan_as_played_is_its_angles_and_the_differences_that_limits_are_checked_by(tmp_path: Path) -> None:
    write_table(plan_table(PLAN), tmp_path / "draft", ExportKind.PLAYBACK, "plan")
    assert (tmp_path / "draft").stat().st_size == 104 * PLAN.info.samples
    back = READERS["f64"](tmp_path / "draft")
    dt = 1.0 / PLAN.info.rate_hz
    at = np.arange(PLAN.info.samples) * dt
    np.testing.assert_allclose(back["time_s"], at, rtol=0.0, atol=1e-12)
    rate, acceleration = differences(at, np.rad2deg(PLAN.angles))
    for k, frame in enumerate(FRAMES):
        np.testing.assert_array_equal(back[f"{frame}_deg"], np.rad2deg(PLAN.angles[:, k]))
        np.testing.assert_allclose(back[f"{frame}_rate_deg_s"][1:], rate[:, k], atol=1e-7)
        np.testing.assert_allclose(back[f"{frame}_acceleration_deg_s2"][1:-1], acceleration[:, k], atol=1e-5)
    assert back["base_rate_deg_s"][0] == back["base_rate_deg_s"][1]
    assert back["inner_acceleration_deg_s2"][-1] == back["inner_acceleration_deg_s2"][-2]


def test_a_run_as_played_is_what_was_commanded(tmp_path: Path) -> None:
    rows = samples()
    write_table(run_table(rows), tmp_path / "draft", ExportKind.PLAYBACK, "run")
    back = READERS["f64"](tmp_path / "draft")
    np.testing.assert_array_equal(back["time_s"], (rows["time_ns"] - rows["time_ns"][0]) / 1e9)
    np.testing.assert_array_equal(back["outer_deg"], rows["demand"][:, 1])
    np.testing.assert_array_equal(back["middle_rate_deg_s"], rows["demand_rate"][:, 2])
    np.testing.assert_array_equal(back["inner_acceleration_deg_s2"], rows["demand_acceleration"][:, 3])


def test_a_run_that_a_table_could_not_play_is_refused_with_its_row(tmp_path: Path) -> None:
    lost = np.delete(samples(), 50)
    with pytest.raises(FileError, match="row 51: expected a record without lost samples"):
        write_table(run_table(lost), tmp_path / "draft", ExportKind.PLAYBACK, "run")
    blank = samples()
    blank["demand"][7, 2] = np.nan
    with pytest.raises(FileError, match="row 8: expected a command of every frame"):
        write_table(run_table(blank), tmp_path / "draft", ExportKind.PLAYBACK, "run")


def test_units_are_where_each_program_looks_for_them(tmp_path: Path) -> None:
    table = plan_table(PLAN)
    write_table(table, tmp_path / "tdms", ExportKind.TDMS, "plan")
    write_table(table, tmp_path / "mf4", ExportKind.MF4, "plan")
    read = TdmsFile.read(tmp_path / "tdms")
    assert read.properties["plan_hash"] == PLAN.info.plan_hash
    assert read["plan"]["inner_acceleration_deg_s2"].properties["unit_string"] == "deg/s^2"
    assert "unit_string" not in read["plan"]["qw"].properties
    with MDF(tmp_path / "mf4") as file:
        assert file.get("base_rate_deg_s").unit == "deg/s"
        assert PLAN.info.plan_hash in file.groups[0].channel_group.comment


def test_facts_are_in_the_file(tmp_path: Path) -> None:
    table = plan_table(PLAN)
    write_table(table, tmp_path / "mat", ExportKind.MAT, "plan")
    assert loadmat(tmp_path / "mat")["about"]["rig"][0, 0][0] == "vertical-limited"
    write_table(table, tmp_path / "parquet", ExportKind.PARQUET, "plan")
    assert pq.read_schema(tmp_path / "parquet").metadata[b"flight_sha256"] == b"0" * 64


@pytest.mark.parametrize("rows", [1, 2])
def test_the_motion_of_one_row_and_of_two(rows: int) -> None:
    motion = motion_of(np.arange(rows) * 0.5, np.outer(np.arange(rows), [1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_array_equal(motion.rate, np.tile([2.0, 4.0, 6.0, 8.0] if rows == 2 else [0.0] * 4, (rows, 1)))
    np.testing.assert_array_equal(motion.acceleration, np.zeros((rows, 4)))


@pytest.mark.parametrize(
    ("name", "unit"),
    [("time_s", "s"), ("base_deg", "deg"), ("demand_rate_base_deg_s", "deg/s"), ("lateness_us", "us"), ("qw", "")],
)
def test_the_unit_is_the_end_of_the_name(name: str, unit: str) -> None:
    assert unit_of(name) == unit


def test_a_missing_extra_is_named_with_what_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fullpose_server.formats.exporters.registry.find_spec", lambda _name: None)
    table = ExportTable("plan", {"time_s": np.zeros(1)}, {}, lambda: motion_of(np.zeros(1), np.zeros((1, 4))))
    with pytest.raises(FileError, match=r"out.tdms: expected the extra tdms for TDMS: pip install 'fullpose\[tdms\]'"):
        write_table(table, tmp_path / "draft", ExportKind.TDMS, "out.tdms")
    write_table(table, tmp_path / "draft", ExportKind.MAT, "out.mat")


def test_every_kind_has_a_row_and_an_ending() -> None:
    assert list(EXPORTERS) == list(ExportKind)
    for kind in ExportKind:
        row = exporter_of(Path(f"a.b.{kind}"))
        assert row is not None
        assert row.kind is kind
    assert exporter_of(Path("a.xlsx")) is None
    assert exporter_of(Path("a")) is None
