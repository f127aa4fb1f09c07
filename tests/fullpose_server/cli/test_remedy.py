"""`fullpose remedy` of flights that fit, and of frames that are not there; the rest is in test_cli.py."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fullpose.errors import InputError
from fullpose_server.cli import build
from fullpose_server.planning.remedy_request import KINDS
from tests.support.command_line import typed

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


def noisy(tmp_path: Path) -> Path:
    random, flight = np.random.default_rng(0), tmp_path / "noisy.csv"
    t = np.arange(0.0, 2.0, 0.001)
    table = np.stack([t, 20 * np.sin(t) + 0.02 * random.normal(size=len(t)), 0 * t, 0 * t], axis=1)
    np.savetxt(flight, table, delimiter=",", header="time_s,yaw_deg,pitch_deg,roll_deg", comments="")
    return flight


def test_a_noisy_flight_is_given_a_tolerance_and_no_search_is_begun_for_the_rest(tmp_path: Path) -> None:
    flight, out, report = noisy(tmp_path), tmp_path / "out.csv", tmp_path / "r.json"
    common = [flight, "--rig", "vertical-limited", "--out", out, "--report", report]
    slower = typed("remedy", *common, "--kind", "slow_down")
    assert slower.returncode == 3
    taken, why = slower.stderr.splitlines()
    assert "read as csv" in taken
    assert "first a tolerance" in why
    assert not out.exists()
    within = typed("remedy", *common, "--kind", "tolerance")
    assert within.returncode == 0, within.stderr
    made = json.loads(report.read_text())
    cost, value = made["remedy"]["cost"], made["remedy"]["value"]
    assert made["tolerance_deg"] == value
    assert made["feasible"] is made["within_tolerance"] is made["remedy"]["sufficient"] is True
    assert 0.02 < cost["deviation_max_deg"] <= value < 0.2
    assert cost["deviation_rms_deg"] < cost["deviation_max_deg"] == made["max_error_deg"]
    assert f"{value:.3g} deg" in within.stdout
    both = typed("remedy", *common, "--kind", "slow_down", "--tolerance", str(value))
    assert both.returncode == 0
    assert both.stdout == "flown as it is\n"
