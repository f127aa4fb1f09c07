"""A number that was written in degrees comes back as it was written."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose.rig import builtin_rigs
from fullpose_server.formats.degrees import written_degrees


@given(st.decimals(min_value=-100_000, max_value=100_000, places=6))
def test_every_number_of_six_places(number: object) -> None:
    value = float(number)  # type: ignore[arg-type]
    assert written_degrees(math.radians(value)) == value


@given(st.floats(min_value=-1e6, max_value=1e6))
def test_any_number_of_radians_is_read_back(radians: float) -> None:
    assert math.radians(written_degrees(radians)) == pytest.approx(radians, rel=3e-16)


def test_what_is_not_there_stays_so() -> None:
    assert written_degrees(math.inf) == math.inf
    assert written_degrees(-math.inf) == -math.inf


def test_the_built_in_rigs_are_in_whole_degrees() -> None:
    for rig in builtin_rigs().values():
        for frame in rig.frames:
            for value in (frame.min, frame.max, frame.max_rate, frame.max_acceleration, frame.home):
                shown = written_degrees(value)
                assert math.isinf(shown) or shown == round(shown), (rig.name, shown)
