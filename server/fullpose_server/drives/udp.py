"""The `udp` drive: demands to a table over UDP, one datagram a tick each way (see `packet`).

The table's own watchdog brakes where our datagrams stop; ours reports the link as lost where the table's do.
Enable, brake and disable are numbered, and repeated once a tick until the table names the number it took.
"""

import math
import socket
import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.drives.base import Drive, DriveError, Status
from fullpose_server.drives.options import options_of
from fullpose_server.drives.packet import (
    STATE_SIZE,
    CommandPacket,
    Order,
    StatePacket,
    decode_state,
    encode_command,
)

_DEG = 180.0 / math.pi
_PER_READ = 32  # datagrams taken in one read: a burst is drained, a flood does not stall the loop
_ENABLE_WITHIN = math.radians(0.1)  # of the demand: a table that is enabled later than that would jump


@dataclass(frozen=True)
class UdpOptions:
    """Where the table listens. Loopback is where the emulator is; name the table's address for a real one."""

    host: str = "127.0.0.1"
    port: int = 7450
    local_port: int = 0
    connect_s: float = 1.0  # to wait for the first answer
    link_lost_s: float = 0.02  # without an answer the link counts as lost; longer looks like a following error first


class UdpDrive:
    """See `Drive`."""

    name = "udp"

    def __init__(self, rig: Rig, rate_hz: float, options: UdpOptions) -> None:
        if not 0 < options.port < 65536:
            raise DriveError(f"udp drive: port {options.port}: expected 1 to 65535")
        self._rig = rig
        self._dt = 1.0 / rate_hz
        self._options = options
        self._socket: socket.socket | None = None
        self._newest: StatePacket | None = None
        self._heard = -math.inf
        self._epoch = self._sequence = -1  # of the last demand, in this series
        self._ordered = Order.HELLO  # the last order, and its number
        self._number = 0
        self._confirmed = True
        self._repeat = False
        self._zero = (0.0,) * 4
        self._stale = False
        self._emergency = False  # an emergency brake was sent; the next read makes a numbered order of it

    def connect(self, now: float) -> None:  # noqa: ARG002  # waits on the real clock
        """Ask the table for a word, until it answers or `connect_s` is over."""
        self.close()
        o = self._options
        try:
            made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
            made.bind(("", o.local_port))
            made.connect((o.host, o.port))
            made.settimeout(0.02)
        except OSError as cause:
            raise DriveError(f"udp drive: {o.host}:{o.port}: {cause}") from cause
        self._socket = made
        self._newest = None
        self._ordered, self._confirmed, self._repeat = Order.HELLO, True, False
        deadline = time.monotonic() + o.connect_s
        while time.monotonic() < deadline:
            self._send_order(Order.HELLO)
            try:
                self._newest = decode_state(made.recv(STATE_SIZE + 1)) or self._newest
            except OSError:
                continue  # nobody there yet (ICMP refusal), or nothing within the socket's time
            if self._newest is not None:
                made.setblocking(False)
                self._heard = time.monotonic()
                return
        self.close()
        raise DriveError(f"udp drive: no table answers at {o.host}:{o.port} within {o.connect_s:g} s")

    def enable(self) -> None:
        """Ask for the brakes to be released; whether they are, the next reads tell."""
        if self._socket is None:
            raise DriveError("udp drive: not connected")
        self._epoch = self._sequence = -1
        self._emergency = False
        self._order(Order.ENABLE)

    def read(self, now: float, position: Array, rate: Array) -> int:
        """The newest state datagram; the link is lost where none came for `link_lost_s`."""
        if self._socket is None:
            return int(Status.LINK_LOST)
        if self._emergency:
            self._emergency = False
            self.brake()
        for _ in range(_PER_READ):
            try:
                packet = decode_state(self._socket.recv(STATE_SIZE + 1))
            except OSError:
                break
            # Out of order is normal for UDP: only what is newer counts.
            if packet is not None and (self._newest is None or packet.time_s >= self._newest.time_s):
                self._newest = packet
                self._heard = now
                self._stale = self._stale or bool(packet.status & Status.STALE_WRITE)  # said once: not to be skipped
        newest = self._newest
        if newest is None or now - self._heard > self._options.link_lost_s:
            return int(Status.LINK_LOST)
        if newest.number == self._number:
            self._confirmed = True  # for good: a table that restarts forgets its number, and must not be enabled again
        elif not self._confirmed and self._repeat:
            self._send_order(self._ordered)
        position[:] = newest.position
        rate[:] = newest.rate
        np.divide(position, _DEG, out=position)
        np.divide(rate, _DEG, out=rate)
        status = newest.status & ~Status.STALE_WRITE  # until the next datagram it would be said again
        if self._stale:
            self._stale = False
            status |= Status.STALE_WRITE
        if not self._confirmed:
            status |= Status.UNCONFIRMED
            if self._ordered is Order.ENABLE:
                status &= ~(Status.ENABLED | Status.WATCHDOG)  # of the time before
        return int(status)

    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        """Send one demand. A full send buffer drops it: the next tick's is newer anyway."""
        if epoch < self._epoch or sequence <= self._sequence:
            self._stale = True
            return
        self._epoch, self._sequence = epoch, sequence
        x, v, a = (tuple((values * _DEG).tolist()) for values in (position, rate, acceleration))
        if not self._confirmed and self._ordered is Order.ENABLE and self._departed(position):
            self._repeat = False
        self._send(CommandPacket(Order.FOLLOW, self._number, epoch, sequence, time.monotonic(), x, v, a))

    def brake(self) -> None:
        """Have the table brake."""
        self._order(Order.BRAKE)

    def emergency_brake(self) -> None:
        """One datagram, past whatever the loop's thread does; the next `read`, if there is one, repeats it."""
        self._emergency = True
        taken = 0 if self._newest is None else self._newest.number
        zero = self._zero
        number = max(self._number, taken) + 1
        self._send(CommandPacket(Order.BRAKE, number, 0, 0, time.monotonic(), zero, zero, zero))

    def disable(self) -> None:
        """Have the table power off."""
        self._order(Order.DISABLE)

    def close(self) -> None:
        """Close the socket. The table is told once more to brake, or to power off where that was the last order.

        Nobody is left to hear whether it did: its watchdog acts where it did not.
        """
        if self._socket is not None:
            self._order(Order.DISABLE if self._ordered is Order.DISABLE else Order.BRAKE)
            self._socket.close()
            self._socket = None

    def _order(self, order: Order) -> None:
        """Begin a new order. Its number is above any that the table has taken, from whomever."""
        taken = 0 if self._newest is None else self._newest.number
        self._number = max(self._number, taken) + 1
        self._ordered, self._confirmed, self._repeat = order, False, True
        self._send_order(order)

    def _departed(self, demand: Array) -> bool:
        """Whether the demand has left the table that is still to be enabled."""
        newest = self._newest
        return newest is not None and bool(np.abs(demand - np.radians(newest.position)).max() > _ENABLE_WITHIN)

    def _send_order(self, order: Order) -> None:
        zero = self._zero
        self._send(CommandPacket(order, self._number, 0, 0, time.monotonic(), zero, zero, zero))

    def _send(self, packet: CommandPacket) -> None:
        link = self._socket  # an emergency brake comes from another thread than a `close`
        if link is None:
            return
        try:
            link.send(encode_command(packet))
        except OSError:
            return  # refused or full: the missing answers tell, and the table's watchdog acts


def make(rig: Rig, rate_hz: float, options: dict[str, Any]) -> Drive:
    """The udp drive (see `DriveFactory`); `options` are `UdpOptions`."""
    return UdpDrive(rig, rate_hz, options_of("udp", UdpOptions, options))
