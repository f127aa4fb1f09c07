"""Every script in examples/ runs, and says what its first lines promise."""

import os
import subprocess
import sys

import pytest

from tests.support.repository import PYTHONPATH, ROOT

SAID = {
    "solve_flight.py": ["loop on vertical-4", "loop on horizontal-4", "flown exactly, inside every limit"],
    "fourth_axis.py": ["vertical-3: fastest frame 2", "vertical-4: fastest frame"],
}

NEED_A_SERVER = {"live_jsbsim.py", "udp_client.py"}  # test_live_scripts.py


def run(script: str, *arguments: str) -> str:
    """The script's output, run as a person would from the repository's root."""
    done = subprocess.run(
        [sys.executable, "-W", "error", f"examples/{script}", *arguments],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": PYTHONPATH},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_every_script_is_known_here() -> None:
    assert {path.name for path in (ROOT / "examples").glob("*.py")} == set(SAID) | NEED_A_SERVER


@pytest.mark.parametrize("script", SAID)
def test_script_runs(script: str) -> None:
    output = run(script)
    for expected in SAID[script]:
        assert expected in output


def test_another_flight_can_be_given() -> None:
    assert "split_s on vertical-4: 27531 samples" in run("solve_flight.py", "examples/flights/split_s.csv")
