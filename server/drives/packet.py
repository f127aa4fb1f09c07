"""The datagrams of the `udp` drive (docs/guide/drivers.md). Little-endian, degrees and seconds, base first.

Both kinds are of one size each and carry their own magic, so that a stray datagram is dropped and not believed.
"""

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

COMMAND_MAGIC = b"FPC1"
STATE_MAGIC = b"FPS1"
# magic, order, epoch, sequence, sender's time [s], position, rate, acceleration [deg]
_COMMAND = struct.Struct("<4sIQQd12d")
# magic, status bits, sequence of the newest command taken, sender's time [s], position, rate [deg]
_STATE = struct.Struct("<4sIQd8d")
COMMAND_SIZE = _COMMAND.size
STATE_SIZE = _STATE.size


class Order(IntEnum):
    """What a command datagram asks."""

    HELLO = 0  # only report back
    ENABLE = 1  # release the brakes, follow
    FOLLOW = 2  # the demand for the next tick
    BRAKE = 3  # brake by your own means, stay enabled for nothing
    DISABLE = 4  # power off, brakes hold


@dataclass(frozen=True)
class CommandPacket:
    """Controller to table. Tuples of four, base first [deg, deg/s, deg/s^2]."""

    order: Order
    epoch: int
    sequence: int
    time_s: float
    position: tuple[float, ...]
    rate: tuple[float, ...]
    acceleration: tuple[float, ...]


@dataclass(frozen=True)
class StatePacket:
    """Table to controller: `server.drives.base.Status` bits, and what was measured [deg, deg/s]."""

    status: int
    sequence: int
    time_s: float
    position: tuple[float, ...]
    rate: tuple[float, ...]


def encode_command(packet: CommandPacket) -> bytes:
    """One datagram of `COMMAND_SIZE` bytes."""
    numbers = (*packet.position, *packet.rate, *packet.acceleration)
    return _COMMAND.pack(COMMAND_MAGIC, packet.order, packet.epoch, packet.sequence, packet.time_s, *numbers)


def decode_command(data: bytes) -> CommandPacket | None:
    """The command in a datagram; None where it is none, or holds what is not a number."""
    if len(data) != COMMAND_SIZE or not data.startswith(COMMAND_MAGIC):
        return None
    _, order, epoch, sequence, time_s, *numbers = _COMMAND.unpack(data)
    if order not in Order.__members__.values() or not all(math.isfinite(n) for n in (time_s, *numbers)):
        return None
    return CommandPacket(
        Order(order), epoch, sequence, time_s, tuple(numbers[:4]), tuple(numbers[4:8]), tuple(numbers[8:])
    )


def encode_state(packet: StatePacket) -> bytes:
    """One datagram of `STATE_SIZE` bytes."""
    return _STATE.pack(STATE_MAGIC, packet.status, packet.sequence, packet.time_s, *packet.position, *packet.rate)


def decode_state(data: bytes) -> StatePacket | None:
    """The state in a datagram; None where it is none. A position may be nan: its encoder is lost."""
    if len(data) != STATE_SIZE or not data.startswith(STATE_MAGIC):
        return None
    _, status, sequence, time_s, *numbers = _STATE.unpack(data)
    return StatePacket(status, sequence, time_s, tuple(numbers[:4]), tuple(numbers[4:]))
