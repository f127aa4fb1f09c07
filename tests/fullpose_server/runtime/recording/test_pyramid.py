"""What a pyramid says of any stretch is what every row of it says, one by one."""

import math
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fullpose_server.runtime.recording.pyramid import FACTOR, FIRST, Pyramid, PyramidWriter

values = st.floats(-1e9, 1e9) | st.just(math.nan)


def slowly(rows: list[list[float]], first: int, last: int, column: int) -> tuple[float, float]:
    """Least and greatest of the rows that have a value, by looking at each."""
    seen = [row[column] for row in rows[first:last] if not math.isnan(row[column])]
    return (min(seen), max(seen)) if seen else (math.nan, math.nan)


def made(folder: Path, rows: list[list[float]], batches: list[int]) -> Pyramid:
    writer = PyramidWriter(folder, 2)
    at = 0
    for batch in [*batches, len(rows)]:
        writer.add(np.array(rows[at : at + batch], float).reshape(-1, 2))
        at += batch
    writer.finish()
    assert writer.rows == len(rows)
    return Pyramid(folder, len(rows), 2)


@st.composite
def columns(draw: st.DrawFn) -> list[list[float]]:
    """Rows of two columns, of any length up to three levels; few of them are drawn, the others are repeated."""
    size = draw(st.sampled_from([0, 1, FIRST, FIRST * FACTOR, FIRST * FACTOR**2]) | st.integers(0, 1300))
    near = max(0, size + draw(st.integers(-2, 2)))
    few = draw(st.lists(st.tuples(values, values), min_size=1, max_size=23))
    return [list(few[(k * k + k) % len(few)]) for k in range(near)]


@given(columns(), st.lists(st.integers(0, 700), max_size=5))
def test_every_bucket_of_every_level_has_the_extremes_of_its_rows(rows: list[list[float]], batches: list[int]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        pyramid = made(Path(folder), rows, batches)
        for number, size in enumerate(pyramid.sizes):
            level = pyramid.level(number)
            assert len(level) == math.ceil(len(rows) / size)
            for k in range(len(level)):
                for column in range(2):
                    expected = slowly(rows, k * size, (k + 1) * size, column)
                    np.testing.assert_array_equal(level[k, :, column], expected)
        assert not rows or len(pyramid.level(len(pyramid.sizes) - 1)) == 1


@given(columns(), st.integers(-5, 2600), st.integers(-5, 2600), st.integers(1, 60))
def test_any_window_at_any_width_is_what_its_rows_are(
    rows: list[list[float]], first: int, last: int, width: int
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        pyramid = made(Path(folder), rows, [97])
        found = pyramid.buckets(first, last, width)
    edges = found.edges.tolist()
    wanted = range(max(0, first), min(last, len(rows)))
    if not wanted:
        assert len(found.least) == 0
        return
    assert len(found.least) == len(edges) - 1 <= width
    assert edges == sorted(set(edges))  # every bucket has rows, and none is in two
    assert edges[0] <= wanted[0]
    assert edges[-1] >= wanted[-1] + 1
    assert edges[-1] <= len(rows)
    for k, (begin, end) in enumerate(pairwise(edges)):
        for column in range(2):
            assert slowly(rows, begin, end, column) == pytest.approx(
                (found.least[k, column], found.greatest[k, column]), abs=0, rel=0, nan_ok=True
            )


@given(st.integers(1, 2500), st.integers(4, 60), st.data())
def test_no_bucket_is_wider_than_what_is_asked_for_needs(rows: int, width: int, data: st.DataObject) -> None:
    """The drawing is as fine as the width allows: at least an eighth of the buckets, or the finest there are."""
    first = data.draw(st.integers(0, rows - 1))
    last = data.draw(st.integers(first + 1, rows))
    with tempfile.TemporaryDirectory() as folder:
        pyramid = made(Path(folder), [[float(k), 0.0] for k in range(rows)], [])
        edges = pyramid.buckets(first, last, width).edges
    widest = int(np.diff(edges).max())
    assert widest <= max(FIRST, 2 * FIRST * math.ceil((last - first) / width / FIRST + 1))


def test_a_level_that_is_cut_off_is_noticed(tmp_path: Path) -> None:
    made(tmp_path, [[float(k), 0.0] for k in range(500)], [])
    file = tmp_path / "level0.f8"
    file.write_bytes(file.read_bytes()[:-8])
    with pytest.raises(ValueError, match="mmap"):
        Pyramid(tmp_path, 500, 2)
