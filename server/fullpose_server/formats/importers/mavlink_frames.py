"""MAVLink's framing."""

from mmap import mmap

STAMP = 8  # bytes before a frame: microseconds since 1970, big-endian
_V1, _V2, _SIGNED = 0xFE, 0xFD, 0x01


def frame_length(data: bytes | mmap, at: int) -> int:
    """How long the frame at `at` says it is, header and checksum included; 0 where none begins there."""
    start = data[at : at + 3]
    if len(start) < 3:
        return 0
    if start[0] == _V1:
        return 8 + start[1]
    if start[0] == _V2:
        return 12 + start[1] + (13 if start[2] & _SIGNED else 0)
    return 0
