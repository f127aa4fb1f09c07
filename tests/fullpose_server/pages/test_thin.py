"""Thinning keeps the ends and every column's peaks."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.pages.thin import thin


def test_short_arrays_are_kept_whole() -> None:
    np.testing.assert_array_equal(thin(5, 10, np.zeros(5)), np.arange(5))


@given(n=st.integers(100, 5000), points=st.integers(40, 99), seed=st.integers(0, 1000))
def test_ends_and_peaks_are_kept_and_the_number_is_bounded(n: int, points: int, seed: int) -> None:
    table = np.random.default_rng(seed).normal(size=(n, 3))
    table[n // 2, 1] = np.nan
    rows = thin(n, points, table)
    assert rows[0] == 0
    assert rows[-1] == n - 1
    assert (np.diff(rows) > 0).all()
    assert len(rows) <= points + 7
    for column in table.T:
        assert np.nanmax(column) in column[rows]
        assert np.nanmin(column) in column[rows]
