"""The command line as other programs see it: exit statuses, one line on stderr, files whole or untouched."""

import ast
import csv
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.registry import method_names
from fullpose_server.cli.solve import METHODS
from tests.support.command_line import Done, typed
from tests.support.repository import PYTHONPATH, ROOT
from tests.support.serving import COMMAND

FLIGHTS = ROOT / "examples" / "flights"
HEADER = "time_s,yaw_deg,pitch_deg,roll_deg\n"
GOOD = HEADER + "".join(
    f"{k / 100},{20 * np.sin(k / 50)},{10 * np.sin(k / 40)},{5 * np.sin(k / 30)}\n" for k in range(200)
)
FAST = HEADER + "".join(f"{k / 100},0,0,{40 * k}\n" for k in range(50))


def solve(flight: Path, folder: Path, *more: str | Path, method: str = "exact") -> Done:
    rig = () if "--rig" in more else ("--rig", "vertical-4")
    return typed("solve", flight, *rig, "--method", method, "--out", folder / "out.csv", *more)


def written(folder: Path, text: str) -> Path:
    path = folder / "flight.csv"
    path.write_text(text, encoding="utf-8")
    return path


def table(path: Path) -> tuple[list[str], np.ndarray]:
    with path.open(newline="") as stream:
        rows = list(csv.reader(stream))
    return rows[0], np.array(rows[1:], float)


def test_the_help_names_every_command_and_method() -> None:
    text = typed("--help").stdout
    for command in ("demo", "serve", "solve", "compare", "rigs", "export", "doctor"):
        assert re.search(rf"^  {command} ", text, re.MULTILINE), text
    assert tuple(METHODS.split(", ")) == method_names()


def test_solve_writes_angles_that_reproduce_the_flight(tmp_path: Path) -> None:
    done = solve(written(tmp_path, GOOD), tmp_path, "--report", tmp_path / "r.json", "--start", "30,0,0,0")
    assert done.returncode == 0, done.stderr
    (taken,) = done.stderr.splitlines()
    assert "axes nue (profile fullpose, by its column names; no convention was given, nue is taken" in taken
    names, angles = table(tmp_path / "out.csv")
    assert names == ["time_s", "base_deg", "outer_deg", "middle_deg", "inner_deg", "error_deg", "limited"]
    flight = table(tmp_path / "flight.csv")[1]
    np.testing.assert_array_equal(angles[:, 0], flight[:, 0])
    turned = Rotation.from_euler("Y", angles[:, 1:2], degrees=True) * Rotation.from_euler(
        "ZYX", angles[:, 2:5], degrees=True
    )
    wanted = Rotation.from_euler("YZX", flight[:, 1:4], degrees=True)
    np.testing.assert_allclose(turned.as_matrix(), wanted.as_matrix(), atol=1e-14)
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["feasible"] is True
    assert report["blocking"] is None
    assert report["samples"] == 200
    assert report["input"]["file"] == str(tmp_path / "flight.csv")
    told = {name: report["input"][name] for name in ("format", "profile", "convention", "warnings")}
    assert told == {"format": "csv", "profile": "fullpose", "convention": "nue", "warnings": []}
    assert set(report["peak"]) == {"base", "outer", "middle", "inner"}
    assert set(report["peak"]["base"]) == {
        "position_deg", "rate_deg_s", "acceleration_deg_s2", "jerk_deg_s3", "jerk_percent",
    }  # fmt: skip
    assert {"method", "rig", "max_error_deg", "max_matrix_error", "iterations", "step_us", "solve_s"} <= set(report)
    assert np.abs(angles[:, 1]).max() == pytest.approx(report["peak"]["base"]["position_deg"], rel=1e-12)


def test_a_shell_gets_the_status_what_was_taken_and_why_not(tmp_path: Path) -> None:
    env = os.environ | {"PYTHONPATH": PYTHONPATH}
    for text, status, lines in ((GOOD, 0, 1), (HEADER, 2, 1), (FAST, 3, 3)):
        command = [sys.executable, "-W", "error", *COMMAND[1:], "solve", str(written(tmp_path, text))]
        command += ["--rig", "vertical-4", "--method", "exact", "--out", str(tmp_path / "out.csv")]
        done = subprocess.run(command, capture_output=True, text=True, env=env, check=False)
        assert (done.returncode, done.stderr.count("\n")) == (status, lines), done.stderr


def test_a_real_flight_in_north_east_down(tmp_path: Path) -> None:
    done = solve(FLIGHTS / "slow_roll.csv", tmp_path, "--convention", "ned", "--plot", tmp_path / "p.html")
    assert done.returncode == 0, done.stderr
    names, angles = table(tmp_path / "out.csv")
    assert angles[:, names.index("error_deg")].max() < 1e-11
    page = (tmp_path / "p.html").read_text()
    assert "__" not in re.sub(r"<script>.*?</script>", "", page, flags=re.DOTALL).replace("__proto__", "")
    assert "http://" not in page
    assert "https://" not in page


def test_parquet_out(tmp_path: Path) -> None:
    done = typed(
        "solve", written(tmp_path, GOOD), "--rig", "vertical-4", "--method", "exact", "--out", tmp_path / "o.parquet"
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "o.parquet").read_bytes().startswith(b"PAR1")


def test_a_rig_file_and_a_start_pose(tmp_path: Path) -> None:
    rig = tmp_path / "bench.toml"
    rig.write_text('name = "bench"\ngeometry = "vertical-4"\n[frames.base]\nhome_deg = 40.0\n')
    assert solve(written(tmp_path, GOOD), tmp_path, "--rig", rig).returncode == 0
    bad = tmp_path / "bad.toml"
    bad.write_text('name = "bench"\ngeometry = "vertical-4"\n[frames.base]\nspeed = 40.0\n')
    done = solve(written(tmp_path, GOOD), tmp_path, "--rig", bad)
    assert done.returncode == 2
    assert "frames.base.speed" in done.stderr


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("\x00\x01\x02", "binary"),
        (HEADER, "at least one row"),
        ("time_s,yaw_deg,pitch_deg\n0,1,2\n", "line 1, column roll_deg"),
        (GOOD + "5,nan,0,0\n", "line 202, column yaw_deg"),
        (GOOD + "0.5,0,0,0\n", "line 202, column time_s"),
        (GOOD + "1.99,0,0,0\n", "twice"),
        (GOOD + "5,0,0,north\n", "line 202, column roll_deg"),
        ("time_s,qw,qx,qy,qz\n0,0,0,0,0\n", "line 2, column qw"),
    ],
)
def test_bad_input_is_one_clear_line_and_out_is_untouched(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "out.csv").write_text("old")
    done = solve(written(tmp_path, text), tmp_path, "--report", tmp_path / "r.json")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith(f"fullpose: {tmp_path / 'flight.csv'}")
    assert told in done.stderr
    assert done.stdout == ""
    assert (tmp_path / "out.csv").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["flight.csv", "out.csv"]


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (("--rig", "nowhere"), "vertical-limited"),
        (("--method", "magic"), "exact"),
        (("--start", "1,2,3"), "four angles"),
        (("--start", "1,2,3,nan"), "four angles"),
        (("--convention", "xyz"), "ned"),
        (("--option", "nonsense=1"), "nonsense"),
        (("--option", "nonsense"), "name=value"),
        (("--tolerance", "91"), "--tolerance"),
        (("--out", "/dev/null/x.csv"), "place to write"),
        (("--out", "no/such/folder/x.csv"), "no folder"),
        (("--report", "no/such/folder/r.json"), "no folder"),
        (("--plot", "no/such/folder/p.html"), "no folder"),
    ],
)
def test_arguments_that_cannot_be(tmp_path: Path, more: tuple[str, str], told: str) -> None:
    done = solve(written(tmp_path, GOOD), tmp_path, *more)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    assert told in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["flight.csv"]
    assert not Path("no").exists()


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    done = solve(tmp_path / "nothing.csv", tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "nothing.csv" in done.stderr


def test_what_does_not_fit_is_told_with_status_3_and_the_report_is_written(tmp_path: Path) -> None:
    done = solve(written(tmp_path, FAST), tmp_path, "--report", tmp_path / "r.json")
    assert done.returncode == 3
    taken, warning, why = done.stderr.splitlines()
    assert ("read as csv" in taken, "warning:" in warning, "is not feasible" in why) == (True, True, True)
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["feasible"] is False
    assert report["blocking"] is not None
    names, angles = table(tmp_path / "out.csv")
    assert int(angles[:, names.index("limited")].sum()) == report["limited_samples"] > 0
    # The limits hold in what was written, by its own differences.
    rates = np.abs(np.diff(angles[:, 1:5], axis=0) / np.diff(angles[:, :1], axis=0))
    assert (rates <= np.array([200, 250, 300, 600]) * (1 + 1e-6)).all()


def test_the_default_method_plans_the_whole_flight(tmp_path: Path) -> None:
    done = typed("solve", written(tmp_path, GOOD), "--rig", "vertical-limited", "--out", tmp_path / "out.csv")
    assert done.returncode == 0, done.stderr
    assert " plan:" in done.stdout


def test_solve_and_help_stay_light(tmp_path: Path) -> None:
    flight = written(tmp_path, GOOD)
    program = (
        "import sys; sys.argv = ['fullpose', *sys.argv[1:]]\n"
        "from fullpose_server.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "print(sorted(m for m in sys.modules if '.' not in m), file=sys.stderr)"
    )
    env = os.environ | {"PYTHONPATH": PYTHONPATH}

    def loaded(*arguments: str | Path) -> set[str]:
        command = [sys.executable, "-c", program, *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, env=env, check=True)
        return set(ast.literal_eval(done.stderr.splitlines()[-1]))

    server_side = {"fastapi", "starlette", "sqlalchemy", "alembic", "viser", "uvicorn", "httpx", "mcap"}
    solving = loaded("solve", flight, "--rig", "vertical-4", "--method", "exact", "--out", tmp_path / "out.csv")
    assert "numba" in solving
    assert not solving & (server_side | {"piqp", "matplotlib"})
    assert not loaded("--help") & (server_side | {"numpy", "numba", "scipy", "pyarrow"})


def test_rigs_lists_the_built_in_ones_and_checks_files(tmp_path: Path) -> None:
    text = typed("rigs").stdout
    for name in ("vertical-4", "horizontal-4", "vertical-3", "horizontal-3", "vertical-limited"):
        assert f"{name}:" in text
    assert "-60..60 deg" in text
    bad = tmp_path / "bad.toml"
    bad.write_text("name = 1")
    assert typed("rigs", bad).returncode == 2


def test_doctor_tells_one_line_a_check(tmp_path: Path) -> None:
    done = typed("doctor", "--data-dir", tmp_path)
    assert done.returncode in (0, 2)
    topics = [line[6:18].strip() for line in done.stdout.splitlines()]
    assert topics == ["version", "real time", "memory", "telemetry", "timer", "data", "port", "console", "solver"]
    assert (done.returncode == 2) == any(line.startswith("wrong") for line in done.stdout.splitlines())


def test_export_says_what_there_is(tmp_path: Path) -> None:
    done = typed("export", "latest", "--data-dir", tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_remedy_says_what_was_changed_and_writes_the_flight_so(tmp_path: Path) -> None:
    flight = written(tmp_path, HEADER + "".join(f"{k / 100},10,20,{9 * k}\n" for k in range(80)))
    out, report = tmp_path / "out.csv", tmp_path / "r.json"
    common = ("--rig", "vertical-4", "--out", out, "--report", report)
    done = typed("remedy", flight, *common, "--kind", "slow_down")
    assert done.returncode == 0, done.stderr
    made = json.loads(report.read_text())
    factor = made["remedy"]["value"]
    longer = 0.79 * (factor - 1.0)
    assert done.stdout == f"flown {factor:.4g} times as slow, {longer:.3g} s ({100.0 * (factor - 1.0):.3g} %) longer\n"
    assert made["feasible"] is made["remedy"]["sufficient"] is True
    assert made["margins"]["inner"]["rate_deg_s"]["value"] >= 0.0
    names, angles = table(out)
    time_s = angles[:, names.index("time_s")]
    assert factor > 1.0
    assert time_s[-1] - time_s[0] == pytest.approx(0.79 * factor, rel=0.03)
    for more, status, told in (
        (("--kind", "magic"), 2, "slow_down, heading_offset"),
        (("--kind", "slow_down", "--frame", "base"), 2, "relax"),
        (("--kind", "relax", "--limit", "snap"), 2, "acceleration"),
        (("--kind", "relax", "--frame", "outer", "--limit", "acceleration"), 3, "outer acceleration"),
    ):
        done = typed("remedy", flight, *common, *more)
        assert done.returncode == status, done.stderr
        *taken, why = done.stderr.splitlines()
        assert told in why
        # Of bad input there is one line; else what was taken of the file comes first.
        assert [": read as csv: " in line for line in taken] == [True] * (1 if status == 3 else 0)
