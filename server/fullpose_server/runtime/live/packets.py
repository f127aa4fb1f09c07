"""The datagrams of a live source (docs/guide/live.md). Little-endian, degrees and seconds.

One sample a datagram in; one reply a sample back to its sender. The same bytes travel over UDP and over the local
socket that the server pushes WebSocket samples through.
"""

import math
import struct
from dataclasses import dataclass
from enum import IntEnum, IntFlag

SAMPLE_MAGIC = b"FPA1"
REPLY_MAGIC = b"FPR1"
# magic, kind, sequence, source's time [s], four numbers of attitude, three of body rate [deg/s]
_SAMPLE = struct.Struct("<4sIQd4d3d")
# magic, status, sequence, source's time [s], angles [deg], solve error, lag, margin, latency [us], value, limit
_REPLY = struct.Struct("<4sIQd4d4d2d")
SAMPLE_SIZE = _SAMPLE.size
REPLY_SIZE = _REPLY.size


class Kind(IntEnum):
    """What the four numbers are. Body rates follow where they are finite; nan: the source has none."""

    QUATERNION = 0  # w, x, y, z: reference (x forward, y up, z right) to body
    QUATERNION_NED = 1  # w, x, y, z: body from north-east-down turned actively, forward-right-down body
    EULER = 2  # yaw, pitch, roll [deg], fourth unused
    EULER_NED = 3  # heading, pitch, bank [deg], fourth unused


class LiveStatus(IntFlag):
    """What became of a sample."""

    FOLLOWED = 1  # the rig follows the source
    LIMITED = 2  # limits keep it from the attitude
    DROPPED = 4  # out of order, sent twice, or no numbers: not used
    IDLE = 8  # the session is not live: nothing moves
    IMPLAUSIBLE = 16  # its body rate is beyond what is plausible: not used; the reply says both
    UNPROVEN = 32  # not of the source that was loaded: not used


@dataclass(frozen=True)
class LiveSample:
    """One attitude: `quaternion` w, x, y, z in our axes; `rate` body rate [rad/s] or None; `time_s` the source's."""

    sequence: int
    time_s: float
    quaternion: tuple[float, float, float, float]
    rate: tuple[float, float, float] | None


@dataclass(frozen=True)
class LiveReply:
    """What became of the sample `sequence`.

    angles: commanded in the tick that took it [deg]; error_deg: of those angles against the attitude flown then;
    lag_deg: against this very sample (what delay, limits and prediction leave); margin: smallest relative distance to
    a limit; latency_us: from the sample's arrival in the rig process to this reply; value and limit: the body rate for
    which it was refused, and the greatest that is used [deg/s], nan where it was not.
    """

    status: int
    sequence: int
    time_s: float
    angles: tuple[float, ...]
    error_deg: float
    lag_deg: float
    margin: float
    latency_us: float
    value: float = math.nan
    limit: float = math.nan


def encode_sample(
    kind: Kind, sequence: int, time_s: float, numbers: tuple[float, ...], rate_deg_s: tuple[float, ...]
) -> bytes:
    """One datagram; `numbers` as `kind` says (three or four), `rate_deg_s` three body rates or empty."""
    four = (*numbers, 0.0)[:4]
    rate = rate_deg_s or (math.nan,) * 3
    return _SAMPLE.pack(SAMPLE_MAGIC, kind, sequence, time_s, *four, *rate)


def decode_sample(data: bytes) -> LiveSample | None:
    """The sample in a datagram; None where it is none: wrong size, magic or kind, not finite, a zero quaternion."""
    if len(data) != SAMPLE_SIZE or not data.startswith(SAMPLE_MAGIC):
        return None
    _, kind, sequence, time_s, a, b, c, d, p, q, r = _SAMPLE.unpack(data)
    if not all(map(math.isfinite, (time_s, a, b, c))) or kind > max(Kind):
        return None
    if kind in (Kind.EULER, Kind.EULER_NED):
        psi, theta, gamma = math.radians(a), math.radians(b), math.radians(c)
        quaternion = _of_euler(-psi if kind == Kind.EULER_NED else psi, theta, gamma)
    else:
        norm = math.sqrt(a * a + b * b + c * c + d * d)
        # Rounded or slowly drifting quaternions are put right; what is far from unit length is not an attitude.
        if not 0.9 < norm < 1.1:
            return None
        w, x, y, z = a / norm, b / norm, c / norm, d / norm
        quaternion = (w, x, -z, y) if kind == Kind.QUATERNION_NED else (w, x, y, z)
    rate = None
    if math.isfinite(p) and math.isfinite(q) and math.isfinite(r):
        body = (math.radians(p), math.radians(q), math.radians(r))
        ned = kind in (Kind.QUATERNION_NED, Kind.EULER_NED)
        rate = (body[0], -body[2], body[1]) if ned else body
    return LiveSample(sequence, time_s, quaternion, rate)


def _of_euler(psi: float, theta: float, gamma: float) -> tuple[float, float, float, float]:
    """q_y(psi) q_z(theta) q_x(gamma); as `fullpose.attitude.quaternion_from_euler`, for one sample."""
    cy, sy = math.cos(0.5 * psi), math.sin(0.5 * psi)
    cp, sp = math.cos(0.5 * theta), math.sin(0.5 * theta)
    cr, sr = math.cos(0.5 * gamma), math.sin(0.5 * gamma)
    return (
        cy * cp * cr - sy * sp * sr,
        cy * cp * sr + sy * sp * cr,
        sy * cp * cr + cy * sp * sr,
        cy * sp * cr - sy * cp * sr,
    )


def encode_reply(reply: LiveReply) -> bytes:
    """One datagram of `REPLY_SIZE` bytes."""
    return _REPLY.pack(
        REPLY_MAGIC,
        reply.status,
        reply.sequence,
        reply.time_s,
        *reply.angles,
        reply.error_deg,
        reply.lag_deg,
        reply.margin,
        reply.latency_us,
        reply.value,
        reply.limit,
    )


def decode_reply(data: bytes) -> LiveReply | None:
    """The reply in a datagram; None where it is none."""
    if len(data) != REPLY_SIZE or not data.startswith(REPLY_MAGIC):
        return None
    _, status, sequence, time_s, *n = _REPLY.unpack(data)
    return LiveReply(status, sequence, time_s, tuple(n[:4]), n[4], n[5], n[6], n[7], n[8], n[9])
