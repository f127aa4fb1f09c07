"""Solve the frame angles of a flight with any method by name."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Codes, Counts
from fullpose.errors import InputError, MethodError
from fullpose.flight import bad_time
from fullpose.methods import METHODS
from fullpose.methods.base import Stepper
from fullpose.rig import FRAMES, Rig
from fullpose.solution import Blocking, Solution, limited_name
from fullpose.verify import attitude_errors, payload_attitudes

PLAN = "plan"  # the one method that sees the whole flight at once
PREVIEW = "preview"  # the one that sees a part of it ahead
BLOCK = 16  # samples between two readings of the clock and two reports of progress
ORTHONORMAL = 1e-9  # how far C C^T may be from the identity


def solve(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    method: str = "exact",
    options: Any = None,
    start: ArrayLike | None = None,
    clock: Callable[[], float] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Solution:
    """Frame angles for a flight: time (n,) [s] strictly increasing, attitude (n, 3, 3) body from reference.

    options: an instance of the method's options class, or None for its defaults. start (4,) [rad]: the flight starts
    at the exact pose nearest to it; None: nearest to the rig's home. clock: a function that reads seconds; without it
    the timings are nan. progress(done, total) is called between blocks and may raise `CancelledError`.

    Raises `InputError` for arrays that are no flight, `MethodError` for a method that is unknown or does not apply.
    """
    t, C = check_flight(time, attitude)
    near = check_start(start, rig)
    if method == PLAN:
        from fullpose.plan import PlanOptions, plan  # the planner checks its input by this module

        if options is not None and not isinstance(options, PlanOptions):
            raise MethodError(f"options of {method}: expected PlanOptions, not {type(options).__name__}")
        return plan(t, C, rig, near, options=options, progress=progress, clock=clock).solution
    open_flight = _opener(method, options, rig, near, t, C)
    n = len(t)
    angles = np.empty((n, 4))
    limited = np.empty(n, np.int16)
    iterations = np.empty(n, np.int32)
    step_time = np.full(n, np.nan)
    begin = clock() if clock else np.nan
    stepper = open_flight()
    for k in range(0, n, BLOCK):
        block = slice(k, min(k + BLOCK, n))
        before = clock() if clock else np.nan
        result = stepper.block(t[block], C[block])
        after = clock() if clock else np.nan
        angles[block], limited[block], iterations[block] = result.angles, result.limited, result.iterations
        step_time[block] = (after - before) / (block.stop - block.start)
        if progress:
            progress(block.stop, n)
    solve_time = clock() - begin if clock else np.nan
    return _solution(method, rig, t, C, angles, limited, iterations, step_time, solve_time)


def _opener(
    method: str, options: Any, rig: Rig, near: Array | None, time: Array, attitude: Array
) -> Callable[[], Stepper]:
    """What begins the flight with a method that goes sample by sample. Raises `MethodError`."""
    if method == PREVIEW:
        from fullpose.plan import PreviewFlight, PreviewOptions

        ahead = PreviewOptions() if options is None else options
        if not isinstance(ahead, PreviewOptions):
            raise MethodError(f"options of {method}: expected PreviewOptions, not {type(options).__name__}")
        return lambda: PreviewFlight(rig, ahead, near, time, attitude)
    if method not in METHODS:
        raise MethodError(f"method {method!r}: expected one of {', '.join((PLAN, PREVIEW, *METHODS))}")
    chosen = METHODS[method]
    own = chosen.options() if options is None else options
    if not isinstance(own, chosen.options):
        raise MethodError(f"options of {method}: expected {chosen.options.__name__}, not {type(options).__name__}")
    return lambda: chosen.stepper(rig, own, near, attitude[0])


def _solution(
    method: str,
    rig: Rig,
    time: Array,
    attitude: Array,
    angles: Array,
    limited: Codes,
    iterations: Counts,
    step_time: Array,
    solve_time: float,
) -> Solution:
    error, matrix_error = attitude_errors(payload_attitudes(rig, angles), attitude)
    solution = Solution(
        method, rig, time, angles, error, matrix_error, limited, iterations, step_time, solve_time, blocking=None
    )
    first = np.flatnonzero(limited)
    if not first.size:
        return solution
    name = limited_name(int(limited[first[0]]))
    return replace(solution, blocking=Blocking(float(time[first[0]]), *name) if name else None)


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
    pose = np.ascontiguousarray(start, dtype=np.float64)
    if pose.shape != (4,) or not np.isfinite(pose).all():
        raise InputError("start", None, pose.tolist(), "four finite angles, base first")
    for i in rig.geometry.frames:
        if not rig.position_min[i] <= pose[i] <= rig.position_max[i]:
            allowed = f"between {rig.position_min[i]:.6g} and {rig.position_max[i]:.6g} rad for this rig"
            raise InputError(f"start of the {FRAMES[i]} frame", None, float(pose[i]), allowed)
    return pose
