"""Times of a flight: what is refused, where, and how numbers are shown."""

import numpy as np
import pytest

from fullpose.flight import bad_time, shortest


@pytest.mark.parametrize(
    ("time", "row", "told"),
    [
        ([0.0, np.nan], 1, "finite"),
        ([np.inf, 0.0], 0, "finite"),
        ([0.1, 0.1], 1, "after 0.1, this one is there twice"),
        ([0.1, 0.2, 0.15], 2, "after 0.2, time must not go backward"),
        ([0.0, 1e-300], 1, "at least 1e-07 s after 0"),
        ([-1e308, 1.5e308], 0, "between -1e+10 and 1e+10"),  # their difference is not finite
        ([0.0, 1e11], 1, "between -1e+10 and 1e+10"),
    ],
)
def test_what_is_no_time(time: list[float], row: int, told: str) -> None:
    found = bad_time(np.array(time))
    assert found is not None
    assert found[0] == row
    assert told in found[1]


def test_seconds_since_1970_at_any_usual_rate_are_times() -> None:
    assert bad_time(1.8e9 + np.arange(100) / 10_000.0) is None
    assert bad_time(np.array([-5.0])) is None


def test_the_part_before_counts() -> None:
    assert bad_time(np.array([1.0, 2.0]), 0.5) is None
    assert bad_time(np.array([1.0, 2.0]), 1.0) == (0, "a time after 1, this one is there twice")
    assert bad_time(np.array([1.0, 0.5]), 0.0) == (1, "a time after 1, time must not go backward")


@pytest.mark.parametrize(("value", "text"), [(0.05, "0.05"), (3.0, "3"), (1e18, "1e+18"), (np.float64(0.1), "0.1")])
def test_numbers_are_shown_as_they_were_written(value: float, text: str) -> None:
    assert shortest(value) == text
