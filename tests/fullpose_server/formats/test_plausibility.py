"""Numbers that cannot be what their columns say are told by column, line and value; those that can are left alone."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.gaps import holes
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory import Trajectory
from fullpose_server.formats.trajectory_file import read_trajectory
from tests.support.attitudes import attitude_error_deg

N = 200
TIME = 0.02 * np.arange(N)
ANGLES = np.column_stack([40 + 30 * TIME, 14 * np.sin(TIME), 25 * np.sin(2 * TIME)])  # heading, pitch, bank [deg]
NAMES = ("heading_deg", "pitch_deg", "bank_deg")


def read(folder: Path, time: np.ndarray, angles: np.ndarray, **said: object) -> Trajectory:
    path = folder / "flight.csv"
    rows = [",".join(map(repr, (t, *row))) for t, row in zip(time.tolist(), angles.tolist(), strict=True)]
    path.write_text("\n".join([f"time_s,{','.join(NAMES)}", *rows, ""]))
    return read_trajectory(path, name="flight.csv", options=ReadOptions(**said))  # type: ignore[arg-type]


def cautions(folder: Path, time: np.ndarray, angles: np.ndarray) -> dict[str, list[Caution]]:
    found: dict[str, list[Caution]] = {}
    for caution in read(folder, time, angles).warnings:
        found.setdefault(caution.code, []).append(caution)
    return found


def changed(row: int, column: int, value: float) -> np.ndarray:
    angles = ANGLES.copy()
    angles[row, column] = value
    return angles


def test_a_flight_in_order_has_no_warning(tmp_path: Path) -> None:
    assert not read(tmp_path, TIME, ANGLES).warnings


@pytest.mark.parametrize("value", [-9999.0, 655.35, 1e15, 32767.0, -999.0])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_sentinels(tmp_path: Path, value: float, column: int) -> None:
    (found,) = cautions(tmp_path, TIME, changed(50, column, value))["sentinel"]
    assert (found.column, found.row) == (NAMES[column], 52)
    assert found.value is not None
    assert float(found.value) == value


def test_a_value_that_a_column_passes_on_its_way_is_no_sentinel(tmp_path: Path) -> None:
    angles = np.column_stack([np.linspace(0.0, 1998.0, N), ANGLES[:, 1], ANGLES[:, 2]])
    angles[100, 0] = 999.0
    assert "sentinel" not in cautions(tmp_path, TIME, angles)


def test_pitch_beyond_a_quarter_turn(tmp_path: Path) -> None:
    (found,) = cautions(tmp_path, TIME, changed(50, 1, 91.0))["pitch"]
    assert (found.column, found.row, found.value) == ("pitch_deg", 52, "91")


def test_centidegrees(tmp_path: Path) -> None:
    (found,) = cautions(tmp_path, TIME, 100 * ANGLES)["pitch"]
    assert "centidegrees" in found.message


def test_radians_in_every_column(tmp_path: Path) -> None:
    found = cautions(tmp_path, TIME, np.radians(ANGLES))["angle-unit"]
    assert [caution.column for caution in found] == list(NAMES)


def test_radians_in_two_columns(tmp_path: Path) -> None:
    angles = ANGLES * [1.0, np.pi / 180.0, np.pi / 180.0]
    angles[:, 0] *= 3.0
    found = cautions(tmp_path, TIME, angles)["angle-unit"]
    assert [caution.column for caution in found] == list(NAMES[1:])


def test_radians_that_turn_on(tmp_path: Path) -> None:
    angles = np.column_stack([np.radians(ANGLES[:, :2]), 3.0 * TIME])
    found = cautions(tmp_path, TIME, angles)["angle-unit"]
    assert [caution.column for caution in found] == list(NAMES)


@pytest.mark.parametrize("factor", [1e3, 1e6])
def test_time_in_milli_or_microseconds(tmp_path: Path, factor: float) -> None:
    (found,) = cautions(tmp_path, factor * TIME, ANGLES)["time-unit"]
    assert found.column == "time_s"


def test_a_rate_that_no_body_has(tmp_path: Path) -> None:
    (found,) = cautions(tmp_path, 0.001 * TIME, ANGLES * [1, 1, 5])["body-rate"]
    assert "deg/s" in str(found.value)


def test_angles_beyond_reason(tmp_path: Path) -> None:
    (found,) = cautions(tmp_path, TIME, ANGLES + np.array([2e6, 0, 0]))["beyond-reason"]
    assert found.column == "heading_deg"


def test_a_step_whose_sense_is_a_guess(tmp_path: Path) -> None:
    (found,) = cautions(tmp_path, TIME, ANGLES + np.where(TIME > 2.0, [[120.0], [0.0], [0.0]], 0.0).T)["step"]
    assert found.row == 103


def test_turns_of_an_unwrapped_column_are_kept(tmp_path: Path) -> None:
    time, bank = 0.8 * np.arange(21), 192.0 * np.arange(21)
    flight = read(tmp_path, time, np.column_stack([0 * bank + 30, 0 * bank + 5, bank]))
    assert [caution.code for caution in flight.warnings if caution.code == "turns"] == ["turns"]
    truth = Rotation.from_euler(
        "ZYX", np.column_stack([0 * flight.time + 30, 0 * flight.time + 5, 240 * flight.time]), degrees=True
    )
    assert attitude_error_deg(flight, truth, "ned") < 1e-9
    assert set(time) <= set(flight.time)


def test_a_column_that_wraps_counts_no_turns(tmp_path: Path) -> None:
    heading = np.mod(350.0 + 60.0 * TIME, 360.0)
    flight = read(tmp_path, TIME, np.column_stack([heading, ANGLES[:, 1], ANGLES[:, 2]]))
    assert not flight.warnings
    assert flight.time.size == N


def test_a_gap_is_refused_unless_it_is_bridged(tmp_path: Path) -> None:
    kept = (TIME < 1.0) | (TIME > 3.0)
    with pytest.raises(FileError) as caught:
        read(tmp_path, TIME[kept], ANGLES[kept])
    assert "0.98 s to 3.02 s (102 median steps)" in str(caught.value)
    (found,) = read(tmp_path, TIME[kept], ANGLES[kept], bridge_gaps=True).warnings
    assert (found.code, "0.98 s to 3.02 s" in found.message) == ("bridged", True)


def test_a_lost_sample_is_told_and_flown(tmp_path: Path) -> None:
    kept = np.arange(N) != 90
    (found,) = read(tmp_path, TIME[kept], ANGLES[kept]).warnings
    assert (found.code, found.row) == ("gap", 91)


@pytest.mark.parametrize(
    "time",
    [
        np.concatenate([0.01 * np.arange(50), 0.5 + 0.1 * np.arange(50)]),  # a change of rate
        np.sort(np.random.default_rng(1).uniform(0.0, 5.0, 400)),  # uneven all over
        np.sort(np.concatenate([0.01 * np.arange(100), [0.500001]])),  # a stamp that is there twice, all but
        np.round(np.arange(400) / 400.0, 3),  # rounded
    ],
)
def test_what_is_no_gap(time: np.ndarray) -> None:
    assert not holes(time)


def test_duplicates_are_dropped_on_request(tmp_path: Path) -> None:
    time = np.insert(TIME, 50, TIME[50])
    angles = np.insert(ANGLES, 50, ANGLES[50], axis=0)
    with pytest.raises(FileError, match="; drop_duplicates keeps the first"):
        read(tmp_path, time, angles)
    flight = read(tmp_path, time, angles, drop_duplicates=True)
    np.testing.assert_array_equal(flight.time, TIME)
    assert [caution.code for caution in flight.warnings] == ["duplicates"]


def test_lines_are_the_files_after_dropping(tmp_path: Path) -> None:
    time = np.insert(TIME, 50, TIME[50])
    angles = np.insert(changed(80, 1, 95.0), 50, ANGLES[50], axis=0)
    found = [
        caution for caution in read(tmp_path, time, angles, drop_duplicates=True).warnings if caution.code == "pitch"
    ]
    assert [caution.row for caution in found] == [83]


def test_strict_refuses_what_is_warned_about_and_nothing_else(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="column pitch_deg: 91"):
        read(tmp_path, TIME, changed(50, 1, 91.0), strict=True)
    assert read(tmp_path, TIME, ANGLES, strict=True).time.size == N
    kept = (TIME < 1.0) | (TIME > 3.0)
    assert read(tmp_path, TIME[kept], ANGLES[kept], strict=True, bridge_gaps=True).time.size == kept.sum()
