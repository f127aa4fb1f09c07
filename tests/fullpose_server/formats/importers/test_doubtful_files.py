"""No file is wrong in silence: each is the flight, or a caution says what is doubtful, or words refuse it."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose_server.errors import FileError
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.formats.trajectory_file import read_trajectory
from tests.support.attitudes import attitude_error_deg
from tests.support.doubtful_texts import DOUBTFUL, NAMES, TIME, Doubtful, table

WRONG_DEG = 0.1


def read(folder: Path, file: Doubtful) -> Trajectory:
    path = folder / "flight.csv"
    path.write_bytes(file.content.encode() if isinstance(file.content, str) else file.content)
    said = dict(file.said)
    convention = said.pop("convention", None)
    options = ReadOptions(None if convention is None else Convention(convention), **said)  # type: ignore[arg-type]
    return read_trajectory(path, name="flight.csv", options=options)


@pytest.mark.parametrize("kind", list(DOUBTFUL))
def test_nothing_is_wrong_in_silence(tmp_path: Path, kind: str) -> None:
    file = DOUBTFUL[kind]
    if file.refused:
        with pytest.raises(FileError) as caught:
            read(tmp_path, file)
        assert file.right in str(caught.value)
        return
    flight = read(tmp_path, file)
    found = {caution.code: caution.message for caution in flight.warnings}
    if file.right == "flight":
        assert not found
        assert attitude_error_deg(flight, file.truth, file.axes) < WRONG_DEG
    else:
        assert file.place in found[file.right]


@pytest.mark.parametrize("each", [150.0, 192.0, 240.0, 330.0, 359.0, 360.0, 500.0])
def test_a_spin_that_counts_its_turns_beside_a_heading_that_wraps(tmp_path: Path, each: float) -> None:
    heading, bank = 300.0 + 2.0 * np.arange(TIME.size), each * np.arange(TIME.size)
    content = table(NAMES, TIME, np.mod(heading, 360.0), 0.0 * TIME + 3.0, bank)
    flight = read(tmp_path, Doubtful(content, "turns"))
    at = flight.time / 0.02
    angles = np.column_stack([300.0 + 2.0 * at, 0.0 * at + 3.0, each * at])
    assert attitude_error_deg(flight, Rotation.from_euler("ZYX", angles, degrees=True), "ned") < 1e-6
    assert "turns" in {caution.code for caution in flight.warnings}
