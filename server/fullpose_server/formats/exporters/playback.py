"""As a table plays it: little-endian doubles without a header, thirteen a row.

time [s] from the first row; then of base, outer, middle and inner each the position [deg], the rate [deg/s] and the
acceleration [deg/s^2]. A row is 104 bytes: in C `double row[13]`, in MATLAB `fread(file, [13 inf], 'double')'`, in
NumPy `np.fromfile(file, '<f8').reshape(-1, 13)`.
"""

from pathlib import Path

import numpy as np

from fullpose._typing import Array
from fullpose_server.errors import FileError
from fullpose_server.formats.exporters.table import ExportTable

NUMBERS = 13  # of a row
_BLOCK = 65536


def write(table: ExportTable, target: Path) -> None:
    """Write it. Raises `FileError` where a table could not play it."""
    motion = table.motion()
    values = (motion.position, motion.rate, motion.acceleration)
    bad = np.zeros(len(motion.time), bool)
    for each in values:
        bad |= ~np.isfinite(each).all(axis=1)
    if not len(motion.time) or bad.any():
        row = int(np.argmax(bad)) + 1 if len(bad) else None
        raise FileError(
            table.name, "a command of every frame in every row: a table cannot play it", line=row, unit="row"
        )
    with target.open("wb") as stream:
        for begin in range(0, len(motion.time), _BLOCK):
            part = slice(begin, begin + _BLOCK)
            stream.write(_rows(motion.time[part] - motion.time[0], *(each[part] for each in values)).tobytes())


def _rows(time: Array, position: Array, rate: Array, acceleration: Array) -> Array:
    """(n, 13), frame by frame."""
    rows = np.empty((len(time), NUMBERS), "<f8")
    rows[:, 0] = time
    for index, values in enumerate((position, rate, acceleration)):
        rows[:, 1 + index :: 3] = values
    return rows
