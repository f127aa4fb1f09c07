"""`fullpose compare`."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose.errors import InputError, MethodError
from fullpose_server.cli import build
from fullpose_server.errors import FileError
from tests.support.repository import SCENARIOS

FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 100},{k},{k / 2},0\n" for k in range(40))


def run(*arguments: str | Path) -> tuple[int, str, BaseException | None]:
    result = CliRunner().invoke(build(), ["compare", *map(str, arguments)])
    return result.exit_code, result.output, result.exception


@pytest.fixture
def flight(tmp_path: Path) -> Path:
    path = tmp_path / "flight.csv"
    path.write_text(FLIGHT, encoding="utf-8")
    return path


def test_table_report_and_page(flight: Path, tmp_path: Path) -> None:
    report, page = tmp_path / "r.json", tmp_path / "p.html"
    code, output, _ = run(
        flight, "--rig", "vertical-4", "--methods", "exact, lagrange", "--report", report, "--page", page
    )
    assert code == 0, output
    assert "flight.csv on vertical-4: 40 samples" in output
    assert [m["method"] for m in json.loads(report.read_text())["methods"]] == ["exact", "lagrange"]
    assert page.read_text().startswith("<!doctype html>")


def test_what_happens_first_and_then_is_said_under_the_table(tmp_path: Path) -> None:
    path = tmp_path / "roll.csv"
    rows = "".join(f"{k / 50},{5 * k},0,{k / 50 * 400}\n" for k in range(60))
    path.write_text(f"time_s,yaw_deg,pitch_deg,roll_deg\n{rows}", encoding="utf-8")
    report = tmp_path / "r.json"
    code, output, _ = run(path, "--rig", "vertical-limited", "--methods", "plan", "--report", report)
    assert code == 0, output
    (made,) = json.loads(report.read_text())["methods"]
    assert made["why"].startswith("at ")
    assert f"plan: {made['why']}. {made['how_sure']}" in output


def test_a_scenario_file_is_a_flight() -> None:
    code, output, _ = run(SCENARIOS / "singular_start.toml", "--rig", "vertical-3", "--methods", "three_axis,alm")
    assert code == 0, output
    assert "10001 samples" in output
    assert "fourth axis" in output


def test_variants_of_a_method(flight: Path, tmp_path: Path) -> None:
    report = tmp_path / "r.json"
    code, output, _ = run(
        flight, "--rig", "vertical-4", "--methods", "alm:mode=open_loop:growth=4, alm", "--report", report
    )
    assert code == 0, output
    assert re.findall(r"^alm\S*", output, re.MULTILINE) == ["alm:mode=open_loop:growth=4", "alm"]
    rows = json.loads(report.read_text())["methods"]
    assert rows[0]["options"] == {"mode": "open_loop", "growth": 4.0}
    for wrong, told in (
        ("alm,alm", "label of its own"),
        ("alm:mode=sideways", "sideways"),
        ("alm:speed=3", "no option 'speed'"),
        ("alm:", "name=value"),
        (":growth=4", "no method named ''"),
    ):
        _, _, error = run(flight, "--rig", "vertical-4", "--methods", wrong)
        assert isinstance(error, MethodError)
        assert told in str(error)


def test_where_every_method_is_refused_nothing_is_written(flight: Path, tmp_path: Path) -> None:
    report = tmp_path / "r.json"
    _, _, error = run(flight, "--rig", "vertical-3", "--methods", "alm,exact", "--report", report)
    assert isinstance(error, MethodError)
    assert "no method that is asked for applies to vertical-3" in str(error)
    assert not report.exists()


def test_a_rate_that_makes_too_many_samples(flight: Path) -> None:
    _, _, error = run(flight, "--rig", "vertical-4", "--methods", "exact", "--rate", "1e9")
    assert isinstance(error, InputError)
    assert "at most 0.012 s at 1e+09 Hz" in str(error)


def test_a_rate_is_said(flight: Path) -> None:
    code, output, _ = run(flight, "--rig", "vertical-4", "--methods", "exact", "--rate", "500")
    assert code == 0, output
    assert "quaternion spline" in output


def test_bad_input_writes_nothing(flight: Path, tmp_path: Path) -> None:
    report = tmp_path / "r.json"
    _, _, error = run(flight, "--rig", "vertical-4", "--methods", "exact,magic", "--report", report)
    assert isinstance(error, MethodError)
    flight.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,x\n", encoding="utf-8")
    _, _, error = run(flight, "--rig", "vertical-4", "--methods", "exact", "--report", report)
    assert isinstance(error, FileError)
    _, _, error = run(flight, "--rig", "vertical-4", "--methods", " ", "--report", report)
    assert isinstance(error, MethodError)
    assert not report.exists()
