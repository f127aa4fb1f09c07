"""`fullpose solve`: what it says of a flight beside the angles."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from typer.testing import CliRunner

from fullpose.errors import InputError
from fullpose_server.cli import build
from fullpose_server.errors import FileError
from tests.support.repository import SCENARIOS

SHORT = """
name = "short"
about = "a turn"
duration_s = 0.5
[yaw]
[[yaw.terms]]
kind = "ramp"
change_deg = {change}
begin_s = 0.0
end_s = 0.5
"""
# Beside the turn in yaw: the linearised step of one frame alone would be exact.
ROLL = """
[roll]
[[roll.terms]]
kind = "ramp"
change_deg = 20
begin_s = 0.0
end_s = 0.5
[pitch]
constant_deg = 30
"""


def run(flight: Path, folder: Path, *more: str, rig: str = "vertical-4", method: str = "exact") -> Result:
    arguments = ["solve", flight, "--rig", rig, "--method", method, "--out", folder / "out.csv", *more]
    return CliRunner().invoke(build(), [*map(str, arguments), "--report", str(folder / "r.json")])


def report(folder: Path) -> dict[str, Any]:
    made: dict[str, Any] = json.loads((folder / "r.json").read_text())
    return made


def scenario(folder: Path, change: float = 5.0, head: str = "", more: str = "") -> Path:
    path = folder / "flight.toml"
    path.write_text(head + SHORT.format(change=change) + more, encoding="utf-8")
    return path


def test_a_scenario_file_is_a_flight_with_its_start(tmp_path: Path) -> None:
    done = run(SCENARIOS / "two_samples.toml", tmp_path)
    assert (done.exit_code, done.stderr) == (0, ""), done.output
    assert report(tmp_path)["samples"] == 2
    flight = scenario(tmp_path, head="start_deg = [0, 0, 0, 70]\n")
    done = run(flight, tmp_path, rig="vertical-limited")
    assert isinstance(done.exception, InputError)
    assert "start_deg[3] (inner): 70.0: expected -60 to 60 deg" in str(done.exception)
    assert run(flight, tmp_path, "--start", "0,0,0,0", rig="vertical-limited").exit_code == 0
    flight.write_text("name = 1", encoding="utf-8")
    assert isinstance(run(flight, tmp_path).exception, FileError)


def test_a_flight_inside_the_limits_whose_attitude_is_lost_is_told(tmp_path: Path) -> None:
    done = run(scenario(tmp_path, 10.0, more=ROLL), tmp_path, method="lagrange")
    assert done.exit_code == 0
    made = report(tmp_path)
    assert made["feasible"] is True
    missed = made["samples"] - made["exact_samples"]
    assert missed > 0
    assert f"warning: {missed} of 501 samples miss the attitude by more than 1e-09 deg" in done.stderr
    assert "of the samples exact" in done.stdout
    done = run(scenario(tmp_path, 10.0, more=ROLL), tmp_path)
    assert done.stderr == ""
    assert "feasible, exact, largest error" in done.stdout
    assert report(tmp_path)["exact_samples"] == report(tmp_path)["samples"]
    assert report(tmp_path)["exact_percent"] == 100.0


@pytest.mark.parametrize(
    ("start", "told"),
    [
        ("0,0,0,70", r"--start[3] (inner): 70.0: expected -60 to 60 deg, the range of vertical-limited"),
        ("0,0,0,1e300", r"--start[3] (inner): 1e+300: expected a number within +-1e+06 deg"),
        ("-1e7,0,0,0", r"--start[0] (base): -10000000.0: expected a number within +-1e+06 deg"),
    ],
)
def test_a_start_that_cannot_be_is_told_in_degrees(tmp_path: Path, start: str, told: str) -> None:
    done = run(scenario(tmp_path), tmp_path, "--start", start, rig="vertical-limited")
    assert isinstance(done.exception, InputError)
    assert str(done.exception) == told
    assert not (tmp_path / "out.csv").exists()


def test_a_plan_says_what_its_verdict_rests_on(tmp_path: Path) -> None:
    done = run(scenario(tmp_path), tmp_path, method="plan")
    assert done.exit_code == 0, done.output
    made = report(tmp_path)
    assert made["verdict"]["decided_by"] == "checked"
    assert made["verdict"]["grid_deg"] > 0.0
    assert made["verdict"]["max_matrix_error_between_samples"] < 1e-6
    assert f"flight.toml: {made['verdict']['statement']}" in done.stderr
    assert made["leads"]["refusal"] is None
    assert "verdict" not in _of_exact(tmp_path)


def _of_exact(folder: Path) -> dict[str, Any]:
    run(scenario(folder), folder)
    return report(folder)


def test_an_infeasible_plan_says_so_in_one_line(tmp_path: Path) -> None:
    done = run(scenario(tmp_path, 170.0), tmp_path, rig="vertical-3", method="plan")
    assert done.exit_code == 3
    made = report(tmp_path)
    assert (made["verdict"]["decided_by"], made["verdict"]["grid_deg"]) == ("three-axis", None)
    assert done.stderr.count("\n") == 1
    assert made["verdict"]["statement"] in done.stderr


def test_a_plan_without_a_way_from_rest_says_so(tmp_path: Path) -> None:
    rig = tmp_path / "rig.toml"
    still = "".join(f"[frames.{frame}]\nmin_deg = -1\nmax_deg = 1\n" for frame in ("outer", "middle", "inner"))
    base = "[frames.base]\nmin_deg = -3\nmax_deg = 3\nmax_acceleration_deg_s2 = 500\n"
    rig.write_text(f'name = "narrow"\ngeometry = "vertical-4"\n{still}{base}', encoding="utf-8")
    flight = tmp_path / "flight.csv"  # in motion at 40 deg/s to within a tenth of a degree of every stop
    rows = "".join(f"{k / 1000},{-3.9 + 0.04 * k},0,0\n" for k in range(196))
    flight.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n" + rows, encoding="utf-8")
    done = run(flight, tmp_path, rig=str(rig), method="plan")
    assert done.exit_code == 0, done.output
    leads = report(tmp_path)["leads"]
    assert "no room to" in leads["refusal"]
    assert f"a rig cannot fly it from rest to rest: {leads['refusal']}" in done.stderr
