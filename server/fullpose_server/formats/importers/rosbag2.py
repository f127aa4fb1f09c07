"""The SQLite file of a ROS 2 bag (.db3); one that is MCAP is read as that."""

import sqlite3
from contextlib import closing
from pathlib import Path

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.ros_messages import decoder_of
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.importers.topics import Topics

ABOUT = "ROS 2 bag (SQLite)"
_TOPICS = "SELECT id, name, type, serialization_format FROM topics"
_MESSAGES = "SELECT timestamp, data FROM messages WHERE topic_id = ? ORDER BY timestamp"


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each topic with an attitude. Raises `FileError`, `TooLargeError`."""
    topics = Topics(file, "rosbag2", bounds)
    with (
        parsing(file, ABOUT),
        closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro&immutable=1", uri=True)) as bag,
    ):
        told = []
        for number, topic, kind, encoding in bag.execute(_TOPICS).fetchall():
            told.append(f"{topic} ({kind})")
            decoder = decoder_of(kind, encoding, file)
            if decoder is None:
                continue
            for log_ns, data in bag.execute(_MESSAGES, (number,)):
                topics.add(topic, decoder, log_ns, data)
    tables = topics.tables()
    if not tables:
        raise FileError(file, f"a topic with an attitude among {', '.join(told[:8]) or 'no topics'}")
    return tables
