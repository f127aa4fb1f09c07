"""The udp drive on a network that loses, and that brings old datagrams."""

import math
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.drives.base import Status
from fullpose_server.drives.packet import CommandPacket, Order
from fullpose_server.drives.udp import make
from tests.fullpose_server.drives.tables import SteppedTable, heard

RIG = builtin_rigs()["vertical-4"]
MOST = 5000  # ticks until something must have come


class Controller:
    """A drive, held where it stands tick by tick."""

    def __init__(self, network: SteppedTable) -> None:
        self.network = network
        self.drive = make(RIG, 1000.0, {"port": network.port, "link_lost_s": 5.0, "connect_s": 60.0})
        self.now = time.monotonic()
        self.drive.connect(self.now)
        self.position, self.rate = np.zeros(4), np.zeros(4)
        self.drive.read(self.now, self.position, self.rate)
        self.start = self.position.copy()
        self.sequence = 0

    def tick(self, demand: np.ndarray | None = None) -> Status:
        self.now += self.network.period
        self.network.tick(self.now)
        heard(self.drive)
        status = self.drive.read(self.now, self.position, self.rate)
        self.sequence += 1
        zero = np.zeros(4)
        self.drive.write(self.start if demand is None else demand, zero, zero, 1, self.sequence)
        return Status(status)

    def until(self, wanted: Callable[[Status], bool]) -> list[Status]:
        """What was read until `wanted` came."""
        seen: list[Status] = []
        while not seen or not wanted(seen[-1]):
            assert len(seen) < MOST, seen[-20:]
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
    network = SteppedTable(RIG, 1000.0, 5.0)
    made = Controller(network)
    yield made
    made.drive.close()
    network.close()


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
    for _ in range(MOST):
        controller.tick(far)
        if len(controller.network.lost) >= 5:
            break
    late = list(controller.network.lost)
    controller.ordered(controller.drive.brake)
    assert controller.ordered(controller.drive.enable) & Status.ENABLED
    for data in late:
        controller.network.send(data)
    controller.until(lambda status: bool(status & Status.STALE_WRITE))
    for _ in range(50):
        controller.tick()
        assert np.abs(controller.position - controller.start).max() < math.radians(0.05)


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
    controller.network.tick(controller.now)  # the last words are heard
    controller.network.expect()
    again = Controller(controller.network)
    assert again.ordered(again.drive.enable) & Status.ENABLED
    again.drive.close()


def test_a_table_that_restarts_is_not_enabled_by_itself(controller: Controller) -> None:
    assert controller.ordered(controller.drive.enable) & Status.ENABLED
    controller.network.restart(controller.now)
    controller.until(lambda status: not status & (Status.ENABLED | Status.LINK_LOST))
    for _ in range(100):
        assert not controller.tick() & Status.ENABLED
