"""`--tolerance`: a noisy flight is refused with a suggestion, and flown with it; what is said of it is so."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import InputError
from fullpose.rig import builtin_rigs
from fullpose.verify import attitude_errors, payload_attitudes
from fullpose_server.cli import build
from tests.support.recorded import grid, noisy, quaternion, truth

SIGMA = 0.02


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flight") / "noisy.csv"
    time = grid(400.0, 1.5)
    q = quaternion(noisy(truth("gentle", time), SIGMA))
    rows = "".join(f"{t!r},{','.join(map(repr, row))}\n" for t, row in zip(time.tolist(), q.tolist(), strict=True))
    path.write_text("time_s,qw,qx,qy,qz\n" + rows)
    return path


def run(command: str, flight: Path, folder: Path, *more: str) -> Result:
    report = ["--report", str(folder / "r.json")]
    return CliRunner().invoke(build(), [command, str(flight), "--rig", "vertical-limited", *more, *report])


def solved(flight: Path, folder: Path, *more: str) -> Result:
    return run("solve", flight, folder, "--out", str(folder / "out.csv"), *more)


def report(folder: Path) -> dict[str, Any]:
    made: dict[str, Any] = json.loads((folder / "r.json").read_text())
    return made


def test_what_is_refused_for_its_noise_has_a_suggestion_that_flies_it(flight: Path, tmp_path: Path) -> None:
    refused = solved(flight, tmp_path, "--method", "exact")
    assert refused.exit_code == 3
    made = report(tmp_path)
    assert made["tolerance_deg"] is made["deviation_deg"] is None
    suggested = made["suggested_tolerance_deg"]
    assert 3.0 * SIGMA < suggested <= 6.0 * SIGMA
    assert 0.0 < made["tolerance_floor_deg"] < suggested
    assert f"A tolerance of {suggested:g} deg takes away what the recording added" in refused.stderr

    flown = solved(flight, tmp_path, "--tolerance", f"{suggested:g}")
    assert flown.exit_code == 0, flown.output
    assert "Hz taken away" in flown.stderr
    made = report(tmp_path)
    assert made["feasible"]
    assert made["within_tolerance"]
    assert made["exact_samples"] == made["samples"]
    assert 0.0 < made["deviation_deg"]["rms"] < made["deviation_deg"]["max"] <= made["tolerance_deg"] == suggested
    with (tmp_path / "out.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    given = np.loadtxt(flight, delimiter=",", skiprows=1)
    assert len(rows) == len(given)
    angles = np.radians(
        [[float(row[f"{frame}_deg"]) for frame in ("base", "outer", "middle", "inner")] for row in rows]
    )
    away, _ = attitude_errors(
        payload_attitudes(builtin_rigs()["vertical-limited"], angles), dcm_from_quaternion(given[:, 1:])
    )
    np.testing.assert_allclose([float(row["error_deg"]) for row in rows], np.degrees(away), atol=1e-9)
    assert made["max_error_deg"] == pytest.approx(np.degrees(away.max()), rel=1e-9)
    assert made["max_error_deg"] == pytest.approx(made["deviation_deg"]["max"], rel=1e-6)


def test_below_the_floor_it_is_refused_and_says_so(flight: Path, tmp_path: Path) -> None:
    refused = solved(flight, tmp_path, "--tolerance", "0.01", "--method", "exact")
    assert refused.exit_code == 3
    assert "more than the tolerance of 0.01 deg" in refused.stderr
    assert "below" in refused.stderr
    made = report(tmp_path)
    assert not made["feasible"]
    assert not made["within_tolerance"]
    assert made["deviation_deg"]["max"] > 0.01


@pytest.mark.parametrize("text", ["0", "-1", "nan", "91"])
def test_a_tolerance_that_is_none(flight: Path, tmp_path: Path, text: str) -> None:
    refused = solved(flight, tmp_path, "--tolerance", text)
    assert isinstance(refused.exception, InputError)  # one line and exit 2 where the command line begins
    assert str(refused.exception).startswith("--tolerance")
    assert not (tmp_path / "out.csv").exists()


def test_a_clean_flight_needs_none(tmp_path: Path) -> None:
    path = tmp_path / "clean.csv"
    time = grid(200.0, 1.0)
    angles = truth("gentle", time).as_euler("YZX", degrees=True)
    rows = [",".join(map(repr, [t, *row])) for t, row in zip(time.tolist(), angles.tolist(), strict=True)]
    path.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n" + "\n".join(rows) + "\n")
    assert Rotation.from_euler("YZX", angles, degrees=True).magnitude().max() > 0.0
    done = solved(path, tmp_path, "--tolerance", "0.5")
    assert done.exit_code == 0, done.output
    made = report(tmp_path)
    assert made["suggested_tolerance_deg"] is None
    assert made["deviation_deg"] == {"max": 0.0, "rms": 0.0}
    assert made["max_error_deg"] < 1e-9


def test_a_comparison_gives_every_method_the_flight_within_the_tolerance(flight: Path, tmp_path: Path) -> None:
    done = run("compare", flight, tmp_path, "--methods", "exact,lagrange", "--tolerance", "0.1")
    assert done.exit_code == 0, done.output
    assert "within 0.1 deg" in done.stdout
    made = report(tmp_path)
    assert made["deviation_deg"]["max"] <= made["tolerance_deg"] == 0.1
    exact = made["methods"][0]
    assert exact["feasible"]
    assert max(peak["acceleration_deg_s2"] for peak in exact["peak"].values()) < 500.0


TURN = """
name = "turn"
about = "90 deg in half a second"
duration_s = 0.5
rate_hz = 200
[yaw]
[[yaw.terms]]
kind = "ramp"
change_deg = 90
begin_s = 0.0
end_s = 0.5
[pitch]
constant_deg = 30
[roll]
constant_deg = 20
"""


def test_what_smoothing_leaves_of_it_is_the_planners(tmp_path: Path) -> None:
    """Beyond the acceleration limits by a little: flown within a tolerance, its error that of the frames."""
    path = tmp_path / "turn.toml"
    path.write_text(TURN)
    done = solved(path, tmp_path, "--tolerance", "1")
    assert done.exit_code == 0, done.output
    made = report(tmp_path)
    assert made["feasible"]
    assert made["verdict"]["decided_by"] == "tolerance"
    assert made["limit_violations"] == []
    assert 1e-6 < made["max_error_deg"] <= 1.0
    assert made["deviation_deg"]["max"] == 0.0


def test_a_flight_beyond_a_limit_is_told_the_tolerance_that_helps(tmp_path: Path) -> None:
    """A roll that is too fast for the inner frame's stops: what is suggested flies it."""
    flight = tmp_path / "roll.csv"
    time = np.arange(0.0, 1.5, 0.02).round(3)
    angles = np.stack([time, 20.0 * np.sin(time), 5.0 * np.sin(2.0 * time), 400.0 * time], axis=1)
    rows = "".join(",".join(map(repr, row)) + "\n" for row in angles.tolist())
    flight.write_text(f"time_s,yaw_deg,pitch_deg,roll_deg\n{rows}")
    refused = solved(flight, tmp_path)
    assert refused.exit_code == 3
    least = report(tmp_path)["verdict"]["least_tolerance_deg"]
    said = re.search(r"A tolerance of (\S+) deg is enough for every limit", refused.stderr)
    assert said is not None
    assert least < float(said[1]) < 1.2 * least
    flown = solved(flight, tmp_path, "--tolerance", said[1])
    assert flown.exit_code == 0, flown.output
    assert report(tmp_path)["max_error_deg"] <= float(said[1])
