"""The conformance suite fails what is not a drive: one bad drive for each promise that it is to find broken."""

import math
import select
from collections.abc import Callable

import pytest

from fullpose._typing import Array
from fullpose_server.drives.base import Drive, Status
from fullpose_server.drives.simulated import SimulatedDrive, SimulatedOptions
from fullpose_server.drives.testing.conformance import DriveConformance


class Sound(SimulatedDrive):
    """The simulated table, made as the suite makes one."""

    def __init__(self) -> None:
        super().__init__(DriveConformance.rig, DriveConformance.rate_hz, SimulatedOptions())


class ReadBlocks(Sound):
    """As long as the round trip over a serial line."""

    def read(self, now: float, position: Array, rate: Array) -> int:
        select.select([], [], [], 0.005)  # nothing comes within 5 ms
        return super().read(now, position, rate)


class WriteBlocks(Sound):
    def write(self, position: Array, rate: Array, acceleration: Array, epoch: int, sequence: int) -> None:
        select.select([], [], [], 0.005)  # nothing comes within 5 ms
        super().write(position, rate, acceleration, epoch, sequence)


class NotYetLinked(Sound):
    """Its connect returns before there is a link."""

    reads = 0

    def read(self, now: float, position: Array, rate: Array) -> int:
        self.reads += 1
        status = super().read(now, position, rate)
        return status | Status.LINK_LOST if self.reads < 20 else status


class EncoderWithoutNan(Sound):
    def read(self, now: float, position: Array, rate: Array) -> int:
        return super().read(now, position, rate) | Status.ENCODER


class NanWithoutEncoder(Sound):
    def read(self, now: float, position: Array, rate: Array) -> int:
        status = super().read(now, position, rate)
        position[1] = math.nan
        return status


class NoEmergencyBrake(Sound):
    def emergency_brake(self) -> None:
        pass


class NoWatchdog(Sound):
    def read(self, now: float, position: Array, rate: Array) -> int:
        self._quiet[0] = 0
        return super().read(now, position, rate)


def failures(make: Callable[[], Drive], tests: tuple[str, ...] = ()) -> dict[str, str]:
    """The tests of the suite (none named: all) that a drive fails, with what they say."""

    class Suite(DriveConformance):
        def make_drive(self) -> Drive:
            return make()

    found = {}
    for name in tests or [name for name in dir(Suite) if name.startswith("test_")]:
        try:
            getattr(Suite(), name)()
        except AssertionError as failed:
            found[name] = str(failed)
    return found


def test_a_sound_drive_fails_nothing() -> None:
    assert failures(Sound) == {}


@pytest.mark.parametrize(
    ("bad", "test", "says"),
    [
        (ReadBlocks, "test_read_and_write_do_not_block", "read takes"),
        (WriteBlocks, "test_read_and_write_do_not_block", "write takes"),
        (NotYetLinked, "test_it_measures_at_rest_when_connected", "LINK_LOST"),
        (EncoderWithoutNan, "test_it_measures_at_rest_when_connected", "ENCODER"),
        (NanWithoutEncoder, "test_it_measures_at_rest_when_connected", "ENCODER"),
        (NoEmergencyBrake, "test_it_brakes_when_another_thread_has_to", ""),
        (NoWatchdog, "test_it_brakes_by_itself_when_writes_stop", ""),
    ],
)
def test_a_bad_drive_fails_where_it_is_bad(bad: Callable[[], Drive], test: str, says: str) -> None:
    found = failures(bad, (test,))
    assert test in found
    assert says in found[test]
