"""What a flight is: times that increase, in a range where rates and accelerations stay numbers, and attitudes that are
rotations; and what a start of it may be."""

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array
from fullpose.errors import InputError
from fullpose.rig import FRAMES, Rig

FARTHEST = 1e10  # [s] from zero: three centuries, so that seconds since 1970 are inside and nanoseconds are not
SHORTEST_STEP = 1e-7  # [s]; a lead at this interval is still short enough to be had
ORTHONORMAL = 1e-9  # how far C C^T may be from the identity


def bad_time(time: Array, before: float | None = None) -> tuple[int, str] | None:
    """(row, what was expected there) of the first of time (n,) that is no time of a flight, or None.

    before: the last time of the part of the flight that went before.
    """
    far = ~(np.abs(time) <= FARTHEST)  # nan is far, too
    if far.any():
        row = int(np.argmax(far))
        span = f"seconds between {-FARTHEST:g} and {FARTHEST:g}"
        return row, span if np.isfinite(time[row]) else "a finite number"
    times = time if before is None else np.concatenate([[before], time])
    steps = np.diff(times)
    tight = steps < SHORTEST_STEP
    if not tight.any():
        return None
    k = int(np.argmax(tight))
    row, last = k + 1 - (times.size - time.size), shortest(times[k])
    if steps[k] > 0.0:
        return row, f"a time at least {SHORTEST_STEP:g} s after {last}"
    why = "this one is there twice" if steps[k] == 0.0 else "time must not go backward"
    return row, f"a time after {last}, {why}"


def shortest(value: float) -> str:
    """The shortest decimal that reads back to the same double, as a person would have written it: 0.05, 1, 1e+18."""
    return repr(float(value)).removesuffix(".0")


def check_flight(time: ArrayLike, attitude: ArrayLike) -> tuple[Array, Array]:
    """(time (n,), attitude (n, 3, 3)), copied. Raises `InputError` where they are no flight.

    Copies, because a solution keeps its time read-only, and because kernels compile again for read-only arrays.
    """
    t = np.array(time, dtype=np.float64, order="C")
    C = np.array(attitude, dtype=np.float64, order="C")
    if t.ndim != 1 or not t.size:
        raise InputError("time", None, t.shape, "(n,) seconds, at least one sample")
    if C.shape != (len(t), 3, 3):
        raise InputError("attitude", None, C.shape, f"({len(t)}, 3, 3), one matrix a sample")
    if found := bad_time(t):
        raise InputError("time", found[0], float(t[found[0]]), found[1])
    bad = np.flatnonzero(~np.isfinite(C).all(axis=(1, 2)))
    if bad.size:
        raise InputError("attitude", int(bad[0]), C[bad[0]].tolist(), "finite numbers")
    off = np.abs(C @ np.swapaxes(C, 1, 2) - np.eye(3)).max(axis=(1, 2))
    bad = np.flatnonzero((off > ORTHONORMAL) | (np.linalg.det(C) < 0.0))
    if bad.size:
        raise InputError("attitude", int(bad[0]), C[bad[0]].tolist(), "a rotation matrix (C C^T = 1, det C = +1)")
    return t, C


def check_start(start: ArrayLike | None, rig: Rig) -> Array | None:
    """The start pose (4,) [rad], or None. Raises `InputError` where it is not a pose of the rig."""
    if start is None:
        return None
    pose = _four("start", start, "angles")
    for i in rig.geometry.frames:
        if not rig.position_min[i] <= pose[i] <= rig.position_max[i]:
            allowed = f"between {rig.position_min[i]:.6g} and {rig.position_max[i]:.6g} rad for this rig"
            raise InputError(f"start of the {FRAMES[i]} frame", None, float(pose[i]), allowed)
    return pose


def check_start_rate(rate: ArrayLike | None, rig: Rig) -> Array | None:
    """The start rate (4,) [rad/s], or None. Raises `InputError` where it is not a rate of the rig."""
    if rate is None:
        return None
    v = _four("start_rate", rate, "rates in rad/s")
    for i in rig.geometry.frames:
        if abs(v[i]) > rig.max_rate[i]:
            allowed = f"at most {rig.max_rate[i]:.6g} rad/s"
            raise InputError(f"start_rate of the {FRAMES[i]} frame", None, float(v[i]), allowed)
    return v


def _four(name: str, values: ArrayLike, what: str) -> Array:
    """One number a frame (4,)."""
    four = np.ascontiguousarray(values, dtype=np.float64)
    if four.shape != (4,) or not np.isfinite(four).all():
        raise InputError(name, None, four.tolist(), f"four finite {what}, base first")
    return four
