"""The guard: each check trips on its own, names frame, value and limit, and sound motion never trips it."""

import math

import numpy as np
import pytest

from fullpose.rig import FrameLimits, Rig, builtin_rigs
from fullpose_server.runtime.contract.config import GuardConfig, Tolerance
from fullpose_server.runtime.motion.limit_guard import Guard
from tests.fullpose_server.runtime.rigs import plan_of

DT = 1e-3
RIG = builtin_rigs()["vertical-limited"]
ZERO = np.zeros(4)
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def command(x: list[float], x1: list[float], v1: list[float], rig: Rig = RIG, **config: float) -> object:
    guard = Guard(rig, GuardConfig(**config), DT)  # type: ignore[arg-type]
    v, a = np.zeros(4), np.zeros(4)
    return guard.command(np.radians(x), np.radians(x1), np.radians(v1), v, a)


@pytest.mark.parametrize(
    ("x", "x1", "v1", "code", "frame"),
    [
        ([0, 0, 0, math.nan], [0, 0, 0, 0], [0, 0, 0, 0], "guard_finite", "inner"),
        ([0, math.inf, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], "guard_finite", "outer"),
        ([0, 0, 6, 0], [0, 0, 0, 0], [0, 0, 0, 0], "guard_step", "middle"),
        ([0, 0, 0, 60.001], [0, 0, 0, 59.9999], [0, 0, 0, 0], "guard_position", "inner"),
        ([0.201, 0, 0, 0], [0, 0, 0, 0], [200, 0, 0, 0], "guard_rate", "base"),
        ([0, 0.002, 0, 0], [0, 0, 0, 0], [0, 1, 0, 0], "guard_acceleration", "outer"),
        ([0, 0, 0, 50.3], [0, 0, 0, 50], [0, 0, 0, 300], "guard_braking", "inner"),
        ([0, 0, 0, -50.3], [0, 0, 0, -50], [0, 0, 0, -300], "guard_braking", "inner"),
    ],
)
def test_each_check_trips_and_names_the_frame(
    x: list[float], x1: list[float], v1: list[float], code: str, frame: str
) -> None:
    found = command(x, x1, v1)
    assert found is not None
    assert (found.code, found.frame, found.trips) == (code, frame, True)  # type: ignore[attr-defined]


def test_the_finding_tells_value_and_limit_in_degrees() -> None:
    found = command([0.201, 0, 0, 0], [0, 0, 0, 0], [200, 0, 0, 0])
    assert found.value == pytest.approx(201.0)  # type: ignore[attr-defined]
    assert found.limit == pytest.approx(200.0)  # type: ignore[attr-defined]
    assert "201 deg/s" in found.message  # type: ignore[attr-defined]


def test_a_frame_without_limits_is_bound_by_the_step_alone() -> None:
    free = Rig("free", RIG.geometry, (FrameLimits(),) * 4)
    assert command([4.9, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], free) is None
    assert command([5.1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], free) is not None


def test_a_step_of_zero_allows_no_motion_at_all() -> None:
    assert command([0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], max_step_deg=0.0) is None
    assert command([1e-6, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], max_step_deg=0.0) is not None


def test_braking_that_just_fits_passes_and_lands_on_the_limit() -> None:
    from fullpose_server.runtime.motion.braking import brake_step, deceleration_for, stopping_distance

    guard = Guard(RIG, GuardConfig(), DT)
    most = float(RIG.max_acceleration[3])
    speed = most * DT * 40.0
    x1 = np.array([0.0, 0.0, 0.0, float(RIG.position_max[3]) - stopping_distance(speed, most, DT)])
    v1 = np.array([0.0, 0.0, 0.0, speed])
    x, v, a = np.zeros(4), np.zeros(4), np.zeros(4)
    deceleration = deceleration_for(1.0, x1, v1, RIG.position_min, RIG.position_max, RIG.max_acceleration, 10.0)
    for _ in range(41):
        rest = brake_step(DT, deceleration, x1, v1, x, v)
        assert guard.command(x, x1, v1, v, a) is None
        x1[:], v1[:] = x, v
        if rest:
            break
    assert rest
    assert x[3] == pytest.approx(float(RIG.position_max[3]), abs=1e-12)


def test_a_sound_plan_never_trips_and_leaves_a_margin() -> None:
    guard = Guard(RIG, GuardConfig(), DT)
    plan = plan_of(RIG, 2.0)
    x1, v1 = plan.angles[0].copy(), np.zeros(4)
    v, a = np.zeros(4), np.zeros(4)
    margins = []
    for x in plan.angles:
        assert guard.command(x, x1, v1, v, a) is None
        margins.append(guard.margin)
        x1[:], v1[:] = x, v
    assert 0.0 < min(margins) < 0.8
    # The margin is what the limits say, worked out anew.
    rate = np.abs(np.diff(plan.angles, axis=0)).max(axis=0) / DT / RIG.max_rate
    room = 1.0 - np.abs(plan.angles[:, 3]).max() / RIG.position_max[3]
    assert min(margins) <= min(1.0 - rate.max(), room) + 1e-9


def test_following_and_attitude_have_two_levels() -> None:
    guard = Guard(RIG, GuardConfig(following_deg=Tolerance(1.0, 3.0), attitude_deg=Tolerance(None, 0.5)), DT)
    nothing = np.full(4, math.nan)
    assert guard.measured(np.radians([0, 0, 0.9, 0]), ZERO, nothing)[1] == []
    _, (warned,) = guard.measured(np.radians([0, 0, -2.0, 0]), ZERO, nothing)
    assert (warned.code, warned.frame, warned.trips) == ("following_error", "middle", False)
    _, (tripped,) = guard.measured(np.radians([0, 0, 0, 3.1]), ZERO, nothing)
    assert (tripped.frame, tripped.trips, tripped.limit) == ("inner", True, 3.0)
    error, (off,) = guard.measured(np.radians([0, 0.6, 0, 0]), ZERO, LEVEL)
    assert math.degrees(error) == pytest.approx(0.6)
    assert (off.code, off.trips) == ("attitude_error", True)


@pytest.mark.parametrize("following", [Tolerance(1.0, 3.0), Tolerance(0.0, None), Tolerance(None, None)])
def test_a_warning_of_one_thing_hides_no_trip_of_another(following: Tolerance) -> None:
    guard = Guard(RIG, GuardConfig(following_deg=following, attitude_deg=Tolerance(1.0, 5.0)), DT)
    _, found = guard.measured(np.radians([2.9, 2.0, 2.9, 0]), ZERO, LEVEL)  # none beyond 3 deg, together beyond 5
    assert [f.trips for f in found if f.code == "attitude_error"] == [True]


@pytest.mark.parametrize("following", [Tolerance(1.0, 3.0), Tolerance(None, None)])
def test_a_measurement_that_is_no_number_trips(following: Tolerance) -> None:
    guard = Guard(RIG, GuardConfig(following_deg=following), DT)
    _, (found,) = guard.measured(np.array([0.0, math.nan, 0.1, 0.0]), ZERO, ZERO)
    assert (found.trips, found.frame) == (True, "outer")


@pytest.mark.parametrize(
    ("x", "x1", "v1", "code"),
    [
        (61.0, 61.0, 0.0, None),  # it stands where it was found
        (60.9999, 61.0, 0.0, None),  # and comes back
        (61.0001, 61.0, 0.0, "guard_position"),
        (-60.9999, -61.0, 0.0, None),
        (-61.0001, -61.0, 0.0, "guard_position"),
        (60.0 + 1e-6, 60.0, 0.0, "guard_position"),  # from inside, no farther than its limit
    ],
)
def test_a_frame_found_outside_its_range_may_only_come_back(x: float, x1: float, v1: float, code: str | None) -> None:
    found = command([0, 0, 0, x], [0, 0, 0, x1], [0, 0, 0, v1])
    assert getattr(found, "code", None) == code


def test_zero_is_a_level_and_none_is_off() -> None:
    guard = Guard(RIG, GuardConfig(), DT)
    assert guard.scalar("x", 1e-9, Tolerance(None, 0.0)) is not None
    assert guard.scalar("x", 0.0, Tolerance(0.0, 0.0)) is None
    assert guard.scalar("x", 1e9, Tolerance(None, None)) is None
    with pytest.raises(ValueError, match="zero or more"):
        Tolerance(-1.0, None)
