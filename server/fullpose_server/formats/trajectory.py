"""A flight as the store knows it: time and attitude, checked, the attitude as a continuous unit quaternion."""

import hashlib
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion, euler_from_dcm
from fullpose_server.formats.caution import Caution

QUATERNION = ("qw", "qx", "qy", "qz")  # our own columns of an attitude
_BLOCK = 65536  # samples converted at once


class Convention(StrEnum):
    """The axes an attitude was written in (mathematics, section 1)."""

    NUE = "nue"  # ours: reference x north, y up, z east; body x nose, y up, z right wing
    NED = "ned"  # reference north, east, down; body forward, right, down
    ENU = "enu"  # reference east, north, up; body forward, left, up, as in ROS


@dataclass(frozen=True)
class Taken:
    """What was taken of a file: nothing of it is assumed in silence."""

    format: str  # the importer's name
    profile: str  # a named profile's, or a file's; "" where a person gave the columns
    table: str = ""  # of a file that has several
    statement: str = ""  # columns, units, order, sense, axes and clock, in words


@dataclass(frozen=True)
class Trajectory:
    """A flight. Arrays are read-only."""

    time: Array  # (n,) [s], strictly increasing
    q: Array  # (n, 4) unit, w first, no sign jumps
    convention: Convention  # of the source; `q` is always ours
    warnings: tuple[Caution, ...] = ()
    taken: Taken = field(default=Taken("", ""))

    def __post_init__(self) -> None:
        self.time.setflags(write=False)
        self.q.setflags(write=False)

    @cached_property
    def sha256(self) -> str:
        """Address of the flight: of its samples, so that one flight has one address whatever file it came in."""
        digest = hashlib.sha256(b"fullpose.trajectory/1\n")
        # Not as bytes: a copy is made under the interpreter's lock, and 100 MB of it would hold an E-stop up.
        digest.update(np.ascontiguousarray(self.time, "<f8").data)
        digest.update(np.ascontiguousarray(self.q, "<f8").reshape(-1).data)
        return digest.hexdigest()


def euler_deg(q: Array) -> Array:
    """Yaw, pitch, roll (n, 3) [deg] of q (n, 4), unwrapped. Of every sample: between sparse ones turns are lost."""
    angles = np.empty((len(q), 3))
    for begin in range(0, len(q), _BLOCK):  # 100 bytes a sample beside the result, otherwise
        part = slice(begin, begin + _BLOCK)
        angles[part] = np.stack(euler_from_dcm(dcm_from_quaternion(q[part])), axis=-1)
    return np.asarray(np.rad2deg(np.unwrap(angles, axis=0)))


def continuous(q: Array) -> Array:
    """The same attitudes with each quaternion's sign that of its predecessor's hemisphere, in place. (n, 4)"""
    flips = np.einsum("ij,ij->i", q[1:], q[:-1]) < 0.0
    odd = np.concatenate([[False], np.logical_xor.accumulate(flips)])
    q[odd] *= -1.0
    return q
