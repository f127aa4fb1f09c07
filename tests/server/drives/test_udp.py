"""The udp drive against the table emulator, a program of its own, over loopback."""

import contextlib
import math
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from server.drives.base import Drive, DriveError, Status
from server.drives.conformance import DriveConformance
from server.drives.packet import (
    COMMAND_SIZE,
    CommandPacket,
    Order,
    StatePacket,
    decode_command,
    decode_state,
    encode_command,
    encode_state,
)
from server.drives.udp import make
from solver.rig import builtin_rigs

RIG = builtin_rigs()["vertical-4"]
FOUR = (1.0, -2.0, 3.5, 0.25)


@contextlib.contextmanager
def emulator(*arguments: str) -> Iterator[int]:
    """A running table; its port. Ends by itself after a minute, whatever happens to the test."""
    command = [sys.executable, "-m", "server.drives.table_emulator", "--port", "0", "--seconds", "60", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        yield int(process.stdout.readline().rsplit(":", 1)[1])
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


class TestUdp(DriveConformance):
    @pytest.fixture(autouse=True)
    def _table(self) -> Iterator[None]:
        with emulator() as port:
            self.port = port
            yield

    def make_drive(self) -> Drive:
        return make(self.rig, self.rate_hz, {"port": self.port, "link_lost_s": 0.5})

    def tick(self, now: float) -> float:
        time.sleep(max(0.0, now + 1.0 / self.rate_hz - time.monotonic()))
        return time.monotonic()


def test_packets_come_back_as_they_went() -> None:
    command = CommandPacket(Order.FOLLOW, 7, 1 << 40, 12.5, FOUR, FOUR, FOUR)
    assert decode_command(encode_command(command)) == command
    state = StatePacket(int(Status.ENABLED), 9, 1.5, FOUR, FOUR)
    assert decode_state(encode_state(state)) == state


@pytest.mark.parametrize("junk", [b"", b"FPC1", b"x" * COMMAND_SIZE, b"FPC1" + b"\xff" * (COMMAND_SIZE - 4)])
def test_what_is_no_command_is_not_believed(junk: bytes) -> None:
    assert decode_command(junk) is None
    assert decode_state(junk) is None


def test_numbers_that_are_none_are_not_believed() -> None:
    bad = CommandPacket(Order.FOLLOW, 1, 1, 0.0, (math.nan, 0.0, 0.0, 0.0), FOUR, FOUR)
    assert decode_command(encode_command(bad)) is None


def test_no_table_is_one_clear_error() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    drive = make(RIG, 1000.0, {"port": port, "connect_s": 0.1})
    with pytest.raises(DriveError, match="no table answers"):
        drive.connect(0.0)


def test_a_silent_table_is_a_lost_link() -> None:
    with emulator("--seconds", "1.5") as port:
        drive = make(RIG, 1000.0, {"port": port})
        drive.connect(time.monotonic())
        position, rate = np.zeros(4), np.zeros(4)
        assert not drive.read(time.monotonic(), position, rate) & Status.LINK_LOST
        deadline = time.monotonic() + 5.0
        while not drive.read(time.monotonic(), position, rate) & Status.LINK_LOST:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        drive.close()


def test_the_table_brakes_by_itself_when_the_controller_dies(tmp_path: Path) -> None:
    log = tmp_path / "table.log"
    with emulator("--log", str(log)) as port:
        drive = make(RIG, 1000.0, {"port": port})
        now = time.monotonic()
        drive.connect(now)
        drive.enable()
        position, rate = np.zeros(4), np.zeros(4)
        drive.read(now, position, rate)
        start = position.copy()
        speed = np.array([0.0, 0.0, 0.0, math.radians(30.0)])
        begun = time.monotonic()
        k = 0
        while (t := time.monotonic() - begun) < 0.5:
            k += 1
            drive.write(start + speed * max(0.0, t - 0.05), speed, 0 * speed, 1, k)
            time.sleep(0.001)
        time.sleep(0.6)  # nothing is sent: the controller is dead
        with log.open() as file:
            rows = [line.split() for line in file if line.endswith("\n")]
        drive.close()
    measured = np.array([[float(n) for n in row] for row in rows])
    moving = np.abs(measured[:, 9]) > 25.0
    assert moving.sum() > 100
    assert int(measured[-1, 1]) & Status.WATCHDOG
    assert abs(measured[-1, 9]) < 0.1
    # Braked inside the motor's limit from the last moment it moved.
    slowing = np.diff(measured[:, 9]) * 1000.0
    assert np.abs(slowing[np.flatnonzero(moving)[-1] :]).max() <= math.degrees(RIG.max_acceleration[3]) * 1.5 * 1.1
