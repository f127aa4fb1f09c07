"""The figures of a comparison."""

from collections.abc import Iterator

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import limited_code
from fullpose.compare import EXACT_WITHIN, compare, failures, figures
from fullpose.errors import CancelledError, InputError, MethodError
from fullpose.registry import variant
from fullpose.rig import FRAMES, builtin_rigs
from fullpose.scenarios import SCENARIOS
from fullpose.solution import Solution
from fullpose.verify import verify

RIGS = builtin_rigs()


def solution(angles: np.ndarray, error: np.ndarray, limited: np.ndarray, rig: str = "vertical-4") -> Solution:
    n = len(angles)
    return Solution(
        method="exact",
        rig=RIGS[rig],
        time=np.arange(n) / 100.0,
        angles=angles,
        error=error,
        matrix_error=error.copy(),
        limited=limited.astype(np.int16),
        iterations=np.ones(n, np.int32),
        step_time=np.full(n, np.nan),
        solve_time=np.nan,
    )


def test_figures_are_those_of_the_arrays() -> None:
    angles = np.zeros((5, 4))
    angles[:, 0] = [0.0, 0.01, 0.03, 0.02, 0.02]
    angles[:, 3] = [0.0, 0.3, 0.0, 0.0, 0.0]  # 30 rad/s at 100 Hz: beyond 600 deg/s, and 4000 deg/s^2
    error = np.array([0.0, 3e-4, 4e-4, 0.0, 0.0])
    s = solution(angles, error, np.zeros(5))
    got = figures(s, verify(s.time, angles, s.rig))
    assert got.exact_share == 0.6
    assert got.max_error == 4e-4
    assert got.rms_error == pytest.approx(5e-4 / np.sqrt(5.0))
    np.testing.assert_allclose(got.total_variation, [0.04, 0.0, 0.0, 0.6])
    np.testing.assert_allclose(got.peaks[0], [0.03, 2.0, 300.0, 4e4])
    inner = FRAMES.index("inner")
    assert got.violations[inner].tolist() == [0, 2, 2, 0]
    assert got.violations[[1, 2]].sum() == 0


def test_every_missed_sample_has_one_reason() -> None:
    angles = np.zeros((6, 4))
    angles[3, 2] = np.pi / 2  # outer 0, middle 90 deg: the singularity
    error = np.array([0.0, 1.0, 2.0, 3.0, 1e-3, EXACT_WITHIN])
    limited = np.array([limited_code(3, 0), limited_code(3, 0), limited_code(0, 1), 0, 0, 0])
    got = {failure.reason: failure for failure in failures(solution(angles, error, limited))}
    assert {reason: failure.samples for reason, failure in got.items()} == {
        "position limit of the inner frame": 1,  # the first sample is marked but exact
        "rate limit of the base frame": 1,
        "singularity": 1,
        "linearised step": 1,
    }
    assert got["singularity"].first == pytest.approx(0.03)
    assert got["linearised step"].max_error == 1e-3


def test_not_a_number_is_a_failure() -> None:
    error = np.array([0.0, np.nan])
    assert failures(solution(np.zeros((2, 4)), error, np.zeros(2)))[0].samples == 1


def ticks() -> Iterator[float]:
    now = 0.0
    while True:
        now += 0.5
        yield now


def test_methods_side_by_side() -> None:
    scenario = SCENARIOS["over_limit"]
    time, C = scenario.time[:400], dcm_from_quaternion(scenario.quaternion[:400])
    seen: list[str] = []
    clock = ticks()
    rows = compare(
        time,
        C,
        RIGS["vertical-limited"],
        ["exact", "lagrange", "three_axis"],
        clock=lambda: next(clock),
        progress=lambda method, *_: seen.append(method),
    )
    assert [row.variant.method for row in rows] == ["exact", "lagrange", "three_axis"]
    assert list(dict.fromkeys(seen)) == ["exact", "lagrange", "three_axis"]
    exact, lagrange, three_axis = (row.figures for row in rows)
    assert exact is not None
    assert lagrange is not None
    assert three_axis is not None
    assert exact.exact_share == three_axis.exact_share == 1.0
    assert lagrange.exact_share < 0.1
    assert lagrange.failures[0].reason == "linearised step"
    assert rows[0].solution is not None
    assert rows[0].solution.solve_time > 0.0


def test_a_method_that_does_not_apply_says_so() -> None:
    scenario = SCENARIOS["two_samples"]
    rows = compare(scenario.time, dcm_from_quaternion(scenario.quaternion), RIGS["vertical-3"], ["dwln", "three_axis"])
    assert rows[0].figures is None
    assert "fourth axis" in str(rows[0].refusal)
    assert rows[1].figures is not None


def test_variants_of_one_method_side_by_side() -> None:
    scenario = SCENARIOS["small_angles"]
    time, C = scenario.time[:200], dcm_from_quaternion(scenario.quaternion[:200])
    seen: list[str] = []
    asked = ["alm:mode=open_loop", "alm", variant("alm", {"mode": "open_loop", "growth": 4.0}, "steep"), "exact"]
    rows = compare(time, C, RIGS["vertical-4"], asked, progress=lambda label, *_: seen.append(label))
    labels = ["alm:mode=open_loop", "alm", "steep", "exact"]
    assert [row.variant.label for row in rows] == list(dict.fromkeys(seen)) == labels
    assert [row.variant.method for row in rows] == ["alm"] * 3 + ["exact"]
    open_loop, closed_loop, steep, exact = (row.figures for row in rows)
    assert open_loop is not None
    assert closed_loop is not None
    assert steep is not None
    assert exact is not None
    assert exact.exact_share == 1.0
    assert closed_loop.max_error < 0.1 * open_loop.max_error
    assert closed_loop.max_error > 1e6 * exact.max_error  # the paper's own step, not our curve in its place
    assert open_loop.exact_share < 0.5
    assert steep.exact_share < 0.5


def test_each_row_has_a_label_of_its_own() -> None:
    scenario = SCENARIOS["two_samples"]
    C = dcm_from_quaternion(scenario.quaternion)
    for asked in (
        ["exact", "exact"],
        ["alm:growth=4", variant("alm", {"growth": 4.0})],
        ["exact", variant("alm", {}, "exact")],
    ):
        with pytest.raises(MethodError, match="label of its own"):
            compare(scenario.time, C, RIGS["vertical-4"], asked)


def test_refuses() -> None:
    scenario = SCENARIOS["two_samples"]
    C = dcm_from_quaternion(scenario.quaternion)
    with pytest.raises(MethodError, match="magic"):
        compare(scenario.time, C, RIGS["vertical-4"], ["exact", "magic"])
    with pytest.raises(MethodError, match="at least one"):
        compare(scenario.time, C, RIGS["vertical-4"], [])
    with pytest.raises(InputError):
        compare(scenario.time[::-1], C, RIGS["vertical-4"], ["exact"])


def test_can_be_cancelled() -> None:
    def stop(method: str, done: int, total: int) -> None:
        raise CancelledError("enough")

    scenario = SCENARIOS["two_samples"]
    with pytest.raises(CancelledError):
        compare(scenario.time, dcm_from_quaternion(scenario.quaternion), RIGS["vertical-4"], ["exact"], progress=stop)
