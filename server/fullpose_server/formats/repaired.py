"""What is mended on request, or so that nothing is lost: stamps that are there twice, turns between sparse samples."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.flight import shortest
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.column_map import AngleUnit, EulerMap
from fullpose_server.formats.importers.table import Table

FINEST_STEP_DEG = 45.0  # between samples where turns are counted: the shorter way round is the one that is meant
TURN_DEG = 360.0
MOST_ADDED = 10_000_000

Loaded = dict[str, Array | Integers]


def without_duplicates(table: Table, loaded: Loaded, stamp: str) -> tuple[Table, Loaded, list[Caution]]:
    """The table without the samples whose stamp is that of the one before, and what is to be said of it."""
    time = loaded[stamp]
    kept = np.concatenate([[True], time[1:] != time[:-1]])
    if kept.all():
        return table, loaded, []
    rows = np.flatnonzero(kept)
    first = int(np.argmin(kept))
    line, count = table.line_of(first), int(time.size - rows.size)
    value = shortest(float(time[first]))
    text = (
        f"{table.row_word} {line}, column {stamp}: {value}: {count} samples with the stamp of the one before left out"
    )
    said = [Caution("duplicates", text, stamp, line, value)]
    of_kept = replace(table, line_of=lambda row: table.line_of(int(rows[row])))
    return of_kept, {name: column[kept] for name, column in loaded.items()}, said


def with_samples_between(
    table: Table, time: Array, loaded: Mapping[str, Array | Integers], how: EulerMap
) -> tuple[Array, Loaded, list[Caution]]:
    """time (n,) and columns with samples between those that are far apart in a column that counts its turns.

    A column that leaves one full turn is unwrapped: 192 deg from one sample to the next are 192 deg, and not 168 the
    other way round. Samples between, linear in the angles, keep them.
    """
    degree = {AngleUnit.DEG: 1.0, AngleUnit.RAD: np.pi / 180.0, AngleUnit.CENTIDEG: 100.0}[how.unit]
    steps = np.zeros(time.size - 1)
    counted: list[tuple[str, Array]] = []
    for name in how.columns:
        column = np.asarray(loaded[name], float) / degree
        step = np.abs(np.diff(column))
        if (
            np.ptp(column) > TURN_DEG + 1.0
            and step.size
            and 2.0 * FINEST_STEP_DEG < step.max() < 1e4
            and not _jumps(step)
        ):
            steps = np.maximum(steps, step)
            counted.append((name, step))
    if not counted or steps.max() <= 2.0 * FINEST_STEP_DEG:
        return time, dict(loaded), []
    parts = np.maximum(1, np.ceil(steps / FINEST_STEP_DEG)).astype(np.int64)
    added = int(parts.sum() - parts.size)
    if added > MOST_ADDED:
        return time, dict(loaded), []
    index = np.concatenate([[0.0], *_fractions(parts)])
    at = np.arange(time.size, dtype=float)
    columns: Loaded = {}
    for name, given in loaded.items():
        column = np.asarray(given, float)
        if name in how.columns and all(name != each for each, _ in counted):  # 359 and 1: by 0, not by 180
            column = np.unwrap(column, period=TURN_DEG * degree)
        columns[name] = np.interp(index, at, column)
    name, step = max(counted, key=lambda pair: float(pair[1].max()))
    row = int(np.argmax(step > 2.0 * FINEST_STEP_DEG))
    line = table.line_of(row + 1)
    text = (
        f"{table.row_word} {line}, column {name}: a step of {step[row]:.4g} deg in a column that counts its turns: "
        f"flown as that, with {added} samples between"
    )
    return np.interp(index, at, time), columns, [Caution("turns", text, name, line, f"{step[row]:.4g} deg")]


def _fractions(parts: Integers) -> list[Array]:
    """The places of the samples after each, in units of rows."""
    return [row + np.arange(1, count + 1) / count for row, count in enumerate(parts.tolist())]


def _jumps(step: Array) -> bool:
    """Whether a column wraps: some of its steps are almost a full turn, and those next to them are small."""
    near = np.abs(step - TURN_DEG * np.round(step / TURN_DEG))
    large = step > 2.0 * FINEST_STEP_DEG
    if (large[1:] & large[:-1]).any():  # 330 from each sample to the next are 330
        return False
    return bool(large.any() and (np.round(step[large] / TURN_DEG) >= 1).all() and near[large].max() < FINEST_STEP_DEG)
