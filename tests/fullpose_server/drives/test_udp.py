"""The udp drive against the table emulator, a program of its own, over loopback."""

import contextlib
import math
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

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
from tests.fullpose_server.drives.relay import Relay, relay

RIG = builtin_rigs()["vertical-4"]
FOUR = (1.0, -2.0, 3.5, 0.25)


@contextlib.contextmanager
def emulator(*arguments: str) -> Iterator[int]:
    """A running table; its port. Ends by itself after a minute, whatever happens to the test."""
    command = [
        sys.executable,
        "-m",
        "fullpose_server.drives.testing.table_emulator",
        "--port",
        "0",
        "--seconds",
        "60",
        *arguments,
    ]
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
        with emulator("--watchdog", "0.3") as port:  # a starved machine writes late
            self.port = port
            yield

    def make_drive(self) -> Drive:
        return make(self.rig, self.rate_hz, {"port": self.port, "link_lost_s": 0.5})

    def tick(self, now: float) -> float:
        time.sleep(max(0.0, now + 1.0 / self.rate_hz - time.monotonic()))
        return time.monotonic()


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
    # Braked inside the motor's limit from the last moment it moved. A starved table has more than a tick between rows.
    ticks = np.maximum(1.0, np.round(np.diff(measured[:, 0]) * 1000.0))
    slowing = np.diff(measured[:, 9]) / ticks * 1000.0
    assert np.abs(slowing[np.flatnonzero(moving)[-1] :]).max() <= math.degrees(RIG.max_acceleration[3]) * 1.5 * 1.1


# --- a network that loses, and that brings old datagrams ---


class Controller:
    """A drive behind a relay, held where it stands tick by tick."""

    def __init__(self, network: Relay) -> None:
        self.network = network
        self.drive = make(RIG, 1000.0, {"port": network.port, "link_lost_s": 5.0, "connect_s": 10.0})
        self.drive.connect(time.monotonic())
        self.position, self.rate = np.zeros(4), np.zeros(4)
        self.drive.read(time.monotonic(), self.position, self.rate)
        self.start = self.position.copy()
        self.sequence = 0

    def tick(self, demand: np.ndarray | None = None) -> Status:
        time.sleep(0.001)
        status = self.drive.read(time.monotonic(), self.position, self.rate)
        self.sequence += 1
        zero = np.zeros(4)
        self.drive.write(self.start if demand is None else demand, zero, zero, 1, self.sequence)
        return Status(status)

    def until(self, wanted: Callable[[Status], bool]) -> list[Status]:
        """What was read until `wanted` came."""
        seen: list[Status] = []
        deadline = time.monotonic() + 20.0
        while not seen or not wanted(seen[-1]):
            assert time.monotonic() < deadline, seen[-20:]
            seen.append(self.tick())
        return seen

    def ordered(self, order: Callable[[], None]) -> Status:
        """Give an order, and wait until the table has taken it."""
        order()
        if order == self.drive.enable:
            self.sequence = 0
        return self.until(lambda status: not status & Status.UNCONFIRMED)[-1]


@pytest.fixture
def controller() -> Iterator[Controller]:
    with emulator("--watchdog", "5.0") as port, relay(port) as network:
        made = Controller(network)
        yield made
        made.drive.close()


def losing(order: Order, times: int) -> Callable[[CommandPacket], bool]:
    """Loses the first `times` datagrams with this order."""
    left = [times]

    def loses(command: CommandPacket) -> bool:
        left[0] -= command.order is order
        return command.order is order and left[0] >= 0

    return loses


def test_a_lost_enable_is_repeated_and_nothing_is_claimed_meanwhile(controller: Controller) -> None:
    controller.network.loses = losing(Order.ENABLE, 5)
    controller.drive.enable()
    seen = controller.until(lambda status: bool(status & Status.ENABLED))
    assert len(controller.network.lost) == 5
    assert len(seen) > 5
    assert all(status & Status.UNCONFIRMED for status in seen[:-1])
    assert not seen[-1] & (Status.UNCONFIRMED | Status.STALE_WRITE)


@pytest.mark.parametrize("order", [Order.BRAKE, Order.DISABLE])
def test_a_lost_brake_or_disable_is_repeated(controller: Controller, order: Order) -> None:
    assert controller.ordered(controller.drive.enable) & Status.ENABLED
    controller.network.loses = losing(order, 5)
    status = controller.ordered(controller.drive.brake if order is Order.BRAKE else controller.drive.disable)
    assert len(controller.network.lost) == 5
    assert status & (Status.ENABLED | Status.BRAKING) == (Status.BRAKING if order is Order.BRAKE else 0)


def test_a_disable_that_never_arrives_stays_unconfirmed(controller: Controller) -> None:
    controller.ordered(controller.drive.enable)
    controller.network.loses = lambda command: command.order is Order.DISABLE
    controller.drive.disable()
    while len(controller.network.lost) < 50:
        assert controller.tick() & Status.UNCONFIRMED


def test_an_old_enable_after_a_disable_enables_nothing(controller: Controller) -> None:
    controller.ordered(controller.drive.enable)
    enable = next(data for data in controller.network.passed if data[4] == Order.ENABLE)
    controller.ordered(controller.drive.disable)
    for _ in range(10):
        controller.network.send(enable)
        assert not controller.tick() & Status.ENABLED
    # An order that is confirmed comes after them all: none of them was taken.
    controller.drive.disable()
    seen = controller.until(lambda status: not status & Status.UNCONFIRMED)
    assert not any(status & Status.ENABLED for status in seen)


def test_old_demands_of_an_earlier_series_move_nothing(controller: Controller) -> None:
    controller.ordered(controller.drive.enable)
    controller.until(lambda _: controller.sequence > 100)
    far = controller.start + math.radians(3.0)
    middle = math.degrees(controller.start[3]) + 1.5
    controller.network.loses = lambda command: command.order is Order.FOLLOW and command.position[3] > middle
    deadline = time.monotonic() + 20.0
    while len(controller.network.lost) < 5:
        assert time.monotonic() < deadline
        controller.tick(far)
    late = list(controller.network.lost)
    controller.ordered(controller.drive.brake)
    assert controller.ordered(controller.drive.enable) & Status.ENABLED
    for data in late:
        controller.network.send(data)
    controller.until(lambda status: bool(status & Status.STALE_WRITE))
    for _ in range(50):
        controller.tick()
        assert np.abs(controller.position - controller.start).max() < math.radians(0.05)


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


def test_a_table_is_not_enabled_any_more_once_the_demand_has_left_it(controller: Controller) -> None:
    left = [math.inf]
    controller.network.loses = lambda command: command.order is Order.ENABLE and command.time_s < left[0]
    controller.drive.enable()
    controller.tick()
    controller.tick(controller.start + math.radians(0.2))
    left[0] = time.monotonic()
    for _ in range(100):
        status = controller.tick(controller.start + math.radians(0.2))
        assert status & Status.UNCONFIRMED
        assert not status & Status.ENABLED


def test_numbers_go_on_where_another_controller_left_off(controller: Controller) -> None:
    for _ in range(3):
        controller.ordered(controller.drive.disable)
    controller.drive.close()
    again = Controller(controller.network)
    assert again.ordered(again.drive.enable) & Status.ENABLED
    again.drive.close()


def test_a_table_that_restarts_is_not_enabled_by_itself() -> None:
    with contextlib.ExitStack() as stack:
        first = contextlib.ExitStack()
        port = first.enter_context(emulator("--watchdog", "5.0"))
        network = stack.enter_context(relay(port))
        controller = Controller(network)
        assert controller.ordered(controller.drive.enable) & Status.ENABLED
        first.close()
        stack.enter_context(emulator("--watchdog", "5.0", "--port", str(port)))
        controller.until(lambda status: not status & (Status.ENABLED | Status.LINK_LOST))
        for _ in range(100):
            assert not controller.tick() & Status.ENABLED
        controller.drive.close()
