"""Logs as other programs write them, of one flight; each by the writer of its format's library where there is one."""

import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import Writer as McapWriter
from pymavlink.dialects.v20 import common
from pyulog import ULog
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

SAMPLES, STEP_US = 200, 20_000
TIME_US = 5_000_000 + np.arange(SAMPLES) * STEP_US
_T = np.arange(SAMPLES) * STEP_US * 1e-6
YPR = np.stack([40.0 + 15.0 * _T, 14.0 * np.sin(_T), 22.5 * np.sin(0.7 * _T)], axis=-1)  # heading, pitch, bank [deg]
NED = Rotation.from_euler("ZYX", YPR, degrees=True)  # body (forward, right, down) to north, east, down
# The same attitude of x forward, y left, z up in east, north, up.
ENU = Rotation.from_matrix(np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]]) @ NED.as_matrix() @ np.diag([1.0, -1.0, -1.0]))
_ROS1, _ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
STAMP_NS = 1_790_000_000_000_000_000


def ulog(path: Path, topics: tuple[str, ...] = ("vehicle_attitude",)) -> Path:
    """As PX4 writes it, then written again by pyulog."""
    raw = bytearray(b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0))

    def add(kind: str, body: bytes) -> None:
        raw.extend(struct.pack("<HB", len(body), ord(kind)) + body)

    add("B", bytes(40))
    for name in sorted(set(topics)):
        add("F", f"{name}:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;".encode())
    for number, name in enumerate(topics):
        add("A", struct.pack("<BH", topics[:number].count(name), number) + name.encode())
    for k, q in enumerate(NED.as_quat(scalar_first=True)):
        for number in range(len(topics)):
            add("D", struct.pack("<HQQ4f", number, TIME_US[k], TIME_US[k], *q))
    first = path.with_suffix(".px4")
    first.write_bytes(bytes(raw))
    ULog(str(first)).write_ulog(str(path))
    first.unlink()
    return path


def dataflash(path: Path, letters: str = "Qfff") -> Path:
    """As ArduPilot writes it: formats first, then messages."""
    names, size = "TimeUS,Roll,Pitch,Yaw", 3 + struct.calcsize("<" + letters.replace("c", "h").replace("C", "H"))
    scale = 100.0 if "c" in letters else 1.0
    raw = io.BytesIO()

    def form(number: int, length: int, name: str, kinds: str, columns: str) -> None:
        fields = (name.encode(), kinds.encode(), columns.encode())
        raw.write(b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", number, length, *fields))

    form(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")
    form(0x81, size, "ATT", letters, names)
    form(0x82, 3 + 8 + 2, "OTHR", "QH", "TimeUS,Value")
    for at, (yaw, pitch, roll) in zip(TIME_US, YPR, strict=True):
        values = [value * scale for value in (roll, pitch, yaw)]
        packed = [round(v) for v in values] if "c" in letters else values
        raw.write(b"\xa3\x95\x81" + struct.pack("<" + letters.replace("c", "h").replace("C", "H"), at, *packed))
        raw.write(b"\xa3\x95\x82" + struct.pack("<QH", at, 7))
    path.write_bytes(raw.getvalue())
    return path


def tlog(
    path: Path, senders: tuple[tuple[int, int], ...] = ((1, 1),), *, quaternion: bool = False, v1: bool = False
) -> Path:
    """By pymavlink: angles and, where asked for, quaternions too, between heartbeats."""
    raw = io.BytesIO()
    for k, at in enumerate(TIME_US):
        for system, component in senders:
            packer = common.MAVLink(None, srcSystem=system, srcComponent=component)
            yaw, pitch, roll = np.radians(YPR[k])
            boot = int(at // 1000)
            messages: list[Any] = [packer.heartbeat_encode(2, 3, 0, 0, 4)]
            if quaternion:
                messages.append(packer.attitude_quaternion_encode(boot, *NED[k].as_quat(scalar_first=True), 0, 0, 0))
            else:
                messages.append(packer.attitude_encode(boot, roll, pitch, yaw, 0, 0, 0))
            for message in messages:
                raw.write(struct.pack(">Q", STAMP_NS // 1000 + int(at)) + message.pack(packer, force_mavlink1=v1))
    path.write_bytes(raw.getvalue())
    return path


def ros_message(store: Any, kind: str, k: int, *, stamped: bool = True) -> Any:
    """An Imu, Odometry, PoseStamped or Pose with the attitude of sample k."""
    types = store.types
    x, y, z, w = ENU[k].as_quat()
    q = types["geometry_msgs/msg/Quaternion"](x, y, z, w)
    at = STAMP_NS + int(TIME_US[k]) * 1000 if stamped else 0
    stamp = types["builtin_interfaces/msg/Time"](at // 10**9, at % 10**9)
    extra = {"seq": k} if store is _ROS1 else {}
    header = types["std_msgs/msg/Header"](**extra, stamp=stamp, frame_id="map")
    zero, nine = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0), np.zeros(9)
    pose = types["geometry_msgs/msg/Pose"](types["geometry_msgs/msg/Point"](1.0, 2.0, 3.0), q)
    match kind:
        case "sensor_msgs/msg/Imu":
            return types[kind](header, q, nine, zero, nine, zero, nine)
        case "nav_msgs/msg/Odometry":
            twist = types["geometry_msgs/msg/TwistWithCovariance"](
                types["geometry_msgs/msg/Twist"](zero, zero), np.zeros(36)
            )
            covered = types["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36))
            return types[kind](header, "base_link", covered, twist)
        case "geometry_msgs/msg/PoseStamped":
            return types[kind](header, pose)
        case _:
            return pose


def rosbag1(path: Path, topics: dict[str, str]) -> Path:
    """By rosbags; topics by their type."""
    with Ros1Writer(path) as writer:
        for topic, kind in topics.items():
            connection = writer.add_connection(topic, kind, typestore=_ROS1)
            for k in range(SAMPLES):
                data = _ROS1.serialize_ros1(ros_message(_ROS1, kind, k), kind)
                writer.write(connection, STAMP_NS + int(TIME_US[k]) * 1000, data)
    return path


def rosbag2(folder: Path, topics: dict[str, str], *, mcap: bool) -> Path:
    """By rosbags; the file with the messages in it."""
    plugin = StoragePlugin.MCAP if mcap else StoragePlugin.SQLITE3
    with Ros2Writer(folder, version=9, storage_plugin=plugin) as writer:
        for topic, kind in topics.items():
            connection = writer.add_connection(topic, kind, typestore=_ROS2)
            for k in range(SAMPLES):
                data = _ROS2.serialize_cdr(ros_message(_ROS2, kind, k), kind)
                writer.write(connection, STAMP_NS + int(TIME_US[k]) * 1000, data)
    (found,) = folder.glob("*.mcap" if mcap else "*.db3")
    return found


def json_mcap(path: Path, *, attitudes: bool = True) -> Path:
    """JSON messages on two topics, one of them an attitude in ours; or on the other alone."""
    with path.open("wb") as stream:
        writer = McapWriter(stream)
        writer.start()
        schema = writer.register_schema("attitude", "jsonschema", b"{}")
        attitude = writer.register_channel("/attitude", "json", schema)
        other = writer.register_channel("/battery", "json", schema)
        for k, at in enumerate(TIME_US):
            heading, pitch, bank = YPR[k]
            said = {"time_s": at * 1e-6, "heading_deg": heading, "pitch_deg": pitch, "bank_deg": bank, "note": "x"}
            if attitudes:
                writer.add_message(attitude, int(at) * 1000, json.dumps(said).encode(), int(at) * 1000)
            writer.add_message(other, int(at) * 1000, b'{"volts": 11.1}', int(at) * 1000)
        writer.finish()
    return path
