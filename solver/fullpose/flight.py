"""The times [s] that a flight may have: increasing, and in a range where rates and accelerations stay numbers."""

import numpy as np

from fullpose._typing import Array

FARTHEST = 1e10  # [s] from zero: three centuries, so that seconds since 1970 are inside and nanoseconds are not
SHORTEST_STEP = 1e-7  # [s]; a lead at this interval is still short enough to be had


def bad_time(time: Array, before: float | None = None) -> tuple[int, str] | None:
    """(row, what was expected there) of the first of time (n,) that is no time of a flight, or None.

    before: the last time of the part of the flight that went before.
    """
    far = ~(np.abs(time) <= FARTHEST)  # nan is far, too
    if far.any():
        row = int(np.argmax(far))
        span = f"seconds between {-FARTHEST:g} and {FARTHEST:g}"
        return row, span if np.isfinite(time[row]) else "a finite number"
    whole = time if before is None else np.concatenate([[before], time])
    steps = np.diff(whole)
    short = steps < SHORTEST_STEP
    if not short.any():
        return None
    k = int(np.argmax(short))
    row, last = k + 1 - (whole.size - time.size), shortest(whole[k])
    if steps[k] > 0.0:
        return row, f"a time at least {SHORTEST_STEP:g} s after {last}"
    why = "this one is there twice" if steps[k] == 0.0 else "time must not go backward"
    return row, f"a time after {last}, {why}"


def shortest(value: float) -> str:
    """The shortest decimal that reads back to the same double, as a person would have written it: 0.05, 1, 1e+18."""
    return repr(float(value)).removesuffix(".0")
