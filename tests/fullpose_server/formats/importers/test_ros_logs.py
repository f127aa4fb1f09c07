"""MCAP and the bags of ROS 1 and 2: Imu, Odometry and Pose in, the same attitude out; and our own runs."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.rig import builtin_rigs
from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import Bounds, TooLargeError
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory_file import read_trajectory
from fullpose_server.runtime.contract.telemetry import SAMPLE
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from tests.support import logs
from tests.support.attitudes import attitude_error_deg
from tests.support.reading import flight_or_error

KINDS = ["sensor_msgs/msg/Imu", "nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Pose"]
TWO = {"/imu/data": KINDS[0], "/odom": KINDS[1]}


def bag(folder: Path, store: str, topics: dict[str, str]) -> Path:
    match store:
        case "ros1":
            return logs.rosbag1(folder / "bag", topics)
        case "sqlite":
            return logs.rosbag2(folder / "bag", topics, mcap=False)
        case _:
            return logs.rosbag2(folder / "bag", topics, mcap=True)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("store", ["ros1", "sqlite", "mcap"])
def test_a_bag(tmp_path: Path, store: str, kind: str) -> None:
    flight = read_trajectory(bag(tmp_path, store, {"/topic": kind}))
    assert (flight.taken.profile, flight.taken.table) == ("ros", "/topic")
    assert attitude_error_deg(flight, logs.ENU, "enu") < 1e-9
    np.testing.assert_allclose(flight.time, (logs.TIME_US - logs.TIME_US[0]) * 1e-6, atol=1e-9)
    assert ("log-time" in [each.code for each in flight.warnings]) == (kind == "geometry_msgs/msg/Pose")


@pytest.mark.parametrize("store", ["ros1", "sqlite", "mcap"])
def test_a_bag_of_several_topics_is_for_a_person_to_choose(tmp_path: Path, store: str) -> None:
    path = bag(tmp_path, store, TWO)
    with pytest.raises(FileError, match=r"2 attitudes: expected one .*source takes one of: /imu/data, /odom$"):
        read_trajectory(path)
    flight = read_trajectory(path, options=ReadOptions(source="/odom"))
    assert flight.taken.table == "/odom"
    assert attitude_error_deg(flight, logs.ENU, "enu") < 1e-9


@pytest.mark.parametrize("store", ["ros1", "sqlite", "mcap"])
@pytest.mark.parametrize("share", [0.01, 0.6])
def test_a_bag_that_is_cut_off_gives_what_was_read_or_one_clear_error(tmp_path: Path, store: str, share: float) -> None:
    path = bag(tmp_path, store, {"/topic": KINDS[0]})
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    flight, told = flight_or_error(path)
    if flight is None:
        assert "expected a" in told
    else:
        assert "truncated" in [each.code for each in flight.warnings]


def test_a_bag_beyond_the_bounds_is_refused(tmp_path: Path) -> None:
    with pytest.raises(TooLargeError, match="at most 100 rows"):
        read_trajectory(bag(tmp_path, "mcap", {"/topic": KINDS[0]}), bounds=Bounds(100, 100))


def test_json_messages_are_columns_by_name(tmp_path: Path) -> None:
    flight = read_trajectory(logs.json_mcap(tmp_path / "log"))
    assert (flight.taken.table, flight.taken.profile) == ("/attitude", "fullpose-ned")
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9


def test_one_without_an_attitude_is_named_for_what_it_is(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="a column time_s among log_time, volts of mcap /battery"):
        read_trajectory(logs.json_mcap(tmp_path / "log", attitudes=False))


def run(path: Path, rig: str) -> np.ndarray:
    record = RunRecord(path, {"run_id": "r", "rig": rig, "who": "ann", "plan": {}}, 10**18, 10**9)
    rows = np.zeros(300, SAMPLE)
    rows["seq"] = np.arange(1, 301)
    rows["time_ns"] = 10**9 + np.arange(300) * 1_000_000
    t = np.arange(300)[:, None] * 1e-3
    rows["demand"] = np.array([10.0, 40.0, -20.0, 5.0]) + 20.0 * np.sin(t * np.array([1.0, 2.0, 3.0, 4.0]))
    rows["measured"] = rows["demand"] + 0.01
    rows["target"] = np.nan
    rows["target"][50:] = [1.0, 0.0, 0.0, 0.0]
    record.add_samples(rows)
    record.cut()
    record.finish()
    return rows


def test_a_run_s_attitude_is_that_of_its_frames(tmp_path: Path) -> None:
    rows = run(tmp_path / "run.mcap", "vertical-4")
    with pytest.raises(FileError, match=r"source takes one of: target, commanded, measured$"):
        read_trajectory(tmp_path / "run.mcap")
    letters = ["xyz"[axis] for axis in builtin_rigs()["vertical-4"].geometry.axes]
    for source, field in (("commanded", "demand"), ("measured", "measured")):
        flight = read_trajectory(tmp_path / "run.mcap", options=ReadOptions(source=source))
        truth = Rotation.identity(300)
        for k, axis in enumerate(letters):  # body to reference: from the base inwards
            truth = truth * Rotation.from_euler(axis, rows[field][:, k, None], degrees=True)
        assert attitude_error_deg(flight, truth, "nue") < 1e-9
    target = read_trajectory(tmp_path / "run.mcap", options=ReadOptions(source="target"))
    assert target.time[0] == pytest.approx(0.05)
    assert target.time.size == 250


def test_a_run_of_a_rig_that_is_not_known_has_its_target_alone(tmp_path: Path) -> None:
    run(tmp_path / "run.mcap", "bench-3")
    assert read_trajectory(tmp_path / "run.mcap").taken.table == "target"
