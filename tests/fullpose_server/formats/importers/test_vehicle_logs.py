"""PX4, ArduPilot and MAVLink: a flight's log in, its attitude out, as the truth that SciPy has of it."""

from pathlib import Path

import numpy as np
import pytest

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import Bounds, TooLargeError
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory_file import read_trajectory
from tests.support import logs
from tests.support.attitudes import attitude_error_deg
from tests.support.reading import flight_or_error

FLOAT32_DEG = 2e-5  # what is left of an angle of 3 rad, or of a quaternion, in single precision


def test_px4_ulog(tmp_path: Path) -> None:
    flight = read_trajectory(logs.ulog(tmp_path / "log"))
    assert (flight.taken.format, flight.taken.profile, flight.taken.table) == ("ulog", "px4", "vehicle_attitude")
    assert attitude_error_deg(flight, logs.NED, "ned") < FLOAT32_DEG
    np.testing.assert_allclose(flight.time, (logs.TIME_US - logs.TIME_US[0]) * 1e-6, atol=1e-12)


def test_px4_ulog_takes_the_estimate_and_others_by_request(tmp_path: Path) -> None:
    path = logs.ulog(tmp_path / "log", ("vehicle_attitude_groundtruth", "vehicle_attitude"))
    assert read_trajectory(path).taken.table == "vehicle_attitude"
    asked = read_trajectory(path, options=ReadOptions(source="vehicle_attitude_groundtruth"))
    assert asked.taken.table == "vehicle_attitude_groundtruth"
    assert attitude_error_deg(asked, logs.NED, "ned") < FLOAT32_DEG
    with pytest.raises(FileError, match="a source among vehicle_attitude, vehicle_attitude_groundtruth"):
        read_trajectory(path, options=ReadOptions(source="vehicle_atitude"))


def test_px4_ulog_of_two_estimators_is_for_a_person_to_choose(tmp_path: Path) -> None:
    path = logs.ulog(tmp_path / "log", ("vehicle_attitude", "vehicle_attitude"))
    with pytest.raises(FileError, match=r"source takes one of: vehicle_attitude, vehicle_attitude/1$"):
        read_trajectory(path)
    assert read_trajectory(path, options=ReadOptions(source="vehicle_attitude/1")).time.size == logs.SAMPLES


@pytest.mark.parametrize(("letters", "resolution_deg"), [("Qfff", FLOAT32_DEG), ("QccC", 0.01)])
def test_ardupilot_dataflash(tmp_path: Path, letters: str, resolution_deg: float) -> None:
    flight = read_trajectory(logs.dataflash(tmp_path / "log", letters))
    assert (flight.taken.format, flight.taken.profile, flight.taken.table) == ("dataflash", "ardupilot", "ATT")
    assert attitude_error_deg(flight, logs.NED, "ned") < resolution_deg
    np.testing.assert_allclose(flight.time, (logs.TIME_US - logs.TIME_US[0]) * 1e-6, atol=1e-12)


@pytest.mark.parametrize("v1", [False, True])
@pytest.mark.parametrize("quaternion", [False, True])
def test_mavlink_tlog(tmp_path: Path, quaternion: bool, v1: bool) -> None:
    flight = read_trajectory(logs.tlog(tmp_path / "log", quaternion=quaternion, v1=v1))
    name = "ATTITUDE_QUATERNION" if quaternion else "ATTITUDE"
    assert (flight.taken.format, flight.taken.table) == ("tlog", f"1.1/{name}")
    assert attitude_error_deg(flight, logs.NED, "ned") < FLOAT32_DEG
    np.testing.assert_allclose(flight.time, (logs.TIME_US - logs.TIME_US[0]) * 1e-6, atol=1e-12)


def test_mavlink_tlog_of_two_vehicles_is_for_a_person_to_choose(tmp_path: Path) -> None:
    path = logs.tlog(tmp_path / "log", ((1, 1), (2, 1)))
    with pytest.raises(
        FileError, match=r"2 attitudes: expected one .*source takes one of: 1\.1/ATTITUDE, 2\.1/ATTITUDE$"
    ):
        read_trajectory(path)
    flight = read_trajectory(path, options=ReadOptions(source="2.1/ATTITUDE"))
    assert attitude_error_deg(flight, logs.NED, "ned") < FLOAT32_DEG


def test_mavlink_tlog_with_damage_is_read_around_it_and_says_so(tmp_path: Path) -> None:
    path = logs.tlog(tmp_path / "log")
    data = bytearray(path.read_bytes())
    half = len(data) // 2
    path.write_bytes(bytes(data[:half]) + b"\x00" * 100 + bytes(data[half:-7]))
    flight = read_trajectory(path)
    assert logs.SAMPLES - 4 < flight.time.size < logs.SAMPLES
    assert "damaged" in [each.code for each in flight.warnings]


@pytest.mark.parametrize("write", [logs.ulog, logs.dataflash, logs.tlog])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.97])
def test_a_log_that_is_cut_off_gives_what_was_read_or_one_clear_error(
    tmp_path: Path, write: object, share: float
) -> None:
    path = write(tmp_path / "log")  # type: ignore[operator]
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    flight, told = flight_or_error(path)
    if flight is None:
        assert share < 0.1, told
    else:
        assert 0.9 * share * logs.SAMPLES - 12 < flight.time.size <= logs.SAMPLES


@pytest.mark.parametrize("write", [logs.ulog, logs.dataflash, logs.tlog])
def test_a_log_beyond_the_bounds_is_refused(tmp_path: Path, write: object) -> None:
    with pytest.raises(TooLargeError, match="at most 100 rows"):
        read_trajectory(write(tmp_path / "log"), bounds=Bounds(rows=100, columns=100))  # type: ignore[operator]
