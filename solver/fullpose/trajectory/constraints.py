"""The limits that a refinement keeps to, and their rows in its quadratic programme (mathematics, section 8)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.bounds import JERK, LOWER, RATE, UPPER
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose.solution import Blocking
from fullpose.trajectory.bspline import Basis
from fullpose.trajectory.linearisation import (
    JERK_ROW,
    ROW,
    Iterate,
    Limits,
    Reach,
    Row,
    Rows,
    difference,
    fill_row,
    limit_rows,
    limit_violations,
)

CHUNK = 1 << 17  # samples looked at together
CLEAR = 1e-5  # [rad] that positions keep from their ends where a reserve is kept; a tenth of a narrow range
ROOM = 0.8  # of v^2 / a: the way that a lead needs between rest and rate v
SHORTEST = 3.0  # samples: a lead has four at least, of half the rate on average, and the rate it starts from may rise
LEAD_UNIT = 0.005  # [rad] short of that room counts as much as the whole of a rate limit
TANGENTS = np.linspace(0.2, 1.0, 5)  # shares of the rate limit at which v^2 / a is linearised


class LimitViolation(NamedTuple):
    """How far outside the limits the worst sample of a path is, as a share of the limit (<= 0: inside), and where."""

    share: float
    sample: int
    frame: int
    limit: int

    def blocking(self, time: Array) -> Blocking:
        """It as what closed the way; time (n,) [s] of the path."""
        return Blocking(float(time[self.sample]), FRAMES[self.frame], LIMITS[self.limit])


def rig_limits(rig: Rig, reserve: float = 0.0) -> Limits:
    """The rig's limits with `reserve` (a share of them) unused; positions keep `CLEAR` of their ends at most."""
    span = rig.position_max - rig.position_min
    clear = np.minimum(CLEAR, 0.1 * span) if reserve > 0.0 else 0.0
    return Limits(
        rig.position_min + clear, rig.position_max - clear,
        rig.max_rate * (1.0 - reserve), rig.max_acceleration * (1.0 - reserve), rig.max_jerk * (1.0 - reserve),
    )  # fmt: skip


def largest_violation(time: Array, angles: Array, limits: Limits, last: int | None = None) -> LimitViolation:
    """The worst of the first `last` samples of angles (n, 4) [rad] at time (n,) [s]."""
    n = len(time) if last is None else min(last, len(time))
    largest = LimitViolation(-np.inf, 0, 0, 0)
    for begin in range(0, n, CHUNK):
        end = min(n, begin + CHUNK)
        part = slice(max(0, begin - 2), end + 1)
        violations, frame = exceeded(time[part], angles[part], limits)
        own = violations[begin - part.start : end - part.start]
        k, kind = np.unravel_index(np.argmax(own), own.shape)
        if own[k, kind] > largest.share:
            whose = int(frame[begin - part.start + k, kind])
            largest = LimitViolation(float(own[k, kind]), begin + int(k), whose, int(kind))
    return largest


def exceeded(time: Array, angles: Array, limits: Limits) -> tuple[Array, NDArray[np.int8]]:
    """`limit_violations` of a path (n, 4) [rad]: how far outside each sample is, and whose limit: (n, 3 or 4) each."""
    shape = len(time), limits.kinds
    violations, frame = np.empty(shape), np.empty(shape, np.int8)
    limit_violations(time, angles, limits, violations, frame)
    return violations, frame


def rows_within_reach(at: Iterate, basis: Basis, limits: Limits, reach: Reach) -> Rows:
    """The rows of limits that may matter to a step, as many as there are."""
    size = 1024
    width = JERK_ROW if limits.kinds > JERK else ROW
    while True:
        rows = Rows(np.empty(size, np.int64), np.empty((size, width)), np.empty(size), np.empty((size, 3), np.int64))
        count = limit_rows(at, basis, limits, reach, rows)
        if count <= size:
            return Rows(rows.origin[:count], rows.rows[:count], rows.room[:count], rows.bound[:count])
        size = count


def lead_cuts(at: Iterate, basis: Basis, limits: Limits, ends: tuple[bool, bool]) -> list[Row]:
    """Rows c <= value that leave room for the leads: ROOM v^2 / a between rest and rate v, by its tangents, and a few
    samples' way."""
    if len(at.time) < 3:
        return []
    frames = np.flatnonzero(np.isfinite(limits.high)).tolist()
    return [
        cut for at_end in (False, True) if ends[at_end] for i in frames
        for cut in _frame_cuts(at, basis, limits, at_end, i)
    ]  # fmt: skip


def _frame_cuts(at: Iterate, basis: Basis, limits: Limits, at_end: bool, i: int) -> list[Row]:
    """The `lead_cuts` of frame i at one end of the path."""
    time, d, n = at
    count = len(time)
    k, first = (count - 1, count - 2) if at_end else (0, 0)
    origin = int(basis.first[first])
    shift = int(basis.first[k]) - origin
    h = time[first + 1] - time[first]
    rate_row, here = np.zeros(ROW), np.zeros(ROW)
    fill_row(RATE, first + 1, i, at, basis, rate_row)
    here[shift : shift + basis.values.shape[1]] = n[k, i] * basis.values[k]
    rate = difference(RATE, first + 1, i, time, d)
    a = limits.acceleration[i]
    # What the acceleration takes to rise, and to fall, for its jerk limit.
    rise = a / limits.jerk[i] if np.isfinite(a) and np.isfinite(limits.jerk[i]) else 0.0
    fastest = limits.rate[i] if np.isfinite(limits.rate[i]) else max(abs(rate), 1.0)
    # Without an acceleration limit the samples' way is all: one row.
    speeds = np.r_[TANGENTS * fastest, abs(rate)] if np.isfinite(a) else np.zeros(1)
    cuts = []
    for side in (UPPER, LOWER):  # the end of the range that the frame runs to after the end, or came from before
        sign = 1.0 if side == UPPER else -1.0
        room = limits.high[i] - d[k, i] if side == UPPER else d[k, i] - limits.low[i]
        toward = sign if at_end else -sign
        for v in speeds:
            slope = 2.0 * ROOM * v / a + SHORTEST * h + rise
            row = sign * here + toward * slope * rate_row
            value = room - slope * toward * rate + ROOM / a * v * v
            cuts.append(Row(origin, row / LEAD_UNIT, value / LEAD_UNIT))
    return cuts
