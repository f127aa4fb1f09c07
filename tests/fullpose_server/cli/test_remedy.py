"""`fullpose remedy` of flights that fit, and of frames that are not there; the rest is in test_cli.py."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose.errors import InputError
from fullpose_server.cli import build
from fullpose_server.planning.remedy_request import KINDS

FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 100},{10 * (k / 40) ** 2},0,0\n" for k in range(40))


@pytest.mark.parametrize("kind", KINDS)
def test_a_flight_that_fits_is_flown_as_it_is(tmp_path: Path, kind: str) -> None:
    flight, out, report = tmp_path / "flight.csv", tmp_path / "out.csv", tmp_path / "r.json"
    flight.write_text(FLIGHT, encoding="utf-8")
    arguments = ["remedy", flight, "--rig", "vertical-4", "--kind", kind, "--out", out, "--report", report]
    done = CliRunner().invoke(build(), [*map(str, arguments)])
    assert done.exit_code == 0, done.output
    made = json.loads(report.read_text())
    assert made["feasible"] is made["remedy"]["sufficient"] is True
    assert made["verdict"]["decided_by"] == "checked"
    if kind == "relax":
        assert done.stdout == "flown as it is: no limit need be raised\n"
        assert len(out.read_text().splitlines()) == 41


def test_a_three_axis_rig_has_no_base(tmp_path: Path) -> None:
    flight, out = tmp_path / "flight.csv", tmp_path / "out.csv"
    flight.write_text(FLIGHT, encoding="utf-8")
    arguments = ["remedy", flight, "--rig", "vertical-3", "--kind", "relax", "--frame", "base", "--out", out]
    done = CliRunner().invoke(build(), [*map(str, arguments)])
    assert isinstance(done.exception, InputError)
    assert "vertical-3 has no base frame" in str(done.exception)
    assert not out.exists()
