"""What commands that solve are told: the flight or scenario, its convention, the start pose."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fullpose_server.cli._arguments import ReadingArguments
from fullpose_server.cli._exit import fail, say
from fullpose_server.cli._progress import progress_bar

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fullpose.rig import Rig
    from fullpose_server.formats.read_options import ReadOptions
    from fullpose_server.formats.trajectory import Trajectory


@dataclass(frozen=True)
class Flight:
    """time (n,) [s], q (n, 4) reference to body, the start pose (4,) [rad] or None where it is free, and warnings.

    A command says what was taken (`tell`) once nothing can be bad input any more: of that there is one line alone.
    """

    time: "NDArray[Any]"
    q: "NDArray[Any]"
    start: "NDArray[Any] | None"
    warnings: tuple[Any, ...] = ()
    input: dict[str, Any] = field(default_factory=dict)  # what was taken of the file, for the report
    statements: tuple[str, ...] = ()  # the same, a line each

    def tell(self) -> None:
        """Say what was taken of the file, and each warning."""
        for statement in self.statements:
            say(statement)


def read_flight(path: Path, asked: ReadingArguments, rig: "Rig", start: str | None) -> Flight:
    """The flight of a file, or of a scenario (TOML).

    start: the text of --start, which comes before the scenario's own. Raises `ServerError`, `InputError`.
    """
    pose = None if start is None else _pose(start, rig)  # first: a file may take long to read
    how = read_options(asked)
    if path.suffix == ".toml":
        return _scenario(path, rig, pose)
    from fullpose_server.formats.importers.columns import UNBOUNDED
    from fullpose_server.formats.trajectory_file import read_trajectory

    with progress_bar("read", lines=True) as progress:
        trajectory = read_trajectory(path, bounds=replace(UNBOUNDED, progress=progress), options=how)
    taken = input_report(path, trajectory)
    return Flight(trajectory.time, trajectory.q, pose, trajectory.warnings, taken, statements(path, trajectory))


def read_options(asked: ReadingArguments) -> "ReadOptions":
    """How to read, as a command was told; a convention that is none ends the command."""
    from fullpose_server.formats.read_options import ReadOptions

    return ReadOptions(
        convention=None if asked.convention is None else read_convention(asked.convention),
        profile=asked.profile,
        source=asked.source,
        strict=asked.strict,
        bridge_gaps=asked.bridge_gaps,
        drop_duplicates=asked.drop_duplicates,
    )


def statements(path: Path, trajectory: "Trajectory") -> tuple[str, ...]:
    """What was taken of a file, and each warning."""
    taken = trajectory.taken
    head = f"{path}: read as {taken.format}{f', {taken.table}' if taken.table else ''}: {taken.statement}"
    return (head, *(f"{path}: warning: {caution.message}" for caution in trajectory.warnings))


def input_report(path: Path, trajectory: "Trajectory") -> dict[str, Any]:
    """The key `input` of a report."""
    from fullpose_server.formats.input_report import input_of

    return {"file": str(path), **input_of(trajectory)}


def _scenario(path: Path, rig: "Rig", pose: "NDArray[Any] | None") -> Flight:
    import numpy as np

    from fullpose_server.formats.scenario_file import read_scenario
    from fullpose_server.formats.start_pose import check_range

    scenario = read_scenario(path)
    if pose is None and scenario.start is not None:
        check_range(scenario.start, rig, f"{path}: start_deg")
        pose = np.array(scenario.start)
    taken = {"file": str(path), "format": "scenario", "profile": "", "convention": "nue", "warnings": []}
    return Flight(scenario.time, scenario.quaternion, pose, input=taken)


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
