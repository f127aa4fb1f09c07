"""Verdicts and margins: what a plan says about a flight, and how much room it leaves."""

import math
from dataclasses import dataclass, replace

import numpy as np

from fullpose._typing import Array, Integers
from fullpose.kinematics import singularity_measures
from fullpose.plan.impossible import Beyond
from fullpose.plan.reason import Reason
from fullpose.rig import FRAMES, LIMITS, Rig
from fullpose.solution import Blocking
from fullpose.verify import Violation, attitude_errors, differences, jerks, payload_attitudes, verify
from fullpose.vocabulary import Certainty, Decision

CHUNK = 1 << 18  # samples looked at together, so that an hour needs no copies of itself
STENCIL = 4  # samples that a cubic goes through
SPARSE = math.radians(0.01)  # [rad] of attitude half-way between samples, above which they are called too sparse
OVERSHOOT = 1e-3  # share of a rate or acceleration limit that a cubic goes over it where the samples are on it
CLEAR = math.radians(1e-3)  # [rad] likewise, of a position limit

FEASIBLE = {Decision.CHECKED: "Feasible", Decision.TOLERANCE: "Feasible within the tolerance"}
# What a verdict rests on: how sure it is, and in words; {closed} is the time [s] that the search did not get past.
CERTAINTY = {
    Decision.CHECKED: Certainty.CHECKED, Decision.TOLERANCE: Certainty.CHECKED,
    Decision.POSITION: Certainty.GRID_COMPLETE, Decision.RATE: Certainty.GRID_COMPLETE,
    Decision.ACCELERATION: Certainty.EVIDENCE, Decision.START_RATE: Certainty.EVIDENCE,
    Decision.THREE_AXIS: Certainty.COMPLETE, Decision.BEYOND: Certainty.COMPLETE,
}  # fmt: skip
HOW_SURE = {
    Decision.CHECKED: "every sample checked by code apart from the planner.",
    Decision.TOLERANCE: (
        "no exact path was found inside the limits, one within the tolerance was; every sample checked by code apart "
        "from the planner."
    ),
    Decision.POSITION: (
        "past {closed:.3f} s no exact pose lies inside the position limits that can be reached; "
        "no path of nodes exists on the grid even with every range and edge widened by the grid's covering step. "
        "Grid-complete away from the singularity, not a theorem."
    ),
    Decision.RATE: (
        "no path of nodes obeys the rate limits past {closed:.3f} s, even with every edge widened "
        "by the grid's covering step. Grid-complete away from the singularity, not a theorem."
    ),
    Decision.ACCELERATION: (
        "as far as the search went: node paths inside the rate limits exist, but none of those "
        "refined came inside every limit, with or without regard to the accelerations; the best of them fails worst at "
        "{closed:.3f} s. Evidence, not a proof."
    ),
    Decision.BEYOND: (
        "at {closed:.3f} s the attitude itself accelerates more than all frames together can, each at its rate and "
        "acceleration limits: no search was needed."
    ),
    Decision.START_RATE: (
        "with the start rate asked for no path was found that takes it up inside the limits. Evidence, not a proof."
    ),
    Decision.THREE_AXIS: "a three-axis rig has no freedom but the choice of the Euler set and its turns.",
}


@dataclass(frozen=True)
class Verdict:
    """Whether the flight can be flown. `decided_by` names the stage that decided; `grid` [rad] it used.

    `blocking` is what happens first along the angles that the plan has, as `reason` tells it; `closed` where the search
    for an exact path came to its end. Both are the same where there is no reason to tell.
    """

    feasible: bool
    blocking: Blocking | None
    decided_by: Decision
    grid: float
    statement: str
    between: float  # largest entry of F - C half-way between samples; nan where not looked at
    between_angle: float = math.nan  # [rad] the same as an angle
    # [rad] of attitude for which it is inside every limit, the least that was found; 0: exact; nan: not looked for
    least_tolerance: float = math.nan
    closed: Blocking | None = None
    reason: Reason | None = None
    beyond: Beyond | None = None  # where that decided
    tried: tuple[str, ...] = ()  # the attempts at an exact path, in turn

    @property
    def certainty(self) -> Certainty:
        """How sure it is."""
        return CERTAINTY[self.decided_by]

    @property
    def how_sure(self) -> str:
        """What that rests on, in words."""
        words = _rests(self.decided_by, self.closed, self.tried)
        return words[0].upper() + words[1:]


@dataclass(frozen=True)
class Margins:
    """The smallest distance to each limit, (4, 2) a kind: value and time [s]; inf and nan where there is no limit.

    Positions [rad], rates [rad/s], accelerations [rad/s^2], jerks [rad/s^3]; negative outside. `singularity` is
    (value, time) of the smallest `singularity_measure`.
    """

    position: Array
    rate: Array
    acceleration: Array
    jerk: Array
    singularity: tuple[float, float]


def margins(time: Array, angles: Array, rig: Rig) -> Margins:
    """Margins of angles (n, 4) [rad] at time (n,) [s]."""
    n = len(time)
    tables = [np.tile([math.inf, math.nan], (4, 1)) for _ in LIMITS]
    nearest = (math.inf, math.nan)
    for begin in range(0, n, CHUNK):
        part = slice(begin, min(n, begin + CHUNK + 3))
        t, x = time[part], angles[part]
        measure = singularity_measures(x)
        k = int(np.argmin(measure))
        if rig.geometry.redundant and measure[k] < nearest[0]:
            nearest = (float(measure[k]), float(t[k]))
        room = [np.minimum(x - rig.position_min, rig.position_max - x)]
        if len(t) > 1:
            rate, acceleration = differences(t, x)
            room += [rig.max_rate - np.abs(rate), rig.max_acceleration - np.abs(acceleration)]
            if rig.jerk_limited and len(t) > 3:
                room.append(rig.max_jerk - np.abs(jerks(t, acceleration)))
        for kind, values in enumerate(room):
            for i in rig.geometry.frames:
                if not values.shape[0] or not np.isfinite(values[0, i]):
                    continue
                k = int(np.argmin(values[:, i]))
                if values[k, i] < tables[kind][i, 0]:
                    tables[kind][i] = values[k, i], t[k + (0, 1, 1, 2)[kind]]
    for table in tables:
        table.setflags(write=False)
    return Margins(tables[0], tables[1], tables[2], tables[3], nearest)


@dataclass(frozen=True)
class Between:
    """Half-way between samples: angles and attitude interpolated by cubics through four samples, in real time.

    `matrix` is the largest entry of F - C, `angle` [rad] the same as an angle, nan for a flight of fewer samples.
    `violation` is how far beyond a limit the cubics go at most ([rad], or a share of a rate or acceleration limit; 0
    inside), `frame` and `limit` (indices of `FRAMES`, `LIMITS`) whose.
    """

    matrix: float = math.nan
    angle: float = math.nan
    violation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    frame: tuple[int, int, int] = (0, 0, 0)

    def sentence(self) -> str:
        """What was found there, and what could not be looked at."""
        if math.isnan(self.matrix):
            return f"Not looked at between samples: fewer than {STENCIL} of them."
        if self.angle > SPARSE:
            text = (
                "The samples are too sparse to say what happens between them: half-way the attitude differs by up to "
                f"{math.degrees(self.angle):.2g} deg"
            )
        else:
            text = f"Half-way between samples the attitude differs by at most {math.degrees(self.angle):.1e} deg"
        passed = [
            f"the {FRAMES[frame]} frame's {LIMITS[kind]} limit is passed by "
            + (f"{math.degrees(violation):.2g} deg" if kind == 0 else f"{100.0 * violation:.2g} %")
            for kind, (violation, frame) in enumerate(zip(self.violation, self.frame, strict=True))
            if violation > (OVERSHOOT if kind else CLEAR)
        ]
        return f"{text}; {', '.join(passed) if passed else 'the limits hold'} (by cubics through {STENCIL} samples)."


@dataclass(frozen=True)
class Check:
    """The independent check of a plan: errors (n,) at every sample, limits exceeded, and what is between samples."""

    error: Array  # (n,) [rad]
    matrix_error: Array  # (n,)
    violations: tuple[Violation, ...]
    between: Between


def check(time: Array, attitude: Array, angles: Array, rig: Rig) -> Check:
    """Check a whole flight by `fullpose.verify`, which shares nothing with the planner; an hour in pieces."""
    n = len(time)
    error, matrix_error = np.empty(n), np.empty(n)
    violations: list[Violation] = []
    for begin in range(0, n, CHUNK):
        end = min(n, begin + CHUNK)
        F = payload_attitudes(rig, angles[begin:end])
        error[begin:end], matrix_error[begin:end] = attitude_errors(F, attitude[begin:end])
        wide = slice(max(0, begin - 2), min(n, end + 2))
        inner = verify(time[wide], angles[wide], rig).violations
        violations += [v for v in inner if time[begin] <= v.time <= time[end - 1]]
    return Check(error, matrix_error, tuple(violations), between_samples(time, attitude, angles, rig))


def _rests(decided_by: Decision, closed: Blocking | None, tried: tuple[str, ...]) -> str:
    told = f" Tried: {', '.join(tried)}." if tried and CERTAINTY[decided_by] is Certainty.EVIDENCE else ""
    return HOW_SURE[decided_by].format(closed=math.nan if closed is None else closed.time) + told


def verdict_on(
    found: Check, rig: Rig, blocking: Blocking | None, decided_by: Decision, grid: float, tried: tuple[str, ...] = ()
) -> Verdict:
    """The verdict on a flight that was checked: what the planner found to close its way, or else what the check did."""
    if blocking is None and found.violations:
        first = found.violations[0]
        blocking = Blocking(first.time, first.frame, first.limit)
        decided_by = Decision.ACCELERATION if rig.geometry.redundant else Decision.THREE_AXIS
    between = found.between
    statement = f"{FEASIBLE.get(decided_by, 'Infeasible')}: {_rests(decided_by, blocking, tried)}"
    if blocking is None:
        statement = f"{statement} {between.sentence()}"
    return Verdict(
        blocking is None, blocking, decided_by, grid, statement, between.matrix, between.angle, closed=blocking,
        tried=tried,
    )  # fmt: skip


def with_reason(verdict: Verdict, reason: Reason | None) -> Verdict:
    """The verdict and the reason for it, which says what blocks an infeasible flight."""
    if reason is None:
        return verdict
    if verdict.feasible:
        return replace(verdict, reason=reason)
    first = reason.first
    return replace(verdict, reason=reason, blocking=Blocking(first.time, first.frame, first.limit))


def with_least_tolerance(verdict: Verdict, found: Check, exact: bool) -> Verdict:
    """The verdict and the least tolerance that was looked for: none where the flight is `exact`."""
    if exact:
        return replace(verdict, least_tolerance=0.0)
    if found.violations:
        return verdict
    tolerance = float(found.error.max())
    said = (
        f"With every frame free the smallest attitude tolerance found that keeps it inside every limit is "
        f"{_rounded_up(math.degrees(tolerance)):g} deg; a wide search, no proof that none is smaller."
    )
    return replace(verdict, least_tolerance=tolerance, statement=f"{verdict.statement} {said}")


def _rounded_up(value: float) -> float:
    """Three digits, never less than the value."""
    if value <= 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.ceil(value / unit) * unit


def between_samples(time: Array, attitude: Array, angles: Array, rig: Rig) -> Between:
    """Every interval of a flight looked at in its middle: time (n,) [s], attitude (n, 3, 3), angles (n, 4) [rad]."""
    n = len(time)
    if n < STENCIL:
        return Between()
    matrix, angle = 0.0, 0.0
    violation, whose = np.zeros(3), np.zeros(3, int)
    for begin in range(0, n - 1, CHUNK):
        interval = np.arange(begin, min(n - 1, begin + CHUNK))
        first = np.clip(interval - 1, 0, n - STENCIL)  # of the four samples; at the ends of the flight, to one side
        weights = _cubic_weights(time[first[:, None] + np.arange(STENCIL)], 0.5 * (time[interval] + time[interval + 1]))
        x, rate, acceleration = (_weighted(w, angles, first) for w in weights)
        gap, entry = attitude_errors(payload_attitudes(rig, x), _weighted(weights[0], attitude, first))
        matrix, angle = max(matrix, float(entry.max())), max(angle, float(gap.max()))
        beyond = (
            np.maximum(x - rig.position_max, rig.position_min - x),
            np.abs(rate) / rig.max_rate - 1.0,
            np.abs(acceleration) / rig.max_acceleration - 1.0,
        )
        for kind, values in enumerate(beyond):
            most = values[:, rig.geometry.frames].max(axis=0)
            i = int(np.argmax(most))
            if most[i] > violation[kind]:
                violation[kind], whose[kind] = most[i], rig.geometry.frames[i]
    beyond_position, beyond_rate, beyond_acceleration = violation.tolist()
    frames = int(whose[0]), int(whose[1]), int(whose[2])
    return Between(matrix, angle, (beyond_position, beyond_rate, beyond_acceleration), frames)


def _cubic_weights(time: Array, at: Array) -> tuple[Array, Array, Array]:
    """Weights (m, 4) of the values at time (m, 4) in a cubic's value, slope and bend at `at` (m,)."""
    t = time - at[:, None]
    value, slope, bend = np.empty_like(t), np.empty_like(t), np.empty_like(t)
    for j in range(STENCIL):
        a, b, c = (t[:, i] for i in range(STENCIL) if i != j)
        product = (t[:, j] - a) * (t[:, j] - b) * (t[:, j] - c)
        value[:, j] = -a * b * c / product
        slope[:, j] = (a * b + b * c + c * a) / product
        bend[:, j] = -2.0 * (a + b + c) / product
    return value, slope, bend


def _weighted(weights: Array, y: Array, first: Integers) -> Array:
    """Sum over j of weights (m, 4) times y[first + j]; y (n, ...)."""
    shape = (-1,) + (1,) * (y.ndim - 1)
    return np.asarray(sum(weights[:, j].reshape(shape) * y[first + j] for j in range(STENCIL)))
