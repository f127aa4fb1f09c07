"""A drive that does not do what it was told is found out, once, and not because we were slow ourselves."""

from fullpose_server.drives.base import Status
from fullpose_server.drives.response_monitor import DriveResponseMonitor

ON, OFF, OPEN = int(Status.ENABLED), 0, int(Status.UNCONFIRMED)


def ticks(monitor: DriveResponseMonitor, asked: bool, status: int, count: int, moving: bool = False) -> list[int]:
    """The ticks, from 1, in which patience ends."""
    return [k + 1 for k in range(count) if monitor.ends(asked, moving, status)]


def test_an_order_has_its_time_and_its_failure_is_said_once() -> None:
    for asked, status in ((True, OFF), (True, OPEN), (False, ON), (False, OPEN)):
        assert ticks(DriveResponseMonitor(10), asked, status, 50) == [10]


def test_a_drive_that_obeys_in_time_is_not_accused() -> None:
    monitor = DriveResponseMonitor(10)
    for asked, late, done in ((True, OPEN, ON), (False, ON | OPEN, OFF), (True, OFF, ON), (False, OPEN, OFF)):
        assert not ticks(monitor, asked, late, 9)
        assert not ticks(monitor, asked, done, 50)


def test_a_drive_that_lets_go_in_motion_is_found_at_once() -> None:
    monitor = DriveResponseMonitor(10)
    assert not ticks(monitor, True, ON, 5)
    assert ticks(monitor, True, OFF, 50, moving=True) == [1]


def test_motion_that_begins_before_the_order_has_arrived_is_no_disobedience_yet() -> None:
    assert ticks(DriveResponseMonitor(10), True, OPEN, 50, moving=True) == [10]


def test_after_a_reset_the_same_disobedience_is_said_again() -> None:
    monitor = DriveResponseMonitor(10)
    assert ticks(monitor, False, OPEN, 50) == [10]
    monitor.forget()
    assert ticks(monitor, False, OPEN, 50) == [10]
