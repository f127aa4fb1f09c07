"""Methods, or variants of one, side by side on one flight and rig: the figures of each, and why it failed where it did.

Pure: the solutions come from `solve`, the limits from `verify`, so that no method marks its own work. Radians, seconds.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fullpose._typing import Array, Integers
from fullpose.bounds import limited_name
from fullpose.errors import MethodError
from fullpose.flight import check_flight
from fullpose.kinematics import singularity_measures
from fullpose.registry import Stepwise, Variant, find_method, method_options, parse_variant
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose.solution import Solution
from fullpose.solve import solve_flight
from fullpose.verify import Verification, verify

if TYPE_CHECKING:
    from fullpose.plan import Plan

# A sample is exact within 1e-9 deg: a hundred times the rounding of the geodesic error, far below any encoder.
EXACT_WITHIN = np.deg2rad(1e-9)
# `singularity_measure` below this: within about 6 deg of the four-axis rig's singularity.
SINGULAR_BELOW = 0.01


@dataclass(frozen=True)
class Failure:
    """Samples that miss the attitude for one reason: what, how many, when first [s], the largest error [rad]."""

    reason: str
    samples: int
    first: float
    max_error: float


@dataclass(frozen=True)
class Figures:
    """What a solution did. Arrays have one row a frame, base first; columns are position, rate, acceleration."""

    exact_share: float  # of the samples, within `EXACT_WITHIN`
    max_error: float  # [rad]
    rms_error: float  # [rad]
    max_matrix_error: float
    violations: Integers  # (4, 3) samples beyond each limit
    peaks: Array  # (4, 4) largest magnitudes [rad, rad/s, rad/s^2, rad/s^3]
    total_variation: Array  # (4,) [rad] the way each frame turned
    failures: tuple[Failure, ...]  # the most samples first


@dataclass(frozen=True)
class Row:
    """One variant of a comparison. Where it does not apply to the rig, `refusal` says why and the rest is None."""

    variant: Variant
    claims_limits: bool
    source: str
    refusal: str | None = None
    solution: Solution | None = None
    verification: Verification | None = None
    figures: Figures | None = None
    plan: "Plan | None" = None  # of a method that sees the whole flight


def figures(solution: Solution, verification: Verification) -> Figures:
    """The figures of a solution, `verification` being that of its angles against its rig and flight."""
    violations = np.zeros((4, len(LIMITS)), np.int64)
    for violation in verification.violations:
        violations[FRAMES.index(violation.frame), LIMITS.index(violation.limit)] += violation.samples
    return Figures(
        exact_share=float(np.mean(solution.error <= EXACT_WITHIN)),
        max_error=float(solution.error.max()),
        rms_error=float(np.sqrt(np.mean(solution.error**2))),
        max_matrix_error=float(solution.matrix_error.max()),
        violations=violations,
        peaks=verification.peaks,
        total_variation=np.abs(np.diff(solution.angles, axis=0)).sum(axis=0),
        failures=failures(solution),
    )


def failures(solution: Solution) -> tuple[Failure, ...]:
    """Every sample that is not exact, sorted by reason.

    The method's own mark comes first (which limit of which frame); then `singularity`, where a four-axis rig stands
    next to its singularity; else `linearised step`: the error that a step along the tangent leaves, or has gathered.
    """
    missed = ~(solution.error <= EXACT_WITHIN)
    d = solution.angles
    singular = np.zeros(len(d), bool)
    if solution.rig.geometry.redundant:
        singular = singularity_measures(d) < SINGULAR_BELOW
    groups: list[tuple[str, NDArray[np.bool_]]] = []
    for code in np.unique(solution.limited[missed & (solution.limited > 0)]):
        name = limited_name(int(code))
        if name is not None:
            groups.append((f"{name[1]} limit of the {name[0]} frame", missed & (solution.limited == code)))
    free = missed & (solution.limited == 0)
    groups.append(("singularity", free & singular))
    groups.append(("linearised step", free & ~singular))
    found = [
        Failure(
            reason,
            int(np.count_nonzero(where)),
            float(solution.time[np.argmax(where)]),
            float(solution.error[where].max()),
        )
        for reason, where in groups
        if where.any()
    ]
    return tuple(sorted(found, key=lambda failure: (-failure.samples, failure.reason)))


def variants(methods: Sequence[str | Variant]) -> tuple[Variant, ...]:
    """What is asked for, texts read by `parse_variant`.

    Raises `MethodError` for none, for a text that is none, and where two have one label.
    """
    if not methods:
        raise MethodError("no method to compare: expected at least one name")
    found = tuple(parse_variant(method) if isinstance(method, str) else method for method in methods)
    labels = [one.label for one in found]
    for label in labels:
        if labels.count(label) > 1:
            raise MethodError(
                f"{labels.count(label)} methods are called {label!r}: expected a label of its own for each"
            )
    return found


def compare(
    time: ArrayLike,
    attitude: ArrayLike,
    rig: Rig,
    methods: Sequence[str | Variant],
    start: ArrayLike | None = None,
    clock: Callable[[], float] | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[Row, ...]:
    """Solve the flight with each method and measure it: time (n,) [s], attitude (n, 3, 3) body from reference.

    progress(label, done, total) is called as `solve` calls its own. A method that does not apply to the rig gets a
    row that says so. Raises `InputError` for arrays that are no flight, `MethodError` as `variants` does.
    """
    asked = variants(methods)
    t, C = check_flight(time, attitude)
    return tuple(_row(t, C, rig, one, start, clock, progress) for one in asked)


def _row(
    time: Array,
    attitude: Array,
    rig: Rig,
    variant: Variant,
    start: ArrayLike | None,
    clock: Callable[[], float] | None,
    progress: Callable[[str, int, int], None] | None,
) -> Row:
    method = find_method(variant.method)
    options = method.chosen(method_options(method.name, variant.options))

    def report(done: int, total: int) -> None:
        if progress:
            progress(variant.label, done, total)

    try:
        if clock and isinstance(method, Stepwise) and method.step is not None:
            # The first call loads the kernels, which is no part of a step.
            method.step.stepper(rig, options, None, attitude[0]).block(time[:2], attitude[:2])
        solved = solve_flight(time, attitude, rig, method.name, options, start, clock, report)
    except MethodError as refusal:
        return Row(variant, method.claims_limits, method.source, refusal=str(refusal))
    solution = solved.solution
    verification = verify(time, solution.angles, rig, attitude)
    measured = figures(solution, verification)
    return Row(variant, method.claims_limits, method.source, None, solution, verification, measured, solved.plan)
