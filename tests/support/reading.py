"""A file read, or why not."""

from pathlib import Path

from fullpose_server.errors import FileError
from fullpose_server.formats.trajectory import Trajectory
from fullpose_server.formats.trajectory_file import read_trajectory


def flight_or_error(path: Path) -> tuple[Trajectory | None, str]:
    """The flight and "", or None and the one line that a person is told; whatever else it raises is a bug."""
    try:
        return read_trajectory(path), ""
    except FileError as error:
        told = str(error)
        assert told.startswith(str(path)), told
        assert "\n" not in told, told
        return None, told
