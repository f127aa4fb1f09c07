"""The simulated table: it conforms, it is deterministic, and its scripted faults are what they say."""

import math
from typing import Any

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.drives import registry
from fullpose_server.drives.base import Drive, DriveError, Status
from fullpose_server.drives.simulated import make
from fullpose_server.drives.testing.conformance import DriveConformance

RIG = builtin_rigs()["vertical-4"]
DT = 1e-3


class TestSimulated(DriveConformance):
    def make_drive(self) -> Drive:
        return make(self.rig, self.rate_hz, {})


class TestThreeAxis(DriveConformance):
    rig = builtin_rigs()["horizontal-3"]
    rate_hz = 500.0

    def make_drive(self) -> Drive:
        return make(self.rig, self.rate_hz, {"backlash_deg": 0.001, "seed": 3})


def fly(options: dict[str, Any], seconds: float = 1.0, speed_deg_s: float = 20.0) -> tuple[np.ndarray, list[int]]:
    """Measured positions [deg] and status while every frame is asked to turn at one speed."""
    drive = make(RIG, 1000.0, options)
    position, rate = np.zeros(4), np.zeros(4)
    now = 0.0
    drive.connect(now)
    drive.read(now, position, rate)
    drive.enable()
    rows, status = [], []
    speed = np.radians([speed_deg_s] * 4)
    for k in range(1, round(seconds / DT)):
        now += DT
        status.append(drive.read(now, position, rate))
        rows.append(np.degrees(position))
        # A ramp in, so that the servos do not saturate.
        t = k * DT
        drive.write(speed * max(t - 0.1, t * t / 0.4 if t < 0.2 else 0.0), speed * min(1.0, t / 0.2), 0 * speed, 1, k)
    return np.array(rows), status


def test_the_same_seed_is_the_same_table() -> None:
    a, _ = fly({"seed": 5})
    b, _ = fly({"seed": 5})
    c, _ = fly({"seed": 6})
    np.testing.assert_array_equal(a, b)
    assert (a != c).any()


def test_it_follows_a_constant_rate_without_lag() -> None:
    rows, _ = fly({}, 1.0)
    demand = 20.0 * (np.arange(1, len(rows) + 1) * DT - 0.1)
    # Read at tick k, the table is where the demand written at k - 1 was due.
    assert np.abs(rows[500:, 1] - demand[499:-1]).max() < 0.002


def test_the_encoder_has_its_resolution() -> None:
    rows, _ = fly({"encoder_bits": 12, "noise_deg": 0.0})
    steps = rows / (360.0 / 4096)
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)


def test_noise_has_its_size() -> None:
    rows, _ = fly({"noise_deg": 0.01}, 2.0, 0.0)
    assert rows.std() == pytest.approx(0.01, rel=0.1)


def test_backlash_is_lost_when_the_motion_turns() -> None:
    rows, _ = fly({"backlash_deg": 0.2, "noise_deg": 0.0}, 1.0)
    demand = 20.0 * (np.arange(1, len(rows) + 1) * DT - 0.1)
    assert (demand[499:-1] - rows[500:, 1]).mean() == pytest.approx(0.1, abs=0.005)


def test_rate_and_acceleration_saturate() -> None:
    rows, _ = fly({"noise_deg": 0.0, "encoder_bits": 40}, 1.0, 2000.0)
    rate = np.diff(rows, axis=0) / DT
    limit = np.degrees(RIG.max_rate) * 1.2
    assert (np.abs(rate) <= limit * 1.001).all()
    assert (np.abs(rate).max(axis=0) > limit * 0.99).any()
    acceleration = np.diff(rate, axis=0) / DT
    assert (np.abs(acceleration) <= np.degrees(RIG.max_acceleration) * 1.5 * 1.02).all()


def fault(kind: str, frame: str | None = None, **rest: Any) -> dict[str, Any]:
    return {"faults": [{"kind": kind, "frame": frame, "at_s": 0.5, **rest}]}


def test_a_stuck_frame_stands_and_the_others_go_on() -> None:
    rows, _ = fly(fault("stuck", "middle"))
    assert np.ptp(rows[520:, 2]) < 0.001
    assert np.ptp(rows[520:, 1]) > 5.0


def test_a_runaway_runs() -> None:
    rows, _ = fly(fault("runaway", "inner", duration_s=0.1))
    assert rows[600, 3] - rows[600, 1] > 5.0


def test_a_lost_encoder_is_no_number_and_is_said() -> None:
    rows, status = fly(fault("encoder", "outer"))
    assert np.isnan(rows[600, 1])
    assert status[600] & Status.ENCODER
    assert not status[400] & Status.ENCODER


def test_latency_delays() -> None:
    rows, _ = fly(fault("latency", ticks=20))
    demand = 20.0 * (np.arange(1, len(rows) + 1) * DT - 0.1)
    assert (demand[899:-1] - rows[900:, 1]).mean() == pytest.approx(0.4, abs=0.02)


def test_a_cut_link_is_said_and_the_table_brakes() -> None:
    _, status = fly(fault("link"))
    assert status[600] & Status.LINK_LOST
    assert status[600] & Status.WATCHDOG


def test_a_stall_of_the_reader_trips_the_watchdog() -> None:
    drive = make(RIG, 1000.0, {"watchdog_s": 0.05})
    position, rate = np.zeros(4), np.zeros(4)
    drive.connect(0.0)
    drive.read(0.0, position, rate)
    drive.enable()
    drive.write(position, rate, rate, 1, 1)
    assert not drive.read(0.04, position, rate) & Status.WATCHDOG
    drive.write(position, rate, rate, 1, 2)
    assert drive.read(5.0, position, rate) & Status.WATCHDOG
    assert math.isfinite(position.sum())


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"bandwith_hz": 3}, "no option bandwith_hz"),
        ({"bandwidth_hz": "fast"}, "bandwidth_hz"),
        (fault("gremlin"), "gremlin"),
        (fault("stuck", "neck"), "neck"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, Any], match: str) -> None:
    with pytest.raises(DriveError, match=match):
        make(RIG, 1000.0, options)


def test_an_unknown_drive_is_refused_with_the_names() -> None:
    with pytest.raises(DriveError, match="there are simulated"):
        registry.make("hydraulic", RIG, 1000.0, {})
