"""Solve the frame angles of a flight with any method by name."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Clock, Codes, Counts, Integers, Progress
from fullpose.bounds import limited_name
from fullpose.flight import check_flight, check_start
from fullpose.methods.base import Stepper
from fullpose.registry import DEFAULT, Planner, find_method
from fullpose.resample import subdivide
from fullpose.rig import Rig
from fullpose.solution import Blocking, Solution
from fullpose.verify import attitude_errors, payload_attitudes

if TYPE_CHECKING:
    from fullpose.plan import Plan

# A step method's rules hold over short steps: what its null-space gains ask for in five seconds is a turn of a frame.
SPARSE_S = 1.0  # a flight with a longer step is solved at samples between, too
FINE_S = 0.1
MOST_PARTS = 200  # of one step
MOST_SPARSE = 20_000  # samples; a spline through more of them takes much memory, and they are no sparse flight

BLOCK = 16  # samples between two readings of the clock and two reports of progress


@dataclass(frozen=True)
class Solved:
    """A flight's solution, and the plan it is of where the method sees the whole flight: its verdict and its leads."""

    solution: Solution
    plan: "Plan | None" = None


def solve(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    method: str = DEFAULT,
    options: Any = None,
    start: ArrayLike | None = None,
    clock: Clock | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Frame angles for a flight: time (n,) [s] strictly increasing, attitude (n, 3, 3) body from reference.

    options: an instance of the method's options class, or None for its defaults. start (4,) [rad]: the flight starts
    at the exact pose nearest to it; None: where the planner likes, or for a step method nearest to the rig's home.
    clock: a function that reads seconds; without it the timings are nan. progress(done, total) is called between blocks
    and may raise `CancelledError`.

    Raises `InputError` for arrays that are no flight, `MethodError` for a method that is unknown or does not apply.
    """
    return solve_flight(time, attitude, rig, method, options, start, clock, progress).solution


def solve_flight(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    method: str = DEFAULT,
    options: Any = None,
    start: ArrayLike | None = None,
    clock: Clock | None = None,
    progress: Progress | None = None,
) -> Solved:
    """As `solve`, with the plan where the method made one."""
    row = find_method(method)
    t, C = check_flight(time, attitude)
    near = check_start(start, rig)
    own = row.chosen(options)
    if isinstance(row, Planner):
        made = row.plans(t, C, rig, near, own, progress, clock)
        return Solved(made.solution, made)
    begin = clock() if clock else np.nan
    at, between, rows = t, C, None
    if 1 < t.size <= MOST_SPARSE and float(np.diff(t).max()) > SPARSE_S:
        at, between, rows = subdivide(t, C, FINE_S, MOST_PARTS)
    flown = _sampled(row.begins(rig, own, near, at, between), at, between, clock, progress)
    if rows is not None:
        flown = _at(flown, rows)
    solve_time = clock() - begin if clock else np.nan
    return Solved(_solution(method, rig, t, C, flown, solve_time))


@dataclass(frozen=True)
class _Samples:
    """What a stepper did, sample by sample: angles (n, 4) [rad], codes, iterations and [s] a step (n,)."""

    angles: Array
    limited: Codes
    iterations: Counts
    step_time: Array


def _sampled(
    stepper: Stepper, time: Array, attitude: Array, clock: Clock | None, progress: Progress | None
) -> _Samples:
    n = len(time)
    out = _Samples(np.empty((n, 4)), np.empty(n, np.int16), np.empty(n, np.int32), np.full(n, np.nan))
    for k in range(0, n, BLOCK):
        block = slice(k, min(k + BLOCK, n))
        before = clock() if clock else np.nan
        result = stepper.block(time[block], attitude[block])
        after = clock() if clock else np.nan
        out.angles[block], out.limited[block], out.iterations[block] = result.angles, result.limited, result.iterations
        out.step_time[block] = (after - before) / (block.stop - block.start)
        if progress:
            progress(block.stop, n)
    return out


def _at(flown: _Samples, rows: Integers) -> _Samples:
    """What was done at some of the samples; what it took is that of those on the way to each, too."""
    begins = np.concatenate([[0], rows[:-1] + 1])
    return _Samples(
        flown.angles[rows],
        np.maximum.reduceat(flown.limited, begins),
        np.add.reduceat(flown.iterations, begins),
        np.add.reduceat(flown.step_time, begins),
    )


def _solution(method: str, rig: Rig, time: Array, attitude: Array, flown: _Samples, solve_time: float) -> Solution:
    error, matrix_error = attitude_errors(payload_attitudes(rig, flown.angles), attitude)
    solution = Solution(
        method, rig, time, flown.angles, error, matrix_error, flown.limited, flown.iterations, flown.step_time,
        solve_time, blocking=None,
    )  # fmt: skip
    first = np.flatnonzero(flown.limited)
    if not first.size:
        return solution
    name = limited_name(int(flown.limited[first[0]]))
    return replace(solution, blocking=Blocking(float(time[first[0]]), *name) if name else None)
