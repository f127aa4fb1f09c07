"""`preview`: never outside the limits, exact where it says so, whatever it is told and however late."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.errors import MethodError
from fullpose.preview.flight import PreviewFlight
from fullpose.preview.options import PreviewOptions
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.scenarios import DEG, SCENARIOS
from fullpose.solve import solve
from tests.support.previews import EXACT_WITHIN, HORIZONTAL, LIMITED, RIGS, check, fast, flight


@pytest.mark.parametrize("rig", [LIMITED, HORIZONTAL], ids=["vertical", "horizontal"])
@pytest.mark.parametrize("preview_s", [0.0, 0.5])
def test_limits_are_kept_and_unlimited_samples_are_exact(rig, preview_s) -> None:
    limited = 0
    for seed in range(2):
        time, attitude = flight(seed, 3.0, 180.0)  # faster than the rig can follow throughout
        solution = solve(time, attitude, rig, "preview", options=fast(preview_s=preview_s))
        check(rig, time, attitude, solution.angles, solution.limited)
        limited += solution.limited_samples
    assert limited > 0


def test_it_flies_more_than_exact_and_more_with_preview() -> None:
    flown = {"exact": 0, 0.0: 0, 1.0: 0}
    for seed in (12, 16, 24, 28):  # where a step that looks at an instant alone loses the attitude
        time, attitude = flight(seed, 4.0, 70.0)
        flown["exact"] += solve(time, attitude, LIMITED, "exact").limited_samples == 0
        for preview_s in (0.0, 1.0):
            solution = solve(time, attitude, LIMITED, "preview", options=PreviewOptions(preview_s=preview_s))
            flown[preview_s] += solution.limited_samples == 0
    assert flown["exact"] == 0
    assert flown[0.0] == 3
    assert flown[1.0] == 4


def test_exactness_lost_is_regained() -> None:
    # Two seconds of a body rate beyond the rig's, then rest.
    time = np.arange(0.0, 6.0, 0.01)
    angle = np.where(time < 2.0, 0.5 * 6.0 * time**2, 12.0 + 12.0 * (time - 2.0))
    angle = np.where(time > 2.5, 18.0, angle)
    axis = np.array([0.3, 0.8, 0.52]) / np.linalg.norm([0.3, 0.8, 0.52])
    half = 0.5 * angle[:, None]
    attitude = dcm_from_quaternion(np.hstack([np.cos(half), np.sin(half) * axis]))
    solution = solve(time, attitude, LIMITED, "preview", options=fast())
    check(LIMITED, time, attitude, solution.angles, solution.limited)
    assert solution.limited_samples > 0
    assert solution.limited[-1] == EXACT
    assert solution.error[-1] < EXACT_WITHIN
    assert solution.blocking is not None


def test_the_same_flight_twice_gives_the_same_angles() -> None:
    time, attitude = flight(3, 2.0, 90.0)
    first, second = (solve(time, attitude, LIMITED, "preview", options=fast(preview_s=0.3)) for _ in range(2))
    assert np.array_equal(first.angles, second.angles)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_short_flights(count) -> None:
    time, attitude = flight(1, 1.0, 60.0)
    solution = solve(time[:count], attitude[:count], LIMITED, "preview", options=fast(preview_s=1.0))
    check(LIMITED, time[:count], attitude[:count], solution.angles, solution.limited)
    assert solution.limited_samples == 0


@pytest.mark.parametrize("name", ["level", "loop", "singular_start", "non_uniform", "over_limit"])
def test_scenarios_stay_inside_the_limits(name) -> None:
    scenario = SCENARIOS[name]
    part = slice(0, min(len(scenario.time), 4000), 10)
    time, attitude = scenario.time[part], dcm_from_quaternion(scenario.quaternion)[part]
    rig = RIGS[scenario.rig]
    start = None if scenario.start is None else np.array(scenario.start)
    solution = solve(time, attitude, rig, "preview", options=fast(), start=start)
    check(rig, time, attitude, solution.angles, solution.limited)


def test_a_rig_without_limits_and_a_level_flight_at_rest() -> None:
    rig = Rig("open", Geometry.VERTICAL_4)
    time, attitude = flight(4, 2.0, 90.0)
    assert solve(time, attitude, rig, "preview", options=fast()).limited_samples == 0
    still = np.tile(np.eye(3), (len(time), 1, 1))
    solution = solve(time, still, LIMITED, "preview", options=fast())
    check(LIMITED, time, still, solution.angles, solution.limited)
    assert solution.limited_samples == 0


def test_a_range_of_more_than_a_turn_is_not_left() -> None:
    base = FrameLimits(-540 * DEG, 540 * DEG, 200 * DEG, 500 * DEG)
    rig = replace(LIMITED, frames=(base, *LIMITED.frames[1:]))
    time, attitude = flight(2, 6.0, 60.0)
    solution = solve(time, attitude, rig, "preview", options=fast())
    check(rig, time, attitude, solution.angles, solution.limited)


@pytest.mark.parametrize("delay_s", [0.03, 0.2])
def test_late_ways_keep_the_limits(delay_s) -> None:
    time, attitude = flight(5, 5.0, 90.0)
    solution = solve(time, attitude, LIMITED, "preview", options=fast(delay_s=delay_s, preview_s=0.5))
    check(LIMITED, time, attitude, solution.angles, solution.limited)


def test_blocks_of_any_size_fly_the_same() -> None:
    time, attitude = flight(6, 1.5, 90.0)
    whole = PreviewFlight(LIMITED, fast(preview_s=0.4), np.zeros(4), time, attitude).block(time, attitude)
    single = PreviewFlight(LIMITED, fast(preview_s=0.4), np.zeros(4), time, attitude)
    angles = np.vstack([single.block(time[k : k + 1], attitude[k : k + 1]).angles for k in range(len(time))])
    assert np.array_equal(whole.angles, angles)


def test_a_free_start_looks_ahead() -> None:
    """From home these flights lose the attitude in their first seconds; the start may be chosen, so they need not."""
    for seed in (14, 15):
        time, attitude = flight(seed, 2.5, 110.0)
        options = fast(preview_s=1.0)
        assert solve(time, attitude, LIMITED, "preview", options=options, start=LIMITED.home).limited_samples > 0
        assert solve(time, attitude, LIMITED, "preview", options=options).limited_samples == 0


def test_rigs_and_options_that_do_not_go() -> None:
    time, attitude = flight(0, 0.1, 10.0)
    with pytest.raises(MethodError, match="fourth axis"):
        solve(time, attitude, RIGS["vertical-3"], "preview")
    with pytest.raises(MethodError, match="PreviewOptions"):
        solve(time, attitude, LIMITED, "preview", options=3)
