"""The mark of a limited sample and back."""

import pytest

from fullpose.bounds import EXACT, limited_code, limited_name
from fullpose.rig import FRAMES, LIMITS


def test_every_mark_names_its_frame_and_limit() -> None:
    codes = {limited_code(frame, limit): (FRAMES[frame], LIMITS[limit]) for frame in range(4) for limit in range(4)}
    assert sorted(codes) == list(range(1, 17))
    assert [limited_code(frame, limit) for frame in range(4) for limit in range(3)] == list(range(1, 13))  # as ever
    for code, name in codes.items():
        assert limited_name(code) == name
    assert limited_name(EXACT) is None


def test_no_mark_beyond_the_last() -> None:
    with pytest.raises(IndexError):
        limited_name(17)
