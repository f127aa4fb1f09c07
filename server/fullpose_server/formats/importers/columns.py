"""Columns as every importer hands them over, and how many of them it may read."""

import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose_server.errors import FileError


@dataclass(frozen=True)
class Bounds:
    """How much of a table is read, what has more is refused before it is; and who is told how far that is."""

    rows: int
    columns: int
    bytes: int = sys.maxsize  # that a packed file may unpack to
    progress: Callable[[int, int], None] | None = None  # (done, of all) in whatever unit, for a person who waits


UNBOUNDED = Bounds(sys.maxsize, sys.maxsize)  # a person's own machine, a person's own file


class TooLargeError(FileError):
    """A file that has more in it than it may have."""


def check_columns(count: int, bounds: Bounds, file: str) -> None:
    """Raise `TooLargeError` where a table has too many columns."""
    if count > bounds.columns:
        raise TooLargeError(file, f"at most {bounds.columns} columns", value=f"{count} columns")


def check_rows(count: int, bounds: Bounds, file: str) -> None:
    """Raise `TooLargeError` where a table has too many rows, or has had already."""
    if count > bounds.rows:
        raise TooLargeError(file, f"at most {bounds.rows} rows", value=f"{count} rows or more")


class Filling:
    """Columns of doubles that are filled batch by batch; of so many rows where that is known before."""

    def __init__(self, names: tuple[str, ...], rows: int = 0) -> None:
        self._names = names
        self._table = np.empty((len(names), rows))  # a column is a row of it: in one piece
        self.rows = 0

    def add(self, batch: dict[str, Array]) -> None:
        """More rows."""
        more = len(batch[self._names[0]])
        if self.rows + more > self._table.shape[1]:
            grown = np.empty((len(self._names), max(self.rows + more, self._table.shape[1] * 3 // 2)))
            grown[:, : self.rows] = self._table[:, : self.rows]
            self._table = grown
        for row, name in enumerate(self._names):
            self._table[row, self.rows : self.rows + more] = batch[name]
        self.rows += more

    def columns(self) -> dict[str, Array]:
        """Each column, (n,)."""
        return {name: self._table[row, : self.rows] for row, name in enumerate(self._names)}
