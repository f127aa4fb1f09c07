"""ROS 1 bags."""

from pathlib import Path

from rosbags.rosbag1 import Reader

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.ros_messages import decoder_of
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.importers.topics import Topics

ABOUT = "ROS 1 bag"


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each topic with an attitude. Raises `FileError`, `TooLargeError`."""
    topics = Topics(file, "rosbag1", bounds)
    with parsing(file, ABOUT), Reader(path) as bag:
        decoders = {each.id: decoder_of(each.msgtype, "ros1", file) for each in bag.connections}
        wanted = [each for each in bag.connections if decoders[each.id] is not None]
        told = [f"{each.topic} ({each.msgtype})" for each in bag.connections]
        for connection, log_ns, data in bag.messages(connections=wanted) if wanted else ():
            if (decoder := decoders[connection.id]) is not None:
                topics.add(connection.topic, decoder, log_ns, data)
    tables = topics.tables()
    if not tables:
        raise FileError(file, f"a topic with an attitude among {', '.join(told[:8]) or 'no topics'}")
    return tables
