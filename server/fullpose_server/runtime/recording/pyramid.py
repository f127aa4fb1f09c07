"""Least and greatest values of long columns, one level above another: any stretch is drawn at any width at once.

A bucket of the first level is of `FIRST` rows, one of the next of `FACTOR` of those, and so on; the last bucket of a
level has what is left. Not-a-number counts as no value. Written as rows come, read by mapping: neither takes memory.
"""

from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array

FIRST = 16
FACTOR = 8
_LOOKED_AT = 8  # buckets at most that one of an answer is made of


class Buckets(NamedTuple):
    """Stretches of rows with what is in them."""

    edges: NDArray[np.int64]  # (b + 1,) row numbers: bucket k is of the rows from edges[k] up to before edges[k + 1]
    least: Array  # (b, c), nan where no row has a value
    greatest: Array  # (b, c)


class _Level:
    """One level while it is written: what has not filled a bucket yet waits."""

    def __init__(self, path: Path, size: int, columns: int) -> None:
        self.file: BinaryIO = path.open("wb")
        self._size = size  # entries of the level below that make a bucket
        self._waiting = np.empty((0, 2, columns))

    def add(self, entries: Array) -> Array:
        """Entries (m, 2, c) of the level below; returns the buckets that are full now."""
        waiting = np.concatenate([self._waiting, entries])
        full = len(waiting) // self._size * self._size
        self._waiting = waiting[full:]
        return self._write(waiting[:full].reshape(-1, self._size, *waiting.shape[1:]))

    def rest(self) -> Array:
        """The last bucket, (1, 2, c), where there is one."""
        left = self._waiting
        return self._write(left[None] if len(left) else left.reshape(0, 1, *left.shape[1:]))

    def _write(self, groups: Array) -> Array:
        made = np.stack([np.fmin.reduce(groups[:, :, 0], axis=1), np.fmax.reduce(groups[:, :, 1], axis=1)], axis=1)
        self.file.write(np.ascontiguousarray(made, "<f8").tobytes())
        return np.asarray(made)


class PyramidWriter:
    """Writes the levels of `columns` columns into a folder, whatever number of rows comes."""

    def __init__(self, folder: Path, columns: int) -> None:
        self._folder = folder
        self._columns = columns
        self._levels: list[_Level] = []
        self.rows = 0

    def add(self, rows: Array) -> None:
        """Add rows (m, c)."""
        self.rows += len(rows)
        entries = np.repeat(rows[:, None, :], 2, axis=1)
        self._pass(entries, 0)

    def finish(self) -> None:
        """Write what waits."""
        number = 0
        while number < len(self._levels):  # what is left of one may begin another
            rest = self._levels[number].rest()
            if self.rows > FIRST * FACTOR**number:  # above a level of one bucket there is none
                self._pass(rest, number + 1)
            self._levels[number].file.close()
            number += 1

    def close(self) -> None:
        """Close what is open: it comes to nothing."""
        for level in self._levels:
            level.file.close()

    def _pass(self, entries: Array, number: int) -> None:
        """Entries for a level, and what becomes of them for those above."""
        while len(entries):
            if number == len(self._levels):
                size = FACTOR if number else FIRST
                self._levels.append(_Level(_file(self._folder, number), size, self._columns))
            entries = self._levels[number].add(entries)
            number += 1


class Pyramid:
    """What `PyramidWriter` wrote of `rows` rows of `columns` columns. Raises `OSError` or `ValueError` where it is
    damaged."""

    def __init__(self, folder: Path, rows: int, columns: int) -> None:
        self.rows = rows
        self._levels: list[Array] = []
        size = FIRST
        while rows:
            entries = -(-rows // size)
            shape = (entries, 2, columns)
            self._levels.append(np.memmap(_file(folder, len(self._levels)), "<f8", "r", shape=shape))
            if entries == 1:
                break
            size *= FACTOR

    @property
    def sizes(self) -> list[int]:
        """Rows of a bucket, by level."""
        return [FIRST * FACTOR**number for number in range(len(self._levels))]

    def level(self, number: int) -> Array:
        """All buckets of one level, (b, 2, c): least and greatest."""
        return self._levels[number]

    def buckets(self, first: int, last: int, most: int) -> Buckets:
        """At most `most` buckets of the rows from `first` up to before `last`, and of a few before and after.

        The ends are those of buckets of a level: the answer is exact for the rows that it names.
        """
        first, last = max(0, first), min(last, self.rows)
        if first >= last:
            empty = np.empty((0, self._levels[0].shape[2] if self._levels else 0))
            return Buckets(np.zeros(1, np.int64), empty, empty)
        fitting = (n for n, size in enumerate(self.sizes) if (last - first) // size + 2 <= _LOOKED_AT * most)
        number = next(fitting, len(self._levels) - 1)
        size = self.sizes[number]
        begin, end = first // size, -(-last // size)
        group = -(-(end - begin) // most)
        starts = np.arange(begin, end, group)
        entries = np.asarray(self._levels[number][begin:end])
        least = np.fmin.reduceat(entries[:, 0], starts - begin, axis=0)
        greatest = np.fmax.reduceat(entries[:, 1], starts - begin, axis=0)
        return Buckets(np.minimum(np.append(starts, end) * size, self.rows).astype(np.int64), least, greatest)


def _file(folder: Path, number: int) -> Path:
    return folder / f"level{number}.f8"
