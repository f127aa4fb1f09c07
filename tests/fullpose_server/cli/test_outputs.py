"""Commands that write files never write over what they read, nor one file over another."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fullpose_server.cli import build
from fullpose_server.errors import FileError

FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n0,1,2,3\n1,2,3,4\n"
RIG = 'name = "bench"\ngeometry = "vertical-4"\n'


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ("solve f.csv --out f.csv", "--out, this one is IN"),
        ("solve f.csv --out o.csv --report f.csv", "--report, this one is IN"),
        ("solve f.csv --out o.csv --report ./o.csv", "--report, this one is --out"),
        ("solve f.csv --out o.csv --report r.json --plot r.json", "--plot, this one is --report"),
        ("solve f.csv --out link.csv", "--out, this one is IN"),
        ("solve f.csv --out bench.toml", "--out, this one is the file of --rig"),
        ("solve f.csv --out -", "standard output"),
        ("remedy f.csv --kind slow_down --out f.csv", "--out, this one is IN"),
        ("remedy f.csv --kind slow_down --out o.csv --report o.csv", "--report, this one is --out"),
        ("compare f.csv --report f.csv", "--report, this one is IN"),
        ("compare f.csv --report r.json --page r.json", "--page, this one is --report"),
    ],
)
def test_two_files_are_never_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: str, told: str) -> None:
    monkeypatch.chdir(tmp_path)
    Path("f.csv").write_text(FLIGHT)
    Path("bench.toml").write_text(RIG)
    Path("link.csv").symlink_to("f.csv")
    result = CliRunner().invoke(build(), [*arguments.split(), "--rig", "bench.toml"])
    assert isinstance(result.exception, FileError)  # exit status 2, by `main`
    assert told in str(result.exception)
    assert Path("f.csv").read_text() == FLIGHT
    assert Path("bench.toml").read_text() == RIG
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bench.toml", "f.csv", "link.csv"]
