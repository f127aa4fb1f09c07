"""What commands that solve are told: the flight or scenario, its convention, the start pose."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fullpose_server.cli._exit import fail, say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fullpose.rig import Rig


@dataclass(frozen=True)
class Flight:
    """time (n,) [s], q (n, 4) reference to body, the start pose (4,) [rad] or None where it is free, and warnings."""

    time: "NDArray[Any]"
    q: "NDArray[Any]"
    start: "NDArray[Any] | None"
    warnings: tuple[Any, ...] = ()


def read_flight(path: Path, convention: str, rig: "Rig", start: str | None) -> Flight:
    """The flight of a CSV or Parquet file, or of a scenario (TOML); its warnings are said.

    start: the text of --start, which comes before the scenario's own. Raises `ServerError`, `InputError`.
    """
    pose = None if start is None else _pose(start, rig)  # first: a file may take long to read
    how = read_convention(convention)
    if path.suffix == ".toml":
        return _scenario(path, rig, pose)
    from fullpose_server.formats.trajectory_file import read_trajectory

    trajectory = read_trajectory(path, how)
    for caution in trajectory.warnings:
        say(f"{path}: warning: {caution.message}")
    return Flight(trajectory.time, trajectory.q, pose, trajectory.warnings)


def _scenario(path: Path, rig: "Rig", pose: "NDArray[Any] | None") -> Flight:
    import numpy as np

    from fullpose_server.formats.scenario_file import read_scenario
    from fullpose_server.formats.start_pose import check_range

    scenario = read_scenario(path)
    if pose is None and scenario.start is not None:
        check_range(scenario.start, rig, f"{path}: start_deg")
        pose = np.array(scenario.start)
    return Flight(scenario.time, scenario.quaternion, pose)


def _pose(text: str, rig: "Rig") -> "NDArray[Any]":
    import numpy as np

    from fullpose_server.formats.start_pose import start_pose

    try:
        angles = [float(part) for part in text.split(",")]
    except ValueError:
        angles = []
    if len(angles) != 4 or not np.isfinite(angles).all():
        fail(f"--start {text}: expected four angles in degrees, base,outer,middle,inner, such as 0,0,0,0")
    return np.array(start_pose(angles, rig, "--start"))


def read_convention(text: str) -> Any:
    """The convention of that name; anything else ends the command."""
    from fullpose_server.formats.trajectory import Convention

    try:
        return Convention(text)
    except ValueError:
        fail(f"--convention {text}: expected one of {', '.join(Convention)}")
