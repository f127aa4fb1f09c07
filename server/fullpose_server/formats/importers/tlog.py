"""MAVLink telemetry logs (.tlog): a stamp of 8 bytes before each frame, of version 1 or 2.

Frames are told apart by their header; those of attitudes are decoded and checked by pymavlink, the rest is passed over.
"""

import mmap
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import common

from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, check_rows
from fullpose_server.formats.importers.mavlink_frames import STAMP, frame_length
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Table, table_of

ABOUT = "MAVLink telemetry log"
_FIELDS = {
    "ATTITUDE": ("time_boot_ms", "roll", "pitch", "yaw"),
    "ATTITUDE_QUATERNION": ("time_boot_ms", "q1", "q2", "q3", "q4"),
}
_PROFILES = {"ATTITUDE": "mavlink", "ATTITUDE_QUATERNION": "mavlink-quaternion"}
_IDS = {common.MAVLINK_MSG_ID_ATTITUDE, common.MAVLINK_MSG_ID_ATTITUDE_QUATERNION}
_V2 = 0xFD
_MOST_SKIPPED = 1_000_000  # bytes: what has more that is no message is another kind of file


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each sender and message, `1.1/ATTITUDE`: of system 1, component 1. Raises `FileError`, `TooLargeError`.

    The quaternions of a sender that also sends angles are read by request: they are the same attitude.
    """
    rows: dict[tuple[str, str], list[tuple[float, ...]]] = defaultdict(list)
    with parsing(file, ABOUT):
        skipped = _decode(path, file, rows, bounds)
    cautions: tuple[Caution, ...] = ()
    if skipped:
        cautions = (Caution("damaged", f"{skipped} bytes of the log are no whole messages: they were passed over"),)
    senders = {sender for sender, message in rows if message == "ATTITUDE"}
    tables = []
    for sender, message in sorted(rows, key=lambda key: (key[1] != "ATTITUDE", key)):
        table = np.array(rows[sender, message])
        made = table_of(
            file,
            "tlog",
            {name: np.ascontiguousarray(table[:, k]) for k, name in enumerate(_FIELDS[message])},
            name=f"{sender}/{message}",
            row_word="message",
            profile=_PROFILES[message],
            cautions=cautions,
        )
        tables.append(replace(made, on_request=message != "ATTITUDE" and sender in senders))
    if not tables:
        raise FileError(file, "ATTITUDE or ATTITUDE_QUATERNION messages in the log; it has no attitude")
    return tuple(tables)


def _decode(path: Path, file: str, rows: dict[tuple[str, str], list[tuple[float, ...]]], bounds: Bounds) -> int:
    """Fill `rows` by sender and message; returns how many bytes are of no message."""
    reader: Any = common.MAVLink(None)
    skipped = at = 0
    with path.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
        while at + STAMP < len(data):
            length = frame_length(data, at + STAMP)
            end = at + STAMP + length
            followed = end + STAMP + 3 > len(data) or frame_length(data, end + STAMP)
            if not length or end > len(data) or not followed:  # a byte that looks like a frame's first one is none
                skipped += 1
                at += 1
                if skipped > _MOST_SKIPPED:
                    raise FileError(file, f"a {ABOUT}, messages throughout", value=f"byte {at}")
                continue
            frame, at = data[at + STAMP : end], end
            number = int.from_bytes(frame[7:10], "little") if frame[0] == _V2 else frame[5]
            if number not in _IDS:
                continue
            try:
                message = reader.decode(bytearray(frame))
            except common.MAVError:
                skipped += STAMP + length
                continue
            name = message.get_type()
            key = (f"{message.get_srcSystem()}.{message.get_srcComponent()}", name)
            rows[key].append(tuple(getattr(message, each) for each in _FIELDS[name]))
            check_rows(len(rows[key]), bounds, file)
            if bounds.progress is not None and len(rows[key]) % 1024 == 0:
                bounds.progress(at, len(data))
    return skipped
