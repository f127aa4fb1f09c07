"""From a table and its column map to a flight: stamps in seconds, attitudes as ours, each refusal with its place."""

from collections.abc import Mapping

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.attitude import (
    euler_from_ned,
    quaternion_from_enu,
    quaternion_from_euler,
    quaternion_from_ned,
    quaternion_from_rotations,
)
from fullpose.flight import bad_time, shortest
from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.column_map import AngleUnit, ColumnMap, Epoch, EulerMap, QuaternionMap, Sense, TimeMap
from fullpose_server.formats.gaps import LONG, holes
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.plausibility import Angles, angle_cautions, motion_cautions, time_cautions
from fullpose_server.formats.read_options import AS_IT_IS, ReadOptions
from fullpose_server.formats.repaired import with_samples_between, without_duplicates
from fullpose_server.formats.trajectory import Convention, Taken, Trajectory, continuous

ASKED_FOR = ("bridged", "duplicates")  # what a person has said is right
MOST_LISTED = 5
_BLOCK = 65536  # samples converted at once
_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])
_NAMED = {Convention.NUE: "YZX", Convention.NED: "ZYX"}  # the orders of yaw, pitch, roll and of heading, pitch, bank


def flight_of(table: Table, columns: ColumnMap, options: ReadOptions = AS_IT_IS) -> Trajectory:
    """The flight of a table, with its cautions; what was taken is told by its `statement`.

    Raises `FileError`: no rows, a value that is not finite, time not increasing or out of range, a quaternion that is
    none, a gap that is not to be bridged, any caution where `options` are strict; `TooLargeError` from the table.
    """
    loaded = dict(table.load(columns.columns))
    if not loaded[columns.time.column].size:
        raise FileError(table.file, "at least one row of samples after the header")
    _check_finite(table, loaded, columns)
    cautions = [each for each in table.cautions if each.column is None or each.column in columns.columns]
    if options.drop_duplicates:
        table, loaded, dropped = without_duplicates(table, loaded, columns.time.column)
        cautions += dropped
    time = stamps(loaded[columns.time.column], columns.time)
    if found := bad_time(time):
        row, expected = found
        keeps = ("drop_duplicates", "keeps the first") if "twice" in expected else None
        value = shortest(float(loaded[columns.time.column][row]))
        raise table.error(expected, columns.time.column, value, row, keeps)
    cautions += _checked_gaps(table, time, options)
    if columns.euler is not None:
        cautions += angle_cautions(angles_of(table, loaded, columns.euler))
        time, loaded, added = with_samples_between(table, time, loaded, columns.euler)
        cautions += added
    q, off = _attitudes(table, loaded, columns)
    if off > 1e-3:
        cautions.append(Caution("norm", f"quaternions are up to {off:.2g} off unit length; they were normalised"))
    q = continuous(q)
    turned = turn_deg(q)
    cautions += time_cautions(time, turned, columns.time)
    cautions += motion_cautions(time, turned, columns.attitude, table.line_of, table.row_word)
    if options.strict and (doubts := [each for each in cautions if each.code not in ASKED_FOR]):
        raise FileError(table.file, f"a flight without warnings, not: {doubts[0].message}", line=None)
    taken = Taken(table.format, "", table.name, statement(columns))
    return Trajectory(time, q, columns.axes, tuple(cautions), taken)


def turn_deg(q: Array) -> Array:
    """The angle (n - 1,) [deg] from each attitude of q (n, 4) to the next, the shorter way round."""
    cosine = np.clip(np.abs(np.einsum("ij,ij->i", q[1:], q[:-1])), 0.0, 1.0)
    return np.asarray(np.rad2deg(2.0 * np.arctan2(np.sqrt(1.0 - cosine * cosine), cosine)))


def angles_of(table: Table, loaded: Mapping[str, Array | Integers], how: EulerMap) -> Angles:
    """The columns of angles with their places in the file."""
    first, second, third = (np.asarray(loaded[name], float) for name in how.columns)
    return Angles(how, (first, second, third), table.line_of, table.row_word)


def _checked_gaps(table: Table, time: Array, options: ReadOptions) -> list[Caution]:
    """What is to be said of gaps. Raises `FileError` for a long one that is not to be bridged."""
    found = holes(time)
    long = [hole for hole in found if hole.steps >= LONG]
    if long and not options.bridge_gaps:
        more = f", {len(long)} such gaps" if len(long) > 1 else ""
        expected = f"samples all the way: none from {long[0]}{more}"
        raise table.error(expected, row=long[0].row, otherwise=("bridge_gaps", "interpolates"))
    listed = "; ".join(str(hole) for hole in found[:MOST_LISTED])
    if not found:
        return []
    count = "1 gap" if len(found) == 1 else f"{len(found)} gaps"
    code = "bridged" if long else "gap"
    return [
        Caution(code, f"{count} without samples, flown by interpolation: {listed}", row=table.line_of(found[0].row))
    ]


def stamps(given: Array | Integers, how: TimeMap) -> Array:
    """The stamps (n,) [s]. Whole numbers are counted from the first before they are made doubles."""
    if how.epoch is Epoch.FIRST:
        given = given - given[0]
    counted = np.array(given, dtype=np.float64)
    # Divided, not multiplied: 3 ms are 0.003 s to the last bit.
    return counted / how.unit.per_second if how.unit.per_second else counted * how.unit.seconds


def statement(columns: ColumnMap) -> str:
    """What was taken, in words."""
    clock = f"{columns.time.column} in {columns.time.unit}"
    if columns.time.epoch is Epoch.FIRST:
        clock += " from the first sample"
    if columns.euler is not None:
        attitude = f"{', '.join(columns.euler.columns)} in {columns.euler.unit}, turned {columns.euler.order}"
    elif columns.quaternion is not None:
        w_to_z = ", ".join(columns.quaternion.columns)
        attitude = f"{w_to_z} as w, x, y, z, {columns.quaternion.sense.replace('_', ' ')}"
    return f"{clock}; {attitude}; axes {columns.axes}"


def _check_finite(table: Table, loaded: Mapping[str, Array | Integers], columns: ColumnMap) -> None:
    bad = [(int(np.argmin(ok)), name) for name in columns.columns if not (ok := np.isfinite(loaded[name])).all()]
    if bad:
        row, name = min(bad)
        raise table.error("a finite number", name, shortest(float(loaded[name][row])), row)


def _attitudes(table: Table, loaded: Mapping[str, Array | Integers], columns: ColumnMap) -> tuple[Array, float]:
    """Ours (n, 4), and by how much the longest or shortest was off unit length."""
    rows = loaded[columns.attitude[0]].size
    q, off = np.empty((rows, 4)), 0.0
    for begin in range(0, rows, _BLOCK):  # what is between columns and attitudes is several times as large
        part = slice(begin, begin + _BLOCK)
        given = np.stack([np.asarray(loaded[name][part], float) for name in columns.attitude], axis=-1)
        if columns.quaternion is not None:
            q[part], largest = _from_quaternion(table, given, columns.quaternion, columns.axes, begin)
            off = max(off, largest)
        elif columns.euler is not None:
            q[part] = _from_euler(given, columns.euler, columns.axes)
    return q, off


def _from_euler(given: Array, how: EulerMap, axes: Convention) -> Array:
    degrees = given / 100.0 if how.unit is AngleUnit.CENTIDEG else given
    angles = given if how.unit is AngleUnit.RAD else np.deg2rad(degrees)
    if _NAMED.get(axes) == how.order:
        yaw, pitch, roll = angles.T
        return quaternion_from_euler(*(euler_from_ned(yaw, pitch, roll) if axes is Convention.NED else angles.T))
    return in_our_axes(quaternion_from_rotations(how.order, angles), axes)


def _from_quaternion(
    table: Table, given: Array, how: QuaternionMap, axes: Convention, begin: int
) -> tuple[Array, float]:
    norm = np.linalg.norm(given, axis=-1)
    bad = ~((norm > 0.5) & (norm < 2.0))
    if bad.any():
        row = int(np.argmax(bad))
        zero = norm[row] < 1e-9
        expected = f"a unit quaternion, {'this one is zero' if zero else f'not |q|={norm[row]:.3g}'}"
        raise table.error(expected, how.columns[0], shortest(given[row, 0]), begin + row)
    unit = given / norm[:, None]
    if how.sense is Sense.REFERENCE_TO_BODY:
        unit = unit * _CONJUGATE
    return in_our_axes(unit, axes), float(np.max(np.abs(norm - 1.0)))


def in_our_axes(q: Array, axes: Convention) -> Array:
    """Ours from q (n, 4), body to reference in the axes that it was written in."""
    if axes is Convention.NED:
        return quaternion_from_ned(q)
    return quaternion_from_enu(q) if axes is Convention.ENU else q
