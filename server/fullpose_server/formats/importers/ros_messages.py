"""Attitudes of ROS messages, by rosbags: the quaternion is body to map, x forward, y left, z up (REP 103)."""

from collections.abc import Callable
from functools import cache
from operator import attrgetter
from typing import Any

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.topics import Decoder, Reading

# Where the orientation is in each type.
ORIENTATION = {
    "sensor_msgs/msg/Imu": "orientation",
    "nav_msgs/msg/Odometry": "pose.pose.orientation",
    "geometry_msgs/msg/Pose": "orientation",
    "geometry_msgs/msg/PoseStamped": "pose.orientation",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "pose.pose.orientation",
    "geometry_msgs/msg/QuaternionStamped": "quaternion",
    "geometry_msgs/msg/TransformStamped": "transform.rotation",
}
COLUMNS = ("orientation.w", "orientation.x", "orientation.y", "orientation.z")


def type_of(name: str) -> str:
    """The name of a type as ROS 2 has it: `sensor_msgs/msg/Imu` of ROS 1's `sensor_msgs/Imu`."""
    package, _, rest = name.partition("/")
    return f"{package}/msg/{rest.removeprefix('msg/')}"


def decoder_of(name: str, encoding: str, file: str) -> Decoder | None:
    """Of the messages of a type in `cdr` or `ros1`; None: it has no attitude. Raises `FileError` without the extra."""
    kind = type_of(name)
    if kind not in ORIENTATION or encoding not in ("cdr", "ros1"):
        return None
    try:
        deserialize = _deserializer(encoding)
    except ModuleNotFoundError:
        raise FileError(file, "the extra ros for ROS messages: pip install 'fullpose[ros]'") from None
    orientation = attrgetter(ORIENTATION[kind])

    def read(data: bytes) -> Reading | None:
        message = deserialize(data, kind)
        covariance = getattr(message, "orientation_covariance", None)
        if covariance is not None and covariance[0] == -1.0:  # how an Imu says that it has none
            return None
        q = orientation(message)
        header = getattr(message, "header", None)
        stamp = None if header is None else header.stamp.sec * 1_000_000_000 + header.stamp.nanosec
        return Reading(stamp, (q.w, q.x, q.y, q.z))

    return Decoder(COLUMNS, read, "ros")


@cache
def _deserializer(encoding: str) -> Callable[[bytes, str], Any]:
    from rosbags.typesys import Stores, get_typestore  # an extra

    if encoding == "ros1":
        ros1: Callable[[bytes, str], Any] = get_typestore(Stores.ROS1_NOETIC).deserialize_ros1
        return ros1
    cdr: Callable[[bytes, str], Any] = get_typestore(Stores.ROS2_HUMBLE).deserialize_cdr
    return cdr
