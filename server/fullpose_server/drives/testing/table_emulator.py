"""A table at the other end of the `udp` drive.

`python -m fullpose_server.drives.testing.table_emulator --rig vertical-4`

A program of its own, with its own clock: the simulated servos behind the documented datagrams. It answers every
command, reports by itself once a period, and brakes by itself where commands stop for longer than the watchdog.
The first line it prints is the address it listens on; with --log it writes what it measures, one line a period.
"""

import argparse
import socket
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np

from fullpose.rig import Rig, builtin_rigs
from fullpose_server.drives.base import Status
from fullpose_server.drives.packet import (
    COMMAND_SIZE,
    CommandPacket,
    Order,
    StatePacket,
    decode_command,
    encode_state,
)
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions

_DEG = 180.0 / np.pi


@dataclass
class Table:
    """The table: the servos, and the one controller it listens to (whoever spoke last and was understood)."""

    rig: Rig
    rate_hz: float
    watchdog_s: float

    def __post_init__(self) -> None:
        self._servos = SimulatedDrive(self.rig, self.rate_hz, SimulatedOptions(watchdog_s=self.watchdog_s))
        self._position, self._rate = np.zeros(4), np.zeros(4)
        self._order = 0  # number of the newest order taken
        self._taken = 0  # sequence of the newest demand taken since
        self._stale = False

    def begin(self, now: float) -> None:
        """Power on, brakes holding."""
        self._servos.connect(now)

    def take(self, packet: CommandPacket) -> None:
        """Do what a command datagram asks: an order once, a demand where it belongs to the newest order."""
        if packet.order is Order.FOLLOW:
            self._follow(packet)
            return
        # Older orders come late or twice: an enable that was overtaken by a disable must not undo it.
        if packet.order is Order.HELLO or packet.number <= self._order:
            return
        self._order = packet.number
        match packet.order:
            case Order.ENABLE:
                self._servos.enable()
                self._taken = 0
            case Order.BRAKE:
                self._servos.brake()
            case Order.DISABLE:
                self._servos.disable()

    def _follow(self, packet: CommandPacket) -> None:
        if packet.number < self._order:
            self._stale = True
        if packet.number != self._order:
            return  # of an earlier series; or its order has not come yet, and a demand never enables
        x, v, a = (np.array(n) / _DEG for n in (packet.position, packet.rate, packet.acceleration))
        self._servos.write(x, v, a, packet.epoch, packet.sequence)
        self._taken = max(self._taken, packet.sequence)

    def advance(self, now: float) -> StatePacket:
        """One period passes: what the encoders say."""
        status = self._servos.read(now, self._position, self._rate) & ~Status.LINK_LOST
        if self._stale:
            status |= Status.STALE_WRITE
            self._stale = False
        x, v = (self._position * _DEG).tolist(), (self._rate * _DEG).tolist()
        return StatePacket(int(status), self._order, self._taken, now, tuple(x), tuple(v))


def serve(table: Table, listener: socket.socket, log: TextIO | None, until: float) -> None:
    """Run `table` behind `listener` until `until` [s, monotonic]."""
    period = 1.0 / table.rate_hz
    peer: tuple[str, int] | None = None
    now = time.monotonic()
    table.begin(now)
    due = now + period
    while due < until:
        time.sleep(max(0.0, due - time.monotonic()))
        # Everything that has come, so that the newest demand is the one that is followed.
        while True:
            try:
                data, sender = listener.recvfrom(COMMAND_SIZE + 1)
            except BlockingIOError:
                break
            except OSError:
                continue  # the controller's port is closed: it will be back, or the watchdog brakes
            packet = decode_command(data)
            if packet is not None:
                peer = sender
                table.take(packet)
        state = table.advance(time.monotonic())
        if peer is not None:
            try:
                listener.sendto(encode_state(state), peer)
            except OSError:
                peer = None
        if log is not None:
            log.write(" ".join(repr(n) for n in (state.time_s, state.status, *state.position, *state.rate)) + "\n")
            log.flush()
        due = max(due + period, time.monotonic())


def main() -> int:
    """Run the emulator; returns the exit status."""
    arguments = argparse.ArgumentParser(description="Emulates a table behind the udp drive's datagrams.")
    arguments.add_argument("--rig", default="vertical-4", choices=sorted(builtin_rigs()))
    arguments.add_argument("--host", default="127.0.0.1")
    arguments.add_argument("--port", type=int, default=7450, help="0: any free one")
    arguments.add_argument("--rate", type=float, default=1000.0, help="periods a second")
    arguments.add_argument("--watchdog", type=float, default=0.05, help="seconds without commands before it brakes")
    arguments.add_argument("--seconds", type=float, default=float("inf"), help="end after this time")
    arguments.add_argument("--log", type=Path, help="time, status, position, rate [deg] of every period")
    given = arguments.parse_args()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind((given.host, given.port))
        listener.setblocking(False)
        table = Table(builtin_rigs()[given.rig], given.rate, given.watchdog)
        sys.stdout.write("{}:{}\n".format(*listener.getsockname()))
        sys.stdout.flush()
        log = given.log.open("w", encoding="utf-8") if given.log else None
        try:
            serve(table, listener, log, time.monotonic() + given.seconds)
        except KeyboardInterrupt:
            return 130
        finally:
            if log is not None:
                log.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
