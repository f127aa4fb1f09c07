"""By which bytes a binary log is told. No library is loaded for it."""

from fullpose_server.formats.importers.mavlink_frames import STAMP, frame_length

ULOG = b"ULog\x01\x12\x35"
DATAFLASH = b"\xa3\x95\x80"
MCAP = b"\x89MCAP0\r\n"
ROSBAG = b"#ROSBAG V2.0"
SQLITE = b"SQLite format 3\0"
MATLAB_5 = b"MATLAB 5.0 MAT-file"
HDF5 = b"\x89HDF\r\n\x1a\n"
TDMS = b"TDSm"
MDF = b"MDF     "
_ZIP = b"PK\x03\x04"
_WORKBOOK = (b"xl/", b"[Content_Types].xml")


def is_hdf5(head: bytes) -> bool:
    """Whether it is HDF5: at its beginning, or after the text of 512 bytes that MATLAB 7.3 puts before it."""
    return head.startswith(HDF5) or head[512 : 512 + len(HDF5)] == HDF5


def is_workbook(head: bytes) -> bool:
    """Whether a ZIP archive is one that Excel writes."""
    return head.startswith(_ZIP) and any(part in head for part in _WORKBOOK)


def is_tlog(head: bytes) -> bool:
    """Whether a file begins with stamped MAVLink frames, one after the other: it has no word of its own."""
    at = frames = 0
    while frames < 8 and at + STAMP + 3 <= len(head):
        length = frame_length(head, at + STAMP)
        if not length:
            return False
        at += STAMP + length
        frames += 1
    return frames >= 2 and (at <= len(head) or frames >= 3)
