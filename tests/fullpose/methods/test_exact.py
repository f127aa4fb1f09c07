"""`exact`: exact wherever it is not marked, inside every limit always, back on the attitude after leaving it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import EXACT, limited_name
from fullpose.errors import MethodError
from fullpose.methods.exact import ExactOptions
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.solution import Solution
from fullpose.solve import solve
from fullpose.verify import verify

RIGS = builtin_rigs()
FOUR = ("vertical-4", "horizontal-4", "vertical-limited")
DEG = np.pi / 180.0
PLAIN = ExactOptions(avoidance=0.0, centring=0.0)


def checked(
    time: NDArray[np.float64], C: NDArray[np.float64], rig: Rig, options: ExactOptions | None = None
) -> Solution:
    """The solution, with what must hold for every flight checked by code that shares none with the method."""
    solution = solve(time, C, rig, "exact", options)
    verification = verify(time, solution.angles, rig, C)
    assert verification.violations == ()
    if solution.limited_samples < len(time):
        assert solution.matrix_error[solution.limited == EXACT].max() <= 1e-14
    assert np.all((solution.angles >= rig.position_min) & (solution.angles <= rig.position_max))
    return solution


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    rate=st.sampled_from([60.0, 120.0, 300.0, 900.0]),
    name=st.sampled_from(FOUR),
    uneven=st.booleans(),
    hertz=st.sampled_from([100.0, 1000.0]),
    options=st.sampled_from([ExactOptions(), PLAIN, ExactOptions(homing=1.0, recovery=1.0)]),
)
def test_random_flights_never_exceed_a_limit(
    seed: int, rate: float, name: str, uneven: bool, hertz: float, options: ExactOptions
) -> None:
    time, q = random_flight(seed, 6.0, hertz, rate * DEG)
    if uneven:
        keep = np.random.default_rng(seed).random(len(time)) < 0.4
        time, q = time[keep], q[keep]
    checked(time, dcm_from_quaternion(q), RIGS[name], options)


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000), span=st.floats(20.0, 400.0), acceleration=st.floats(20.0, 5000.0))
def test_rigs_of_all_sorts(seed: int, span: float, acceleration: float) -> None:
    random = np.random.default_rng(seed)
    frames = tuple(
        FrameLimits(-span * DEG * k, span * DEG * k, 200.0 * DEG * k, acceleration * DEG * k, weight=k)
        for k in random.uniform(0.5, 2.0, 4)
    )
    rig = Rig("random", (Geometry.VERTICAL_4, Geometry.HORIZONTAL_4)[seed % 2], frames)  # type: ignore[arg-type]
    time, q = random_flight(seed, 4.0, 500.0, 100.0 * DEG)
    checked(time, dcm_from_quaternion(q), rig)


@pytest.mark.parametrize("name", SCENARIOS)
@pytest.mark.parametrize("rig", FOUR)
def test_scenarios(name: str, rig: str) -> None:
    scenario = SCENARIOS[name]
    solution = checked(scenario.time, dcm_from_quaternion(scenario.quaternion), RIGS[rig])
    if name in ("small_angles", "level", "loop", "one_sample", "two_samples"):
        assert solution.limited_samples == 0


@pytest.mark.parametrize("rig", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("name", ["large_no_limit", "over_limit_loop", "both_beyond_90", "double_loop", "fast_roll"])
def test_without_limits_every_sample_is_exact(name: str, rig: Geometry) -> None:
    scenario = SCENARIOS[name]
    solution = checked(scenario.time, dcm_from_quaternion(scenario.quaternion), Rig("free", rig))
    assert solution.limited_samples == 0
    assert solution.matrix_error.max() <= 1e-14


def test_angles_do_not_jump_over_turns() -> None:
    time = np.arange(0.0, 10.0, 1e-3)
    solution = checked(time, dcm_from_euler(0.0, 0.0, 300.0 * DEG * time), Rig("free", Geometry.VERTICAL_4), PLAIN)
    assert np.abs(np.diff(solution.angles, axis=0)).max() < 0.01
    assert solution.angles[-1, 3] == pytest.approx(300.0 * DEG * time[-1])


def test_the_step_is_the_one_of_least_norm() -> None:
    """Against the minimum-norm motion integrated at a far finer step by NumPy's pseudo-inverse."""
    time = np.arange(0.0, 1.0, 1e-2)
    fine = np.arange(0.0, 0.9901, 1e-4)

    def flight(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return dcm_from_euler(0.5 * np.sin(2.0 * t), 0.4 * t, 0.6 * t**2)

    rig = Rig("free", Geometry.VERTICAL_4)
    coarse = solve(time, flight(time), rig, "exact", PLAIN).angles
    reference = solve(fine, flight(fine), rig, "exact", PLAIN).angles[::100]
    np.testing.assert_allclose(coarse, reference, atol=2e-3)
    # First order in the step: ten times the samples, a tenth of the difference.
    middle = np.arange(0.0, 0.9901, 1e-3)
    np.testing.assert_allclose(solve(middle, flight(middle), rig, "exact", PLAIN).angles[::10], reference, atol=2e-4)


def test_limited_samples_name_the_frame_and_the_limit() -> None:
    time = np.arange(0.0, 4.0, 1e-3)
    C = dcm_from_euler(0.0, 0.0, 0.5 * (1.0 - np.cos(time)) * 100.0 * DEG)
    frame = FrameLimits()
    narrow = Rig("narrow", Geometry.VERTICAL_4, (FrameLimits(0.0, 0.0), frame, frame, FrameLimits(-0.5, 0.5)))
    solution = checked(time, C, narrow)
    assert limited_name(int(solution.limited[solution.limited != EXACT][0])) == ("inner", "position")
    assert solution.blocking is not None
    assert (solution.blocking.frame, solution.blocking.limit) == ("inner", "position")
    slow = Rig("slow", Geometry.VERTICAL_4, (FrameLimits(0.0, 0.0), frame, frame, FrameLimits(max_rate=0.2)))
    assert limited_name(int(solve(time, C, slow, "exact").limited.max())) == ("inner", "rate")
    heavy = Rig("heavy", Geometry.VERTICAL_4, (FrameLimits(0.0, 0.0), frame, frame, FrameLimits(max_acceleration=0.2)))
    assert limited_name(int(solve(time, C, heavy, "exact").limited.max())) == ("inner", "acceleration")


def test_the_error_left_is_no_more_than_the_limit_costs() -> None:
    """Roll alone, base held: with the inner frame at its stop the error is what roll is beyond it."""
    time = np.arange(0.0, 4.0, 1e-3)
    roll = 0.5 * (1.0 - np.cos(0.5 * np.pi * time)) * 50.0 * DEG
    still = FrameLimits(0.0, 0.0)
    rig = Rig("one", Geometry.VERTICAL_4, (still, still, still, FrameLimits(-0.5, 0.5)))
    solution = checked(time, dcm_from_euler(0.0, 0.0, roll), rig)
    np.testing.assert_allclose(solution.error, np.maximum(0.0, roll - 0.5), atol=1e-6)


def test_return_to_the_attitude_without_overshoot() -> None:
    """A turn too fast for the acceleration, then a rest: caught up, once, and held exactly."""
    time = np.arange(0.0, 4.0, 1e-3)
    u = np.clip((time - 0.5) / 0.4, 0.0, 1.0)
    C = dcm_from_euler(0.0, 0.0, 60.0 * DEG * u * u * (3.0 - 2.0 * u))
    still = FrameLimits(0.0, 0.0)
    rig = Rig("one", Geometry.VERTICAL_4, (still, still, still, FrameLimits(max_acceleration=400.0 * DEG)))
    solution = checked(time, C, rig)
    limited = np.flatnonzero(solution.limited)
    assert limited.size > 100
    assert solution.error.max() > 1.0 * DEG
    # One departure, one return; from then on exact to the end.
    assert np.all(np.diff(limited) == 1)
    assert limited[-1] < 3000
    assert solution.error[limited[-1] + 1 :].max() < 1e-14
    # After the turn has ended the angle goes back to it from one side only, within a hundredth of what it was off.
    off = solution.angles[950:, 3] - 60.0 * DEG
    assert min(abs(off.min()), abs(off.max())) < 0.01 * np.abs(off).max()


@pytest.mark.parametrize("middle", [90.0, -90.0])
@pytest.mark.parametrize("outer", [0.0, 180.0])
@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4"])
def test_start_on_the_singularity(name: str, outer: float, middle: float) -> None:
    """Some of what follows cannot be flown from there at once; what is flown is exact, and it is found again."""
    from fullpose.verify import payload_attitudes

    rig = RIGS[name]
    start = np.array([10.0, outer, middle, 20.0]) * DEG
    time = np.arange(0.0, 6.0, 1e-3)
    C0 = payload_attitudes(rig, start[None])[0]
    C = dcm_from_euler(20.0 * DEG * np.sin(time), 15.0 * DEG * np.sin(0.8 * time), 0.2 * time) @ C0
    solution = solve(time, C, rig, "exact", start=start)
    np.testing.assert_allclose(solution.angles[0], start, atol=1e-12)
    assert verify(time, solution.angles, rig).violations == ()
    assert solution.matrix_error[solution.limited == EXACT].max() <= 1e-14
    assert solution.limited[-1] == EXACT


def test_level_turn_past_the_singularity() -> None:
    """Yaw through 180 deg at level pitch, then pitch up: the minimum-norm step runs into the singular pose."""
    time = np.arange(0.0, 16.0, 1e-3)

    def ease(begin: float, end: float) -> NDArray[np.float64]:
        u = np.clip((time - begin) / (end - begin), 0.0, 1.0)
        return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u * u))

    C = dcm_from_euler(180.0 * DEG * ease(1.0, 8.0), 60.0 * DEG * ease(10.0, 14.0), 0.0 * time)
    assert checked(time, C, RIGS["vertical-4"]).limited_samples == 0
    assert checked(time, C, RIGS["vertical-4"], PLAIN).limited_samples > 0


def test_blocks_do_not_matter() -> None:
    scenario = SCENARIOS["over_limit"]
    time, C = scenario.time[:2000], dcm_from_quaternion(scenario.quaternion)[:2000]
    rig = RIGS["vertical-limited"]
    from fullpose.methods import METHODS

    stepper = METHODS["exact"].stepper(rig, ExactOptions(), None, C[0])
    single = np.vstack([stepper.block(time[k : k + 1], C[k : k + 1]).angles for k in range(len(time))])
    np.testing.assert_array_equal(single, solve(time, C, rig, "exact").angles)


def test_homing_returns_home_along_the_self_motion() -> None:
    time = np.arange(0.0, 20.0, 1e-2)
    C = np.broadcast_to(dcm_from_euler(0.0, 30.0 * DEG, 0.0), (len(time), 3, 3))
    rig = Rig("free", Geometry.VERTICAL_4)
    start = np.array([60.0 * DEG, 0.0, 0.0, 0.0])
    options = ExactOptions(avoidance=0.0, centring=0.0, homing=1.0)
    angles = solve(time, C, rig, "exact", options, start=start).angles
    nearest_home = solve(time[:1], C[:1], rig, "exact").angles[0]
    assert np.linalg.norm(angles[-1]) < np.linalg.norm(angles[0])
    np.testing.assert_allclose(angles[-1], nearest_home, atol=1e-6)


@pytest.mark.parametrize("bad", [{"avoidance": -1.0}, {"homing": np.nan}, {"recovery": 0.0}, {"centring": np.inf}])
def test_bad_options(bad: dict[str, float]) -> None:
    with pytest.raises(MethodError, match=next(iter(bad))):
        ExactOptions(**bad)


@pytest.mark.parametrize("name", ["vertical-3", "horizontal-3"])
def test_three_axis_rigs_are_refused(name: str) -> None:
    with pytest.raises(MethodError, match="fourth axis"):
        solve([0.0], np.eye(3)[None], RIGS[name], "exact")
