"""The datagrams of the `udp` drive (docs/guide/drivers.md). Little-endian, degrees and seconds, base first.

Both kinds are of one size each and carry their own magic, so that a stray datagram is dropped and not believed.
"""

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

COMMAND_MAGIC = b"FPC2"
STATE_MAGIC = b"FPS2"
# magic, order, its number, epoch, sequence, sender's time [s], position, rate, acceleration [deg]
_COMMAND = struct.Struct("<4sIQQQd12d")
# magic, status bits, number of the newest order taken, sequence of the newest demand taken, sender's time [s],
# position, rate [deg]
_STATE = struct.Struct("<4sIQQd8d")
_MOST = 1 << 63  # numbers count on from what the table says: from here they could not
COMMAND_SIZE = _COMMAND.size
STATE_SIZE = _STATE.size


class Order(IntEnum):
    """What a command datagram asks. Enable, brake and disable are numbered; the table does each number once."""

    HELLO = 0  # only report back
    ENABLE = 1  # release the brakes, follow
    FOLLOW = 2  # the demand for the next tick
    BRAKE = 3  # brake by your own means, stay enabled for nothing
    DISABLE = 4  # power off, brakes hold


@dataclass(frozen=True)
class CommandPacket:
    """Controller to table. Tuples of four, base first [deg, deg/s, deg/s^2].

    `number` is the order's; of a demand, that of the last order before it.
    """

    order: Order
    number: int
    epoch: int
    sequence: int
    time_s: float
    position: tuple[float, ...]
    rate: tuple[float, ...]
    acceleration: tuple[float, ...]


@dataclass(frozen=True)
class StatePacket:
    """Table to controller: `drives.base.Status` bits, the newest order taken, what was measured [deg, deg/s]."""

    status: int
    number: int
    sequence: int
    time_s: float
    position: tuple[float, ...]
    rate: tuple[float, ...]


def encode_command(packet: CommandPacket) -> bytes:
    """One datagram of `COMMAND_SIZE` bytes."""
    numbers = (*packet.position, *packet.rate, *packet.acceleration)
    head = (packet.order, packet.number, packet.epoch, packet.sequence, packet.time_s)
    return _COMMAND.pack(COMMAND_MAGIC, *head, *numbers)


def decode_command(data: bytes) -> CommandPacket | None:
    """The command in a datagram; None where it is none, or holds what is not a number."""
    if len(data) != COMMAND_SIZE or not data.startswith(COMMAND_MAGIC):
        return None
    _, order, number, epoch, sequence, time_s, *numbers = _COMMAND.unpack(data)
    if order not in Order.__members__.values() or not all(math.isfinite(n) for n in (time_s, *numbers)):
        return None
    x, v, a = tuple(numbers[:4]), tuple(numbers[4:8]), tuple(numbers[8:])
    return CommandPacket(Order(order), number, epoch, sequence, time_s, x, v, a)


def encode_state(packet: StatePacket) -> bytes:
    """One datagram of `STATE_SIZE` bytes."""
    head = (packet.status, packet.number, packet.sequence, packet.time_s)
    return _STATE.pack(STATE_MAGIC, *head, *packet.position, *packet.rate)


def decode_state(data: bytes) -> StatePacket | None:
    """The state in a datagram; None where it is none. A position may be nan: its encoder is lost."""
    if len(data) != STATE_SIZE or not data.startswith(STATE_MAGIC):
        return None
    _, status, number, sequence, time_s, *numbers = _STATE.unpack(data)
    if number >= _MOST:
        return None
    return StatePacket(status, number, sequence, time_s, tuple(numbers[:4]), tuple(numbers[4:]))
