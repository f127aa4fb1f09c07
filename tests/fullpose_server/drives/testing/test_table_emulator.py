"""The table behind the datagrams: every order once, none that is old, and no demand enables it."""

from fullpose.rig import builtin_rigs
from fullpose_server.drives.base import Status
from fullpose_server.drives.packet import CommandPacket, Order
from fullpose_server.drives.testing.table_emulator import Table

ZERO = (0.0,) * 4
FAR = (5.0,) * 4
DT = 1e-3


class At:
    """A table, and its time."""

    def __init__(self) -> None:
        self.table = Table(builtin_rigs()["vertical-4"], 1.0 / DT, 0.05)
        self.now = 0.0
        self.table.begin(self.now)

    def take(self, order: Order, number: int, sequence: int = 0, position: tuple[float, ...] = ZERO) -> int:
        """Status after one datagram and a period."""
        self.table.take(CommandPacket(order, number, 1, sequence, 0.0, position, ZERO, ZERO))
        self.now += DT
        self.state = self.table.advance(self.now)
        return self.state.status


def test_orders_are_taken_and_named() -> None:
    at = At()
    assert at.take(Order.HELLO, 0) == 0
    assert at.state.number == 0
    assert at.take(Order.ENABLE, 7) == Status.ENABLED
    assert at.take(Order.BRAKE, 8) == Status.BRAKING
    assert at.take(Order.DISABLE, 9) == 0
    assert at.state.number == 9


def test_an_old_enable_does_not_undo_a_disable() -> None:
    at = At()
    at.take(Order.ENABLE, 1)
    at.take(Order.DISABLE, 2)
    assert at.take(Order.ENABLE, 1) == 0
    assert at.state.number == 2


def test_an_enable_that_comes_twice_does_not_undo_the_watchdog() -> None:
    at = At()
    at.take(Order.ENABLE, 1)
    for _ in range(100):
        status = at.take(Order.HELLO, 0)
    assert status & Status.WATCHDOG
    assert not at.take(Order.ENABLE, 1) & Status.ENABLED
    assert at.take(Order.ENABLE, 2) == Status.ENABLED


def test_a_demand_never_enables() -> None:
    at = At()
    assert at.take(Order.FOLLOW, 1, 1) == 0
    assert at.state.number == 0


def test_a_demand_of_an_earlier_series_is_refused_and_said() -> None:
    at = At()
    at.take(Order.ENABLE, 1)
    at.take(Order.FOLLOW, 1, 500)
    at.take(Order.ENABLE, 2)
    assert at.state.sequence == 0
    assert at.take(Order.FOLLOW, 1, 501, FAR) & Status.STALE_WRITE
    assert at.take(Order.FOLLOW, 2, 1) == Status.ENABLED
    for _ in range(20):
        at.take(Order.HELLO, 0)
    assert at.state.sequence == 1
    assert max(map(abs, at.state.position)) < 0.01
