"""`solve`: one clear error for what is no flight, the caller's clock and progress, errors of its own reckoning."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler
from fullpose.errors import CancelledError, InputError, MethodError
from fullpose.methods.alm import AlmOptions
from fullpose.rig import builtin_rigs
from fullpose.solve import BLOCK, solve, solve_flight

RIGS = builtin_rigs()
RIG = RIGS["vertical-4"]
TIME = np.arange(0.0, 0.1, 1e-3)
C = dcm_from_euler(TIME, 0.5 * TIME, 0.1 * TIME)


@pytest.mark.parametrize("method", ["plan", "exact", "three_axis"])
@pytest.mark.parametrize("samples", [1, 2, 15, 16, 17])
def test_flights_of_any_length(method: str, samples: int) -> None:
    solution = solve(TIME[:samples], C[:samples], RIGS["vertical-3"] if method == "three_axis" else RIG, method)
    assert solution.angles.shape == (samples, 4)
    assert solution.matrix_error.max() <= 1e-14
    assert solution.iterations.shape == solution.limited.shape == solution.step_time.shape == (samples,)
    assert np.isnan(solution.step_time).all()
    assert np.isnan(solution.solve_time)


def with_(array: np.ndarray, index: object, value: float) -> np.ndarray:
    out = array.copy()
    out[index] = value  # type: ignore[call-overload]
    return out


@pytest.mark.parametrize(
    ("time", "attitude", "name", "sample"),
    [
        ([], np.empty((0, 3, 3)), "time", None),
        (TIME[:, None], C, "time", None),
        (TIME[:-1], C, "attitude", None),
        (with_(TIME, 5, np.nan), C, "time", 5),
        (with_(TIME, 5, np.inf), C, "time", 5),
        (with_(TIME, 5, TIME[4]), C, "time", 5),
        (with_(TIME, 5, -1.0), C, "time", 5),
        (with_(TIME, 5, TIME[4] + 1e-12), C, "time", 5),
        (with_(TIME, 0, -1e308), C, "time", 0),
        (TIME, with_(C, (7, 1, 2), np.nan), "attitude", 7),
        (TIME, with_(C, (7, 1, 2), 0.5), "attitude", 7),
        (TIME, -C, "attitude", 0),
        (TIME, 0.0 * C, "attitude", 0),
    ],
)
def test_what_is_no_flight_is_refused(time: object, attitude: np.ndarray, name: str, sample: int | None) -> None:
    with pytest.raises(InputError) as caught:
        solve(time, attitude, RIG, "exact")  # type: ignore[arg-type]
    assert (caught.value.name, caught.value.sample) == (name, sample)


@pytest.mark.parametrize("start", [[0.0, 0.0, 0.0], [0.0, np.nan, 0.0, 0.0], [0.0, 0.0, 0.0, 2.0]])
def test_what_is_no_start_is_refused(start: list[float]) -> None:
    with pytest.raises(InputError, match="start"):
        solve(TIME, C, RIGS["vertical-limited"], "exact", start=start)


def test_unknown_method_and_wrong_options() -> None:
    with pytest.raises(MethodError, match=r"'best'.*exact"):
        solve(TIME, C, RIG, "best")
    with pytest.raises(MethodError, match="ExactOptions"):
        solve(TIME, C, RIG, "exact", AlmOptions())


def test_timings_are_the_callers_clock() -> None:
    ticks = itertools.count()
    solution = solve(TIME, C, RIG, "exact", clock=lambda: float(next(ticks)))
    np.testing.assert_allclose(solution.step_time[:BLOCK], 1.0 / BLOCK)
    assert solution.solve_time == next(ticks) - 1


def test_progress_and_cancelling() -> None:
    seen: list[tuple[int, int]] = []
    solve(TIME, C, RIG, "exact", progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (100, 100)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})

    def stop(done: int, total: int) -> None:
        raise CancelledError("enough")

    with pytest.raises(CancelledError):
        solve(TIME, C, RIG, "exact", progress=stop)


def test_the_callers_arrays_are_left_alone_and_the_solutions_are_read_only() -> None:
    time, attitude = TIME.copy(), C.copy()
    solution = solve(time, attitude, RIG, "exact")
    time[0], attitude[0, 0, 0] = -1.0, 5.0  # still writable, and not shared
    assert solution.time[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        solution.angles[0, 0] = 1.0
    np.testing.assert_array_equal(attitude[1:], C[1:])


def test_start_chooses_the_pose_the_flight_starts_from() -> None:
    start = np.array([0.5, 0.0, -0.5, 2.0 * np.pi])
    np.testing.assert_allclose(solve(TIME, C, RIG, "exact", start=start).angles[0], start, atol=1e-14)
    np.testing.assert_allclose(solve(TIME, C, RIG, "exact").angles[0], 0.0, atol=1e-14)


def test_the_default_is_the_command_lines() -> None:
    assert solve(TIME, C, RIG).method == "plan"
    assert solve_flight(TIME, C, RIG).plan is not None
    assert solve_flight(TIME, C, RIG, "exact").plan is None


@pytest.mark.parametrize("method", ["exact", "dwln", "gradient_projection", "alm", "fixed_joint"])
def test_a_slow_flight_of_sparse_samples_is_flown_by_every_method(method: str) -> None:
    time = 5.0 * np.arange(20)
    angles = np.column_stack([40 + 0.3 * time, 10 * np.sin(0.03 * time), 20 * np.sin(0.03 * time)])
    attitude = Rotation.from_euler("YZX", angles, degrees=True).as_matrix().swapaxes(1, 2)
    solution = solve(time, attitude, builtin_rigs()["vertical-4"], method=method)
    assert solution.time.tolist() == time.tolist()
    assert np.degrees(solution.error.max()) < 1e-3
    assert not solution.limited_samples
    assert np.degrees(np.abs(np.diff(solution.angles, axis=0)).max() / 5.0) < 10.0
