"""A flight as the store knows it: columns checked once, attitude as a continuous unit quaternion."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property, partial

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import (
    dcm_from_quaternion,
    euler_from_dcm,
    euler_from_ned,
    quaternion_from_euler,
    quaternion_from_ned,
)
from fullpose.flight import bad_time, shortest
from fullpose_server.errors import FileError

QUATERNION = ("qw", "qx", "qy", "qz")
_BLOCK = 65536  # samples converted at once


class Convention(StrEnum):
    """The axes an attitude was written in (mathematics, section 1)."""

    NUE = "nue"  # ours: reference x north, y up, z east; body x nose, y up, z right wing
    NED = "ned"  # reference north, east, down; body forward, right, down

    @property
    def euler(self) -> tuple[str, str, str]:
        """Its Euler columns."""
        if self is Convention.NUE:
            return ("yaw_deg", "pitch_deg", "roll_deg")
        return ("heading_deg", "pitch_deg", "bank_deg")


@dataclass(frozen=True)
class Caution:
    """Something accepted that a person should look at."""

    code: str
    message: str


@dataclass(frozen=True)
class Trajectory:
    """A flight. Arrays are read-only."""

    time: Array  # (n,) [s], strictly increasing
    q: Array  # (n, 4) unit, w first, no sign jumps
    convention: Convention  # of the source; `q` is always ours
    warnings: tuple[Caution, ...] = ()

    def __post_init__(self) -> None:
        self.time.setflags(write=False)
        self.q.setflags(write=False)

    @cached_property
    def sha256(self) -> str:
        """Address of the flight: of its samples, so that one flight has one address whatever file it came in."""
        digest = hashlib.sha256(b"fullpose.trajectory/1\n")
        # Not as bytes: a copy is made under the interpreter's lock, and 100 MB of it would hold an E-stop up.
        digest.update(np.ascontiguousarray(self.time, "<f8").data)
        digest.update(np.ascontiguousarray(self.q, "<f8").reshape(-1).data)
        return digest.hexdigest()


def column_names(present: list[str], convention: Convention, file: str) -> tuple[str, ...]:
    """Which of a file's columns to read: time_s and the one attitude. Raises `FileError` where that is not clear."""
    for name in present:
        if present.count(name) > 1 and name in ("time_s", *convention.euler, *QUATERNION):
            raise FileError(file, "each column once", line=1, column=name)
    if "time_s" not in present:
        raise FileError(file, f"a column time_s among {_listing(present)}", line=1, column="time_s")
    has_euler = [name for name in convention.euler if name in present]
    has_q = [name for name in QUATERNION if name in present]
    if has_euler and has_q:
        both = f"{', '.join(has_euler)} and {', '.join(has_q)}"
        raise FileError(file, "one attitude, Euler angles or quaternion", line=1, value=both)
    wanted = QUATERNION if has_q else convention.euler
    missing = [name for name in wanted if name not in present]
    if not missing:
        return ("time_s", *wanted)
    for other in Convention:
        if other is not convention and not has_q and all(name in present for name in other.euler):
            raise FileError(
                file, f"convention {other.value} for {', '.join(other.euler)}", line=1, value=f"convention {convention}"
            )
    expected = f"{', '.join(convention.euler)} or {', '.join(QUATERNION)} among {_listing(present)}"
    raise FileError(file, expected, line=1, column=missing[0])


def from_columns(
    columns: Mapping[str, Array],
    convention: Convention,
    file: str,
    line_of: Callable[[int], int],
    unit: str = "line",
) -> Trajectory:
    """The flight of columns (n,) named by `column_names`. `line_of` gives the line of a row, for messages.

    Raises `FileError`: no rows, a value that is not finite, time not increasing or out of range, a quaternion that is
    none.
    """
    names = tuple(columns)
    time = columns["time_s"]
    if time.size == 0:
        raise FileError(file, "at least one row of samples after the header")

    def fail(row: int, column: str, expected: str, value: float) -> FileError:
        return FileError(file, expected, line=line_of(row), column=column, value=shortest(value), unit=unit)

    first_bad = [(int(np.argmin(ok)), name) for name in names if not (ok := np.isfinite(columns[name])).all()]
    if first_bad:
        row, column = min(first_bad)
        raise fail(row, column, "a finite number", columns[column][row])
    if found := bad_time(time):
        row, expected = found
        raise fail(row, "time_s", expected, time[row])
    step = np.diff(time)

    warnings: list[Caution] = []
    q, off = np.empty((time.size, 4)), 0.0
    for begin in range(0, time.size, _BLOCK):  # what is between columns and attitudes is several times as large
        part = slice(begin, begin + _BLOCK)
        if names[1:] == QUATERNION:
            given = np.stack([columns[name][part] for name in QUATERNION], axis=-1)
            ours, largest = _unit(given, partial(_later, fail, begin))
            q[part], off = quaternion_from_ned(ours) if convention is Convention.NED else ours, max(off, largest)
        else:
            first, second, third = (np.deg2rad(columns[name][part]) for name in convention.euler)
            if convention is Convention.NED:
                first, second, third = euler_from_ned(first, second, third)
            q[part] = quaternion_from_euler(first, second, third)
    if off > 1e-3:
        warnings.append(Caution("norm", f"quaternions are up to {off:.2g} off unit length; they were normalised"))
    if names[1:] != QUATERNION:
        warnings += _unit_warnings(*(columns[name] for name in convention.euler))
    if step.size and float(np.median(step)) >= 1.0:
        text = f"the median step is {float(np.median(step)):.6g} s: is time_s in seconds?"
        warnings.append(Caution("time-unit", text))
    return Trajectory(np.array(time), continuous(q), convention, tuple(warnings))


def euler_deg(q: Array) -> Array:
    """Yaw, pitch, roll (n, 3) [deg] of q (n, 4), unwrapped. Of every sample: between sparse ones turns are lost."""
    angles = np.empty((len(q), 3))
    for begin in range(0, len(q), _BLOCK):  # 100 bytes a sample beside the result, otherwise
        part = slice(begin, begin + _BLOCK)
        angles[part] = np.stack(euler_from_dcm(dcm_from_quaternion(q[part])), axis=-1)
    return np.asarray(np.rad2deg(np.unwrap(angles, axis=0)))


def continuous(q: Array) -> Array:
    """The same attitudes with each quaternion's sign that of its predecessor's hemisphere, in place. (n, 4)"""
    flips = np.einsum("ij,ij->i", q[1:], q[:-1]) < 0.0
    odd = np.concatenate([[False], np.logical_xor.accumulate(flips)])
    q[odd] *= -1.0
    return q


_Fail = Callable[[int, str, str, float], FileError]


def _later(fail: _Fail, begin: int, row: int, column: str, expected: str, value: float) -> FileError:
    """`fail` for a row of a block that begins at `begin`."""
    return fail(begin + row, column, expected, value)


def _unit(q: Array, fail: _Fail) -> tuple[Array, float]:
    norm = np.linalg.norm(q, axis=-1)
    bad = ~((norm > 0.5) & (norm < 2.0))
    if bad.any():
        row = int(np.argmax(bad))
        what = (
            "a unit quaternion, this one is zero" if norm[row] < 1e-9 else f"a unit quaternion, not |q|={norm[row]:.3g}"
        )
        raise fail(row, "qw", what, q[row, 0])
    return q / norm[:, None], float(np.max(np.abs(norm - 1.0)))


def _unit_warnings(first: Array, second: Array, third: Array) -> list[Caution]:
    """Radians in degree columns look like a flight of tiny angles: inside +-2 pi, the pitch inside +-pi / 2."""
    turn, quarter = 2.0 * np.pi + 1e-6, 0.5 * np.pi + 1e-6
    peak = max(float(np.max(np.abs(column))) for column in (first, second, third))
    inside = float(np.max(np.abs(second))) <= quarter and peak <= turn
    if inside and peak > 0.1:
        text = f"all angles are within {peak:.4g} deg: if the file is in radians, convert it to degrees"
        return [Caution("angle-unit", text)]
    return []


def _listing(names: list[str]) -> str:
    shown = ", ".join(name or "(unnamed)" for name in names[:12])
    return f"{shown}, ... ({len(names)} columns)" if len(names) > 12 else shown or "no columns at all"
