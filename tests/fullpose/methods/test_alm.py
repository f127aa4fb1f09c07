"""`alm`: the multiplier iteration against SciPy, its four modes, its iteration counts, its limits."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from scipy.optimize import lsq_linear

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.compare import EXACT_WITHIN, failures
from fullpose.errors import MethodError
from fullpose.methods.alm import AlmOptions, Mode, multipliers
from fullpose.methods.multipliers import multiplier_step
from fullpose.methods.state import new_flight
from fullpose.rig import builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.solve import solve
from fullpose.verify import verify
from tests.support.problems import Problem, random_problem

RIGS = builtin_rigs()
DEG = np.pi / 180.0
MODES = tuple(Mode)
DEFAULT = AlmOptions()


def reference_step(problem: Problem) -> Array | None:
    """The step of least (s - g)^T W (s - g) with J s = e inside the box, by SciPy alone; None where there is none.

    All steps that make the increment are s0 + N z: a bounded least squares of the one unknown z.
    """
    J, _, _, weight, g, e, lo, hi = problem
    s0, N = np.linalg.lstsq(J, e)[0], null_space(J)[:, 0]
    ends = np.sort([(lo - s0) / N, (hi - s0) / N], axis=0)
    bounds = float(ends[0].max()), float(ends[1].min())
    if bounds[0] >= bounds[1]:
        return None
    root = np.sqrt(weight)
    z = lsq_linear((root * N)[:, None], root * (g - s0), bounds=bounds, method="bvls", tol=1e-15).x
    return np.asarray(s0 + N * z)


@settings(max_examples=400)
@given(
    seed=st.integers(0, 2**32 - 1),
    width=st.sampled_from([1.0, 2.0, 4.0, 100.0, np.inf]),
    scale=st.sampled_from([1e-5, 1e-4, 1e-3, 1e-2]),
)
def test_the_iteration_solves_the_programme(seed: int, width: float, scale: float) -> None:
    """Within 1e-8 rad a step wherever it is feasible; where it is not, it does not claim to have settled."""
    problem = random_problem(seed, width, scale)
    assume(problem.manipulability > 0.1)
    expected = reference_step(problem)
    flight = new_flight(RIGS["vertical-4"], np.zeros(4), EXACT, np.eye(3))
    flight.J[:], flight.e[:], flight.increment[:], flight.weight[:] = problem.J, problem.e, problem.g, problem.weight
    flight.lo[:], flight.hi[:] = problem.lo, problem.hi
    count = multiplier_step(flight, multipliers(DEFAULT))
    assert abs(count) <= DEFAULT.max_iterations
    assert (count > 0) == (expected is not None)
    if expected is not None:
        np.testing.assert_allclose(flight.step, expected, atol=1e-8)


@settings(max_examples=24)
@given(
    seed=st.integers(0, 10_000),
    rate=st.sampled_from([60.0, 300.0]),
    name=st.sampled_from(["vertical-4", "horizontal-4", "vertical-limited"]),
    mode=st.sampled_from(MODES),
    uneven=st.booleans(),
)
def test_random_flights_never_exceed_a_limit(seed: int, rate: float, name: str, mode: Mode, uneven: bool) -> None:
    time, q = random_flight(seed, 4.0, 1000.0, rate * DEG)
    if uneven:
        keep = np.random.default_rng(seed).random(len(time)) < 0.4
        time, q = time[keep], q[keep]
    C = dcm_from_quaternion(q)
    solution = solve(time, C, RIGS[name], "alm", AlmOptions(mode=mode))
    assert verify(time, solution.angles, RIGS[name]).violations == ()
    assert solution.iterations.max() <= DEFAULT.max_iterations
    if mode is Mode.EXACT and solution.limited_samples < len(time):
        assert solution.matrix_error[solution.limited == EXACT].max() <= 1e-14


@pytest.mark.parametrize("name", ["small_angles", "large_no_limit", "level", "loop", "both_beyond_90"])
def test_scenarios_it_can_fly(name: str) -> None:
    scenario = SCENARIOS[name]
    C = dcm_from_quaternion(scenario.quaternion)
    solution = solve(scenario.time, C, RIGS["vertical-4"], "alm", AlmOptions(mode=Mode.EXACT))
    assert solution.limited_samples == 0
    assert solution.matrix_error.max() <= 1e-14
    assert 6 <= np.median(solution.iterations) <= 10
    # The same flight by the closed form: the same frame angles.
    np.testing.assert_allclose(solution.angles, solve(scenario.time, C, RIGS["vertical-4"], "exact").angles, atol=1e-8)


def linearisation(angles: np.ndarray) -> np.ndarray:
    """What a step along the tangent may leave [rad], (n,): half the square of the frames' ways together."""
    return 0.5 * np.abs(np.diff(angles, axis=0, prepend=angles[:1])).sum(axis=1) ** 2


@pytest.mark.parametrize("name", ["small_angles", "large_no_limit", "level", "loop", "both_beyond_90", "non_uniform"])
def test_by_default_the_loop_is_closed_and_nothing_else_mends_the_step(name: str) -> None:
    """What is left is the last step's linearisation: never more, and not the exact curve in its place."""
    scenario = SCENARIOS[name]
    C = dcm_from_quaternion(scenario.quaternion)
    assert AlmOptions().mode is Mode.CLOSED_LOOP
    solution = solve(scenario.time, C, RIGS["vertical-4"], "alm")
    assert solution.limited_samples == 0
    assert (solution.error <= linearisation(solution.angles) + 1e-12).all()
    if name != "loop":  # about one axis all along: its tangent is its curve
        assert solution.error.max() > 1e-9


@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
def test_with_the_inner_frame_held_the_rest_is_exact_away_from_its_fold(rig: str) -> None:
    """Zhao's second optimisation: the inner angle is the closed loop's own, the other three make the attitude."""
    time, q = random_flight(3, 4.0, 1000.0, 60.0 * DEG)
    C = dcm_from_quaternion(q)
    options = {"avoidance": 0.0, "centring": 0.0}
    held = solve(time, C, RIGS[rig], "alm", AlmOptions(mode=Mode.EXACT_INNER, **options))  # type: ignore[arg-type]
    folded = np.abs(np.sin(held.angles[:, 1])) < 0.05
    exact = (held.limited == EXACT) & ~folded
    assert exact.mean() > 0.5
    assert held.matrix_error[exact].max() <= 1e-13
    closed = solve(time, C, RIGS[rig], "alm", AlmOptions(**options))  # type: ignore[arg-type]
    assert np.abs(held.angles[:, 3] - closed.angles[:, 3]).max() > 0.0  # each goes on from its own pose
    np.testing.assert_allclose(held.angles[1, 3], closed.angles[1, 3], atol=1e-12)  # the first step is the same


def test_the_modes_are_the_papers_order_of_accuracy() -> None:
    """Open loop drifts with the linearisation, closed loop keeps its last step's share, exact has none."""
    scenario = SCENARIOS["large_no_limit"]
    C = dcm_from_quaternion(scenario.quaternion)
    paper = {"avoidance": 0.0, "centring": 0.0}
    worst = [
        solve(scenario.time, C, RIGS["vertical-4"], "alm", AlmOptions(mode=mode, **paper)).matrix_error.max()
        for mode in (Mode.OPEN_LOOP, Mode.CLOSED_LOOP, Mode.EXACT)
    ]
    assert 1e-4 < worst[0] < 1e-2
    assert 1e-8 < worst[1] < 1e-5
    assert worst[2] <= 1e-14


def test_published_open_loop_error_at_small_angles() -> None:
    """1e-6 to 1e-7 in the paper; our small-angle flight and sample rate are not its own, so the order is the claim."""
    scenario = SCENARIOS["small_angles"]
    options = AlmOptions(mode=Mode.OPEN_LOOP, avoidance=0.0, centring=0.0)
    solution = solve(scenario.time, dcm_from_quaternion(scenario.quaternion), RIGS["vertical-4"], "alm", options)
    assert solution.matrix_error.max() < 1e-5
    assert solution.limited_samples == 0


@pytest.mark.parametrize("mode", MODES)
def test_where_the_limit_binds_samples_are_marked(mode: Mode) -> None:
    scenario = SCENARIOS["over_limit"]
    solution = solve(
        scenario.time,
        dcm_from_quaternion(scenario.quaternion),
        RIGS["vertical-limited"],
        "alm",
        AlmOptions(mode=mode, avoidance=0.0, centring=0.0),
    )
    assert solution.limited_samples > 0
    assert solution.blocking is not None
    assert (solution.blocking.frame, solution.blocking.limit) == ("inner", "position")
    assert np.abs(solution.angles[:, 3]).max() <= 60.0 * DEG


def test_the_cap_is_kept_and_said() -> None:
    scenario = SCENARIOS["large_no_limit"]
    time, C = scenario.time[:500], dcm_from_quaternion(scenario.quaternion)[:500]
    options = AlmOptions(max_iterations=3, mode=Mode.CLOSED_LOOP)
    solution = solve(time, C, RIGS["vertical-4"], "alm", options)
    assert solution.iterations.max() == 3


@pytest.mark.parametrize("mode", [Mode.OPEN_LOOP, Mode.CLOSED_LOOP])
def test_a_step_that_the_cap_ended_is_the_iterations_own(mode: Mode) -> None:
    """Not the closed form in its place: the error shows where the iteration was cut off."""
    scenario = SCENARIOS["large_no_limit"]
    C = dcm_from_quaternion(scenario.quaternion)
    worst = [
        solve(scenario.time, C, RIGS["vertical-4"], "alm", AlmOptions(max_iterations=cap, mode=mode)).matrix_error.max()
        for cap in (3, 8, 30)
    ]
    assert worst[0] > 10.0 * worst[1]
    assert worst[1] > 2.0 * worst[2]


def test_open_loop_says_which_limit_left_the_attitude_behind() -> None:
    scenario = SCENARIOS["over_limit_loop"]
    C = dcm_from_quaternion(scenario.quaternion)
    solution = solve(scenario.time, C, RIGS["vertical-limited"], "alm", AlmOptions(mode=Mode.OPEN_LOOP))
    first = int(np.flatnonzero(solution.limited)[0])
    missed = solution.error[first:] > EXACT_WITHIN
    assert (solution.limited[first:][missed] != EXACT).all()
    linearised = [failure for failure in failures(solution) if failure.reason == "linearised step"]
    assert all(failure.samples <= first and failure.max_error < 0.1 * DEG for failure in linearised)


@pytest.mark.parametrize(
    "bad",
    [{"mode": "sideways"}, {"penalty": 0.0}, {"growth": 0.5}, {"residual": np.nan}, {"max_iterations": 0}],
)
def test_bad_options(bad: dict[str, object]) -> None:
    with pytest.raises(MethodError, match=next(iter(bad))):
        AlmOptions(**bad)  # type: ignore[arg-type]


def test_three_axis_rigs_are_refused() -> None:
    with pytest.raises(MethodError, match="fourth axis"):
        solve([0.0], np.eye(3)[None], RIGS["vertical-3"], "alm")
