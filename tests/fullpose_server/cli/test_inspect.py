"""`fullpose inspect`: the findings as lines or as JSON; bad input is one error, and status 2."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.errors import FileError
from tests.support.command_line import typed
from tests.support.recorded import grid, noisy, truth


def written(folder: Path, attitude: Rotation, time: np.ndarray, decimals: str = ".9f") -> Path:
    """The flight as a file of yaw, pitch and roll."""
    angles = attitude.as_euler("YZX", degrees=True)
    rows = [f"{t:.4f},{y:{decimals}},{p:{decimals}},{r:{decimals}}" for t, (y, p, r) in zip(time, angles, strict=True)]
    path = folder / "flight.csv"
    path.write_text("time_s,yaw_deg,pitch_deg,roll_deg\n" + "\n".join(rows) + "\n", encoding="utf-8")
    return path


def test_the_findings_are_lines(tmp_path: Path) -> None:
    time = grid(1000.0, 2.0)
    flight = written(tmp_path, noisy(truth("manoeuvre", time), 0.02), time)
    done = CliRunner().invoke(build(), ["inspect", str(flight), "--rig", "vertical-4"])
    assert done.exit_code == 0, done.output
    first, *rest = done.stdout.splitlines()
    assert first == f"{flight}: 2001 samples in 2 s"
    assert rest[0].startswith("  warning: White noise of 0.0")
    assert "the frames of vertical-4: base " in rest[0]
    assert rest[-1].startswith("  remark: Taken as they stand the samples turn the body at up to ")


def test_the_same_as_json(tmp_path: Path) -> None:
    time = grid(1000.0, 2.0)
    flight = written(tmp_path, truth("manoeuvre", time), time, ".2f")
    done = CliRunner().invoke(build(), ["inspect", str(flight), "--json"])
    report = json.loads(done.stdout)
    assert report["quantum"] == {"deg": pytest.approx(0.01), "unit": 0.01, "of": "angles_deg"}
    assert report["file"] == str(flight)
    assert report["convention"] == "nue"
    assert [each["code"] for each in report["findings"] if each["level"] == "warning"] == ["quantum"]


@pytest.mark.parametrize("text", ["", "time_s,yaw_deg,pitch_deg,roll_deg\n0,0,0,0\n0,1,1,1\n", "time_s,a\n0,1\n"])
def test_bad_input_is_one_error(tmp_path: Path, text: str) -> None:
    flight = tmp_path / "flight.csv"
    flight.write_text(text, encoding="utf-8")
    done = CliRunner().invoke(build(), ["inspect", str(flight)])
    assert isinstance(done.exception, FileError)
    assert str(flight) in str(done.exception)


def test_its_status_is_two_for_bad_input(tmp_path: Path) -> None:
    done = typed("inspect", tmp_path / "none.csv")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"fullpose: {tmp_path / 'none.csv'}: No such file or directory\n"
