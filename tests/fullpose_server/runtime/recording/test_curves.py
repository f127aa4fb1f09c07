"""Curves of a record against the record itself, as the library reads it; runs against runs of known difference."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import PlanOrigin, PlanPath, make_plan
from fullpose_server.runtime.contract.telemetry import SAMPLE, Samples
from fullpose_server.runtime.recording import against
from fullpose_server.runtime.recording.against import Difference, has_flight_time, make_difference, of_plan, of_run
from fullpose_server.runtime.recording.curves import COLUMNS, Curves, StaleError, columns_of, make_curves
from fullpose_server.runtime.recording.mcap_reader import read_record
from fullpose_server.session.states import STATES
from tests.support.records import write_record

BEGUN_NS = 3_000_000_000
RATE_HZ = 100.0


def quiet(_part: float) -> None:
    """Nobody looks on."""


def run_rows(count: int, held: range = range(0), shift_deg: float = 0.0, first: int = 0) -> Samples:
    """A flight that is flown exactly a tick late: angles are known functions of the flight's time; held for a while."""
    rows = np.zeros(count, SAMPLE)
    number = np.arange(count)
    rows["seq"] = 1 + first + number
    rows["time_ns"] = BEGUN_NS + (number * 1e9 / RATE_HZ).astype(np.int64)
    rows["wall_ns"] = rows["time_ns"] + 10**18
    rows["state"] = STATES.index("running")
    rows["state"][:20] = STATES.index("positioning")
    flight = np.cumsum([0.0 if k <= 20 or k in held else 1 / RATE_HZ for k in range(count)])
    rows["path_time_s"] = flight
    rows["path_time_s"][:20] = np.nan
    measured = np.concatenate([[np.nan], flight[:-1]])
    rows["measured"] = 30.0 * measured[:, None] + np.array([0.0, 5.0, -3.0, 1.0]) + shift_deg
    rows["measured_rate"] = 30.0
    rows["measured"][0] = 0.0
    rows["solve_error_deg"] = np.random.default_rng(count).uniform(size=count)
    return rows


@pytest.fixture
def record(tmp_path: Path) -> Path:
    rows = run_rows(2500)
    rows["measured"][1700:1710, 2] = np.nan  # an encoder is lost: null among four numbers
    rows["seq"][900:] += 7
    events = [
        {"kind": "alarm", "time_ns": BEGUN_NS + 2_000_000_000, "code": "b", "severity": "warning"},
        {"kind": "command", "time_ns": BEGUN_NS - 500_000_000, "command": "start"},
    ]
    return write_record(tmp_path / "run.mcap", rows, events, chunk=97)


def curves_of(record: Path) -> Curves:
    folder = record.parent / "curves" / record.stem
    make_curves(record, folder, quiet)
    return Curves(folder, record)


def test_rows_are_those_of_the_record_and_so_are_events_and_gaps(record: Path) -> None:
    rows, _ = read_record(record)
    curves = curves_of(record)
    assert (curves.about.rows, len(curves.rows)) == (2500, 2500)
    np.testing.assert_array_equal(curves.columns(0, 2500), columns_of(rows, BEGUN_NS))
    for first, last in ((0, 1), (96, 98), (400, 1733), (2499, 2500), (7, 7), (2400, 9999), (-5, 3)):
        found, expected = curves.rows.between(first, last), rows[max(0, first) : max(0, last)]
        for name in SAMPLE.names or ():
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
    assert [(event["kind"], event["at_s"]) for event in curves.about.events] == [("command", -0.5), ("alarm", 2.0)]
    assert curves.about.gaps == [(pytest.approx(9.0), 7)]
    assert curves.about.duration_s == pytest.approx(24.99)


@given(st.floats(-1.0, 26.0), st.floats(-1.0, 26.0), st.integers(2, 90))
def test_a_window_has_the_extremes_of_the_rows_in_it(
    windowed: tuple[Curves, Samples], from_s: float, to_s: float, width: int
) -> None:
    curves, rows = windowed
    found = curves.window(from_s, to_s, width)
    time = (rows["time_ns"] - BEGUN_NS) / 1e9
    inside = np.flatnonzero((time >= from_s) & (time <= to_s))
    if len(inside):
        assert found.edges[0] <= inside[0]
        assert found.edges[-1] > inside[-1]
    assert len(found.least) <= 4 * width
    error = COLUMNS.index("solve_error_deg")
    for k, (begin, end) in enumerate(zip(found.edges[:-1], found.edges[1:], strict=True)):
        values = rows["solve_error_deg"][begin:end]
        assert (found.least[k, error], found.greatest[k, error]) == (values.min(), values.max())
        assert found.least[k, 0] == time[begin]
        assert found.greatest[k, 0] == time[end - 1]


@pytest.fixture(scope="module")
def windowed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Curves, Samples]:
    rows = run_rows(2500)
    return curves_of(write_record(tmp_path_factory.mktemp("run") / "run.mcap", rows, [])), rows


def test_curves_of_another_record_are_none(record: Path) -> None:
    folder = record.parent / "curves" / record.stem
    with pytest.raises(StaleError):
        Curves(folder, record)
    curves_of(record)
    about = record.stat()
    os.utime(record, ns=(about.st_atime_ns, about.st_mtime_ns + 1))
    with pytest.raises(StaleError):
        Curves(folder, record)
    curves_of(record)
    for file in folder.iterdir():
        whole = file.read_bytes()
        file.write_bytes(whole[: len(whole) // 2])
        with pytest.raises(StaleError):
            Curves(folder, record)
        file.write_bytes(whole)
    Curves(folder, record)


def test_a_record_that_is_cut_off_or_damaged_has_the_curves_of_what_is_left(record: Path) -> None:
    data = bytearray(record.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 50] = b"\xff" * 50
    record.write_bytes(data[: -len(data) // 5])
    rows, _ = read_record(record)
    assert 0 < len(rows) < 2500
    curves = curves_of(record)
    np.testing.assert_array_equal(curves.columns(0, 2500), columns_of(rows, BEGUN_NS))


def test_what_is_made_is_there_whole_or_not_at_all(record: Path) -> None:
    def cut_off(part: float) -> None:
        if part > 0.5:
            raise KeyboardInterrupt

    folder = record.parent / "curves"
    with pytest.raises(KeyboardInterrupt):
        make_curves(record, folder / record.stem, cut_off)
    assert list(folder.iterdir()) == []


def test_a_run_without_a_row_has_curves_too(tmp_path: Path) -> None:
    curves = curves_of(write_record(tmp_path / "none.mcap", np.zeros(0, SAMPLE), []))
    assert (curves.about.rows, curves.about.started) == (0, None)
    assert len(curves.window(0.0, 1.0, 100).least) == 0


def differences(run: Path, other: Path, tmp_path: Path) -> tuple[Difference, np.ndarray]:
    """All buckets of run against other."""
    (tmp_path / "reference").mkdir()
    reference = of_run(other, "flight", tmp_path / "reference", quiet)
    made_of = against.fingerprint_of(run, other)
    make_difference(run, reference, "flight", made_of, tmp_path / "difference", quiet)
    found = Difference(tmp_path / "difference", made_of)
    buckets = found.between(0, found.about.rows, 10_000)
    return found, np.stack([buckets.least, buckets.greatest])


def test_two_runs_of_one_flight_differ_by_what_they_differ_in_though_one_was_held(tmp_path: Path) -> None:
    one = write_record(tmp_path / "one.mcap", run_rows(1500), [])
    # Later, held for two seconds, and two revolutions on.
    other = write_record(tmp_path / "other.mcap", run_rows(1700, range(600, 800), shift_deg=-0.25 + 720.0), [])
    found, extremes = differences(one, other, tmp_path)
    assert found.about.turned_deg == [-720.0] * 4
    column = found.about.columns.index("difference_outer_deg")
    shown = extremes[:, :, column]
    assert np.isnan(shown[:, 0]).all()  # before it ran there is nothing to compare
    assert np.nanmin(shown) == pytest.approx(0.25, abs=1e-9)
    assert np.nanmax(shown) == pytest.approx(0.25, abs=1e-9)
    assert np.isfinite(shown[0]).mean() > 0.9
    with pytest.raises(StaleError):
        Difference(tmp_path / "difference", against.fingerprint_of(other, one))


def test_a_run_against_its_plan(tmp_path: Path) -> None:
    record = write_record(tmp_path / "one.mcap", run_rows(1500), [])
    assert has_flight_time(record)
    time = np.arange(-40, 1600) / RATE_HZ
    angles = np.radians(30.0 * time[:, None] + np.array([0.0, 5.0, -3.0, 1.0]) + 0.5)
    target = np.tile([1.0, 0.0, 0.0, 0.0], (len(time), 1))
    origin = PlanOrigin(plan_id="p", trajectory_sha256="t", method="plan")
    rig = builtin_rigs()["vertical-4"]
    plan = make_plan(origin, rig, RATE_HZ, PlanPath(angles, target, np.zeros(len(time)), 40, 30), feasible=True)
    (tmp_path / "reference").mkdir()
    make_difference(record, of_plan(plan, tmp_path / "reference"), "flight", "x", tmp_path / "difference", quiet)
    found = Difference(tmp_path / "difference", "x")
    buckets = found.between(0, 1500, 10_000)
    for name, expected in (("difference_base_deg", -0.5), ("difference_rate_inner_deg_s", 0.0)):
        column = found.about.columns.index(name)
        assert np.nanmin(buckets.least[:, column]) == pytest.approx(expected, abs=1e-6)
        assert np.nanmax(buckets.greatest[:, column]) == pytest.approx(expected, abs=1e-6)
    assert json.loads((tmp_path / "difference" / "about.json").read_text())["aligned"] == "flight"
