"""Whether the numbers of a table can be what its column map says: each column against what its unit and meaning allow.

Nothing is changed here. A caution names the column, the line and the value, and what it looks like instead.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from fullpose._typing import Array
from fullpose.flight import shortest
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.column_map import AngleUnit, EulerMap, TimeMap

SENTINELS = (  # of either sign
    *(999.0, 9999.0, 99999.0, 655.35, 6553.5, 65535.0),
    *(327.67, 327.68, 3276.7, 3276.8, 32767.0, 32768.0, 2147483647.0, 2147483648.0),
)
ABSURD_DEG = 1e6  # no column of angles counts so many turns
HUGE = 1e12  # what is beyond is a code for "no value"
FASTEST_DEG_S = 3600.0  # of a body: ten turns a second
LEAST_JUMP_DEG = 10.0  # to a code, from the samples around it
MANY_STEPS = 20.0  # ... and so many times what the column usually moves from one to the next
LEAST_RAD = 0.0017  # a tenth of a degree: what stays within it does not matter
DIFFERENT_INTEGERS = 20  # different ones, in a column without any fraction, that centidegrees are seen by
SLOW_STEP_S = 0.25  # a median step from here on is looked at
SLOW_RATE_DEG_S = 1.0  # ... where nothing turns faster, up to a second
QUICK_STEP_S = 2e-5  # ... and up to here
NEAR = 0.1  # of the median step
LONGEST_STEP_DEG = 90.0  # between samples: beyond it, which way round is a guess
_RADIAN_PEAK = (2.0 * math.pi + 1e-3, 0.5 * math.pi + 1e-3, 2.0 * math.pi + 1e-3)
_STILL = 1e-6  # a column that moves less does not say its unit


@dataclass(frozen=True)
class Angles:
    """Three columns of angles (n,) each, as the file has them, in the order of the turns; the second is a pitch."""

    how: EulerMap
    values: tuple[Array, Array, Array]
    line_of: Callable[[int], int]
    row_word: str

    def at(self, code: str, column: int, row: int, text: str) -> Caution:
        """A caution at a row of a column."""
        name, value, line = self.how.columns[column], shortest(float(self.values[column][row])), self.line_of(row)
        return Caution(code, f"{self.row_word} {line}, column {name}: {value}: {text}", name, line, value)

    def degrees(self, column: int) -> Array:
        """A column (n,) [deg] as its unit says."""
        values = self.values[column]
        if self.how.unit is AngleUnit.RAD:
            return np.asarray(np.rad2deg(values))
        return values / 100.0 if self.how.unit is AngleUnit.CENTIDEG else values

    @property
    def has_pitch(self) -> bool:
        """Whether the three axes differ: the second angle is inside a quarter turn then."""
        return len(set(self.how.order)) == 3


def angle_cautions(angles: Angles) -> Iterator[Caution]:
    """What is doubtful about three columns of angles."""
    for column in range(3):
        yield from _sentinels(angles, column)
        yield from _absurd(angles, column)
    yield from _pitch(angles)
    if angles.how.unit is AngleUnit.DEG:
        yield from _radians(angles)
        yield from _centidegrees(angles)


def _sentinels(angles: Angles, column: int) -> Iterator[Caution]:
    values = angles.values[column]
    large = np.flatnonzero(np.abs(values) >= 0.9 * min(SENTINELS))  # few of a long record
    size = np.abs(values[large])
    coded = size >= HUGE
    for sentinel in SENTINELS:
        coded |= np.abs(size - sentinel) <= 1e-9 * sentinel
    rows = large[coded]
    if rows.size == values.size and np.ptp(values) == 0.0:
        yield angles.at("sentinel", column, 0, "a code for no value, not an angle (every sample)")
    if not rows.size or rows.size == values.size:
        return
    usual = float(np.median(np.abs(np.diff(values))))
    least = max(LEAST_JUMP_DEG, MANY_STEPS * usual)
    far = [int(row) for row in rows if _alone(values, int(row), least)]
    if far:
        more = f" ({len(far)} such samples)" if len(far) > 1 else ""
        yield angles.at("sentinel", column, far[0], f"a code for no value, not an angle{more}")


def _alone(values: Array, row: int, least: float) -> bool:
    """Whether a value is no neighbour of the one before it or after it, where these differ from it."""
    near = [float(values[k]) for k in (row - 1, row + 1) if 0 <= k < len(values) and values[k] != values[row]]
    return all(abs(value - float(values[row])) > least for value in near)


def _absurd(angles: Angles, column: int) -> Iterator[Caution]:
    size = np.abs(angles.degrees(column))
    beyond = np.flatnonzero((size > ABSURD_DEG) & (np.abs(angles.values[column]) < HUGE))
    if beyond.size:
        text = f"{size[beyond[0]] / 360.0:.4g} turns: in another unit, or no angle?"
        yield angles.at("beyond-reason", column, int(beyond[0]), text)


def _pitch(angles: Angles) -> Iterator[Caution]:
    if not angles.has_pitch:
        return
    size = np.abs(angles.degrees(1))
    beyond = np.flatnonzero((size > 90.0 + 1e-6) & (np.abs(angles.values[1]) < HUGE))
    if not beyond.size:
        return
    peak = float(size[beyond].max())
    text = f"no pitch is beyond {_quarter(angles.how.unit)}"
    if angles.how.unit is AngleUnit.DEG and peak > 180.0:
        text += " deg: are the angles in centidegrees?"
    elif angles.how.unit is AngleUnit.RAD:
        text += " rad: are the angles in degrees?"
    else:
        text += f" {angles.how.unit}: is the order of the columns {angles.how.order}?"
    yield angles.at("pitch", 1, int(beyond[0]), text)


def _quarter(unit: AngleUnit) -> str:
    return {AngleUnit.DEG: "90", AngleUnit.RAD: "1.5708", AngleUnit.CENTIDEG: "9000"}[unit]


def _radians(angles: Angles) -> Iterator[Caution]:
    """Radians in columns of degrees: a pitch inside +-pi / 2; where none moves the third angle inside +-2 pi, and where
    that does not move either the first."""
    peaks = [float(np.max(np.abs(values))) for values in angles.values]
    moving = [float(np.ptp(values)) > _STILL for values in angles.values]
    small = [k for k in range(3) if moving[k] and peaks[k] <= _RADIAN_PEAK[k]]
    telling = next((k for k in (1, 2, 0) if moving[k]), None)
    if telling not in small or max(peaks[k] for k in small) <= LEAST_RAD:
        return
    # One that turns on and on leaves 2 pi, and is in radians with the others where its steps are small as such.
    for k in [k for k in range(3) if k in small or (len(small) >= 2 and _quiet(angles.values[k]))]:
        row = int(np.argmax(np.abs(angles.values[k])))
        text = f"the column stays within {peaks[k]:.4g}: if it is in radians, say so in a profile, or convert it"
        yield angles.at("angle-unit", k, row, text)


def _centidegrees(angles: Angles) -> Iterator[Caution]:
    """Centidegrees in columns of degrees: whole numbers, many of them, in all that moves, two columns or three."""
    moving = [k for k in range(3) if float(np.ptp(angles.values[k])) > _STILL]
    if len(moving) < 2 or any(np.any(angles.values[k] != np.round(angles.values[k])) for k in moving):
        return
    k = max(moving, key=lambda each: float(np.ptp(angles.values[each])))
    if np.unique(angles.values[k]).size >= DIFFERENT_INTEGERS:
        row = int(np.argmax(np.abs(angles.values[k])))
        text = "whole numbers alone: if they are centidegrees, say so in a profile; else the record is coarse"
        yield angles.at("angle-unit", k, row, text)


def _quiet(values: Array) -> bool:
    """Whether the steps of a column are small even if it is in radians."""
    return values.size > 1 and float(np.ptp(values)) > _STILL and float(np.max(np.abs(np.diff(values)))) < 0.5


def time_cautions(time: Array, turn_deg: Array, how: TimeMap) -> Iterator[Caution]:
    """Whether stamps [s] and the turns between them (n - 1,) [deg] can be of one flight."""
    if time.size < 2:
        return
    step = float(np.median(np.diff(time)))
    rate = float(np.max(turn_deg / np.maximum(np.diff(time), NEAR * step)))
    if step >= 1.0 or (step >= SLOW_STEP_S and rate < SLOW_RATE_DEG_S):
        smaller = "milliseconds" if step < 1000.0 else "microseconds"
        slow = f"the median step is {step:.6g} s and the body turns at most {rate:.3g} deg/s"
        text = f"{slow}: is {how.column} in {how.unit}, not in {smaller}?"
        yield Caution("time-unit", text, how.column, value=shortest(step))
    elif step <= QUICK_STEP_S:
        text = f"the median step is {step:.3g} s: is {how.column} in {how.unit}?"
        yield Caution("time-unit", text, how.column, value=shortest(step))


def motion_cautions(
    time: Array, turn_deg: Array, columns: tuple[str, ...], line_of: Callable[[int], int], row_word: str
) -> Iterator[Caution]:
    """Whether a body can move so: its rate, and steps whose sense is a guess. turn_deg (n - 1,): to the next."""
    if time.size < 2:
        return
    step = np.diff(time)
    near = step < NEAR * float(np.median(step))  # a stamp that all but repeats the one before says no rate
    if near.any() and not near.all():
        row = int(np.argmax(near))
        line, value = line_of(row + 1), f"{step[row]:.3g} s"
        count = f", {near.sum()} such stamps" if near.sum() > 1 else ""
        yield Caution("near-duplicate", f"{row_word} {line}: {value} after the sample before{count}", None, line, value)
    rate = np.where(near, 0.0, turn_deg / step)
    row = int(np.argmax(rate))
    if rate[row] > FASTEST_DEG_S:
        line, value = line_of(row + 1), f"{rate[row]:.4g} deg/s"
        yield Caution(
            "body-rate", f"{row_word} {line}: the body turns at {value} to here: no vehicle does", None, line, value
        )
    far = np.flatnonzero(turn_deg > LONGEST_STEP_DEG)
    if far.size:
        line, value = line_of(int(far[0]) + 1), f"{turn_deg[far[0]]:.4g} deg"
        more = f", {far.size} such steps" if far.size > 1 else ""
        text = (
            f"{row_word} {line}: the attitude ({', '.join(columns)}) turns {value} from the sample before{more}: the "
            "shorter way round is flown"
        )
        yield Caution("step", text, None, line, value)
