"""The udp drive over loopback: a drive's promises, its datagrams, and a table that goes."""

import math
import socket
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.drives.base import Drive, DriveError, Status
from fullpose_server.drives.packet import (
    COMMAND_SIZE,
    CommandPacket,
    Order,
    StatePacket,
    decode_command,
    decode_state,
    encode_command,
    encode_state,
)
from fullpose_server.drives.testing.conformance import DriveConformance
from fullpose_server.drives.udp import make
from tests.fullpose_server.drives.tables import SteppedTable, emulator, heard

RIG = builtin_rigs()["vertical-4"]
FOUR = (1.0, -2.0, 3.5, 0.25)


class TestUdp(DriveConformance):
    @pytest.fixture(autouse=True)
    def _table(self) -> Iterator[None]:
        self.table = SteppedTable(self.rig, self.rate_hz, 0.3)
        yield
        self.table.close()

    def make_drive(self) -> Drive:
        self.drive = make(self.rig, self.rate_hz, {"port": self.table.port, "link_lost_s": 0.5, "connect_s": 60.0})
        return self.drive

    def tick(self, now: float) -> float:
        now += self.table.period
        self.table.tick(now)
        heard(self.drive)
        return now


def test_packets_come_back_as_they_went() -> None:
    command = CommandPacket(Order.FOLLOW, 3, 7, 1 << 40, 12.5, FOUR, FOUR, FOUR)
    assert decode_command(encode_command(command)) == command
    state = StatePacket(int(Status.ENABLED), 3, 9, 1.5, FOUR, FOUR)
    assert decode_state(encode_state(state)) == state


@pytest.mark.parametrize("junk", [b"", b"FPC2", b"x" * COMMAND_SIZE, b"FPC2" + b"\xff" * (COMMAND_SIZE - 4)])
def test_what_is_no_command_is_not_believed(junk: bytes) -> None:
    assert decode_command(junk) is None
    assert decode_state(junk) is None


def test_numbers_that_are_none_are_not_believed() -> None:
    bad = CommandPacket(Order.FOLLOW, 1, 1, 1, 0.0, (math.nan, 0.0, 0.0, 0.0), FOUR, FOUR)
    assert decode_command(encode_command(bad)) is None
    assert decode_state(encode_state(StatePacket(0, (1 << 64) - 1, 0, 1.5, FOUR, FOUR))) is None


def test_no_table_is_one_clear_error() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    drive = make(RIG, 1000.0, {"port": port, "connect_s": 0.1})
    with pytest.raises(DriveError, match="no table answers"):
        drive.connect(0.0)


def test_a_table_of_its_own_is_enabled_and_its_end_is_a_lost_link() -> None:
    with emulator("--watchdog", "60") as (port, process):
        drive = make(RIG, 1000.0, {"port": port, "link_lost_s": 60.0, "connect_s": 60.0})
        now = time.monotonic()
        drive.connect(now)
        drive.enable()
        position, rate = np.zeros(4), np.zeros(4)
        status = 0
        while not status & Status.ENABLED:
            heard(drive)
            status = drive.read(now, position, rate)
        assert np.isfinite(position).all()
        process.kill()
        process.wait()
        while not drive.read(now, position, rate) & Status.LINK_LOST:
            now += 61.0  # what was on its way is read, then nothing comes any more
        drive.close()


def test_the_table_brakes_by_itself_when_the_controller_dies() -> None:
    table = SteppedTable(RIG, 1000.0, 0.05)
    drive = make(RIG, 1000.0, {"port": table.port, "connect_s": 60.0})
    now = time.monotonic()
    drive.connect(now)
    drive.enable()
    position, rate = np.zeros(4), np.zeros(4)
    drive.read(now, position, rate)
    start = position.copy()
    speed = np.array([0.0, 0.0, 0.0, math.radians(30.0)])
    rows = []
    for k in range(1, 1101):
        table.tick(now + k * table.period)
        rows.append((table.state.status, table.state.rate[3]))
        if k < 500:  # then nothing is sent: the controller is dead
            drive.write(start + speed * max(0.0, k * table.period - 0.05), speed, 0 * speed, 1, k)
    drive.close()
    table.close()
    moved = np.array([rate_deg_s for _, rate_deg_s in rows])
    moving = np.flatnonzero(np.abs(moved) > 25.0)
    assert len(moving) > 400
    assert rows[-1][0] & Status.WATCHDOG
    assert abs(moved[-1]) < 0.1
    # Braked inside the motor's limit from the last moment it moved.
    slowing = np.diff(moved)[moving[-1] :] * 1000.0
    assert np.abs(slowing).max() <= math.degrees(RIG.max_acceleration[3]) * 1.5 * 1.1


def test_a_refusal_is_read_though_newer_datagrams_came_with_it() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as table:
        table.bind(("127.0.0.1", 0))
        drive = make(RIG, 1000.0, {"port": table.getsockname()[1], "link_lost_s": 60.0})
        answer = threading.Thread(target=lambda: table.sendto(encode_state(state_of(0, 0.0)), table.recvfrom(200)[1]))
        answer.start()
        drive.connect(time.monotonic())
        answer.join()
        drive.disable()
        peer = table.recvfrom(200)[1]
        table.sendto(encode_state(state_of(int(Status.STALE_WRITE), 1.0)), peer)
        table.sendto(encode_state(state_of(0, 2.0)), peer)
        position, rate = np.zeros(4), np.zeros(4)
        assert drive.read(time.monotonic(), position, rate) & Status.STALE_WRITE
        assert not drive.read(time.monotonic(), position, rate) & Status.STALE_WRITE
        drive.close()


def state_of(status: int, time_s: float) -> StatePacket:
    return StatePacket(status, 0, 0, time_s, FOUR, FOUR)
