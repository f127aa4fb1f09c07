"""What would make a flight fit: flying it slower, turning it by a constant, or raising one limit.

Each remedy is a search over plans and returns the one it ends with, ready to fly: the ways from rest and back to rest
count, too. The trials skip the least-error path of an infeasible flight and, where the samples are dense, look at every
few of them; what is returned is planned anew from all of them. `progress(done, total)` counts trials and may raise
`CancelledError`.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Progress
from fullpose.attitude import dcm_from_quaternion, quaternion_from_dcm
from fullpose.errors import InputError
from fullpose.plan.plan import Plan, plan
from fullpose.plan.verdict import Margins
from fullpose.resample import continuous, resample
from fullpose.rig import FRAMES, LIMITS, FrameLimits, Rig
from fullpose.trajectory.curve import LOCKED
from fullpose.trajectory.options import PlanOptions
from fullpose.vocabulary import RemedyKind

TRIAL_INTERVAL = 0.005  # [s] between the samples that a trial looks at
LARGEST_RAISE = 8.0  # times a rate or acceleration limit
RELATIVE = 0.01  # to which factors are found
NOTHING = "nothing"  # what is changed of a flight that fits as it is, where limits are raised
AXES = ("roll", "yaw", "pitch")  # of the body's x, y, z
UP = AXES[1]
OFFSETS = (RemedyKind.HEADING_OFFSET, RemedyKind.MOUNTING_OFFSET)


@dataclass(frozen=True)
class Remedy:
    """A remedy: what was changed and by how much, and the flight, rig and plan that come of it.

    `value` is the factor on the time of a slow-down; an offset's angle [rad], `what` being the axis; or the new limit,
    `what` being frame and limit (`NOTHING`, value 0, where none need be raised). `plan.ready` says whether it suffices.
    """

    kind: RemedyKind
    what: str
    value: float
    time: Array  # (n,) [s]
    attitude: Array  # (n, 3, 3)
    rig: Rig
    plan: Plan


@dataclass
class _Trials:
    """Counts trials for the progress callback and plans them."""

    total: int
    progress: Progress | None
    options: PlanOptions
    start: ArrayLike | None
    done: int = 0

    @property
    def quick(self) -> PlanOptions:
        """The options of a trial."""
        return replace(self.options, best_effort=False, alternatives=min(2, self.options.alternatives))

    def feasible(self, time: Array, attitude: Array, rig: Rig) -> Plan:
        """A trial: a plan without best effort, on the thinned samples."""
        self.done += 1
        if self.progress is not None:
            self.progress(min(self.done, self.total), self.total)
        part = slice(None, None, _stride(time))
        return plan(time[part], attitude[part], rig, self.start, options=self.quick)

    def final(self, time: Array, attitude: Array, rig: Rig) -> Plan:
        """The plan that is returned, from every sample."""
        made = plan(time, attitude, rig, self.start, options=self.options)
        if self.progress is not None:
            self.progress(self.total, self.total)
        return made


def _stride(time: Array) -> int:
    n = len(time)
    return max(1, int(TRIAL_INTERVAL * (n - 1) / (time[-1] - time[0]))) if n > 16 else 1


def slow_down(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, start: ArrayLike | None = None, options: PlanOptions | None = None,
    progress: Progress | None = None, largest: float = 16.0,
) -> Remedy:  # fmt: skip
    """The least factor on the time, within 1 %, that makes the flight feasible; flown at its own sample rate.

    time (n,) [s], attitude (n, 3, 3). The answer where even `largest` does not do is the plan at `largest`, infeasible.
    Raises `CancelledError` from progress, `InputError` as `plan` does.
    """
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    trials = _Trials(2 + math.ceil(math.log2(largest)) + 8, progress, options or PlanOptions(), start)

    def fits(factor: float) -> bool:
        return trials.feasible(t[0] + (t - t[0]) * factor, C, rig).ready

    high = 1.0
    low = 1.0
    while high <= largest and not fits(high):
        low, high = high, high * (1.25 if high < 1.5 else 1.6)
    if high > largest:
        return _slowed(trials, t, C, rig, largest)
    while high / low > 1.0 + RELATIVE:
        middle = math.sqrt(high * low)
        low, high = (low, middle) if fits(middle) else (middle, high)
    remedy = _slowed(trials, t, C, rig, high)
    while not remedy.plan.ready and high < largest:  # what the thinned samples did not show
        high *= 1.0 + RELATIVE
        remedy = _slowed(trials, t, C, rig, high)
    return remedy


def _slowed(trials: _Trials, t: Array, C: Array, rig: Rig, factor: float) -> Remedy:
    """The flight in `factor` times its time, at its own sample rate (by quaternion spline), planned."""
    slow = t[0] + (t - t[0]) * factor
    if factor == 1.0 or len(t) < 3:
        return Remedy(RemedyKind.SLOW_DOWN, "time", factor, slow, C, rig, trials.final(slow, C, rig))
    again = resample(slow, continuous(quaternion_from_dcm(C)), (len(t) - 1) / float(t[-1] - t[0]))
    attitude = dcm_from_quaternion(again.q)
    return Remedy(
        RemedyKind.SLOW_DOWN, "time", factor, again.time, attitude, rig, trials.final(again.time, attitude, rig)
    )


def turned(attitude: Array, kind: RemedyKind, axis: str, angle: float) -> Array:
    """The flight turned by a constant: its heading about the up axis, C R; its mounting about `axis`, R C."""
    if kind == RemedyKind.HEADING_OFFSET:
        return np.asarray(attitude @ _elementary(1, angle))
    return np.asarray(_elementary(AXES.index(axis), angle) @ attitude)


def _elementary(axis: int, angle: float) -> Array:
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = math.cos(angle)
    R[i, j], R[j, i] = math.sin(angle), -math.sin(angle)
    return R


def offset(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, kind: RemedyKind = RemedyKind.HEADING_OFFSET,
    start: ArrayLike | None = None, options: PlanOptions | None = None, progress: Progress | None = None,
    step: float = math.radians(30.0),
) -> Remedy:  # fmt: skip
    """The constant offset that makes the flight feasible with the most margin, of those tried.

    kind: `HEADING_OFFSET` (the flight turned about the vertical) or `MOUNTING_OFFSET` (the payload about a body axis).
    Offsets every `step` [rad] are tried, then half and a quarter of it around the best. Infeasible where none fits.
    Raises `InputError` for another kind, `CancelledError` from progress.
    """
    if kind not in OFFSETS:
        raise InputError("kind", None, kind, " or ".join(OFFSETS))
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    axes = (UP,) if kind == RemedyKind.HEADING_OFFSET else AXES
    count = max(2, round(2.0 * math.pi / step))
    trials = _Trials(1 + len(axes) * (count - 1) + 4 + 1, progress, options or PlanOptions(), start)

    def room(axis: str, angle: float) -> float:
        made = trials.feasible(t, turned(C, kind, axis, angle), rig)
        return smallest_share(made.margins, rig) if made.ready else -math.inf

    best = (room(axes[0], 0.0), axes[0], 0.0)
    for axis in axes:
        for k in range(1, count):
            best = max(best, (room(axis, k * step), axis, k * step))
    for finer in (0.5 * step, 0.25 * step):
        if best[0] == -math.inf:
            break
        _, axis, angle = best
        for other in (angle - finer, angle + finer):
            best = max(best, (room(axis, other), axis, other))
    _, axis, angle = best
    attitude_there = turned(C, kind, axis, angle)
    return Remedy(
        kind, axis, math.remainder(angle, 2.0 * math.pi), t, attitude_there, rig, trials.final(t, attitude_there, rig)
    )


def smallest_share(margins: Margins, rig: Rig) -> float:
    """The smallest margin of all as a share of its limit (positions: of half the range, locked frames apart)."""
    half = np.where(np.isfinite(rig.position_max), 0.5 * (rig.position_max - rig.position_min), 1.0)
    shares = np.concatenate(
        [
            (margins.position[:, 0] / half)[half > LOCKED],
            (margins.rate[:, 0] / np.where(np.isfinite(rig.max_rate), rig.max_rate, 1.0)),
            (margins.acceleration[:, 0] / np.where(np.isfinite(rig.max_acceleration), rig.max_acceleration, 1.0)),
        ]
    )
    return float(shares.min())


def relax(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, frame: str | None = None, limit: str | None = None,
    start: ArrayLike | None = None, options: PlanOptions | None = None, progress: Progress | None = None,
) -> list[Remedy]:  # fmt: skip
    """Which single limit, raised by how much, would make the flight feasible: the ones that would, least raise first.

    frame, limit: of the rig's frames and `LIMITS`, to look at one alone; None: all. Rates and accelerations are raised
    up to `LARGEST_RAISE` times, ranges widened on both sides up to a turn in all, to within 1 %. A flight that fits as
    it is has one remedy, `NOTHING`; the list is empty where no single limit is enough. Raises `CancelledError` from
    progress, `InputError` for names that are none.
    """
    present = [FRAMES[i] for i in rig.geometry.frames]
    if frame is not None and frame not in present:
        raise InputError("frame", None, frame, f"one of {', '.join(present)}, the frames of {rig.name}")
    if limit is not None and limit not in LIMITS:
        raise InputError("limit", None, limit, f"one of {', '.join(LIMITS)}")
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    candidates = [(i, kind) for i, kind in _limits(rig) if frame in (None, FRAMES[i]) and limit in (None, LIMITS[kind])]
    trials = _Trials(len(candidates) * 10 + 1, progress, options or PlanOptions(), start)
    found: list[tuple[float, int, int]] = []
    if trials.feasible(t, C, rig).ready:
        made = trials.final(t, C, rig)
        if made.ready:  # else the thinned samples did not show what is wrong
            return [Remedy(RemedyKind.RELAX, NOTHING, 0.0, t, C, rig, made)]
    for number, (i, kind) in enumerate(candidates):
        trials.done = 10 * number

        def fits(share: float, i: int = i, kind: int = kind) -> bool:
            return trials.feasible(t, C, raised(rig, i, kind, share)).ready

        if not fits(1.0):
            continue
        low, high = 0.0, 1.0
        while high - low > RELATIVE:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if fits(middle) else (middle, high)
        found.append((high, i, kind))
    remedies = []
    for share, i, kind in sorted(found):
        wider = raised(rig, i, kind, share)
        value = (wider.position_max, wider.max_rate, wider.max_acceleration)[kind][i]
        made = trials.final(t, C, wider)
        if made.ready:
            remedies.append(Remedy(RemedyKind.RELAX, f"{FRAMES[i]} {LIMITS[kind]}", float(value), t, C, wider, made))
    return remedies


def _limits(rig: Rig) -> Iterator[tuple[int, int]]:
    """(frame, kind) of every limit that the rig has and that can be raised."""
    for i in rig.geometry.frames:
        present = (
            not rig.frames[i].continuous,
            math.isfinite(rig.frames[i].max_rate),
            math.isfinite(rig.frames[i].max_acceleration),
        )
        for kind in range(3):
            if present[kind]:
                yield i, kind


def raised(rig: Rig, frame: int, kind: int, share: float, largest: float = LARGEST_RAISE) -> Rig:
    """The rig with one limit raised by `share` (0..1) of the way to `largest` times it (ranges: to one turn more)."""
    limits: FrameLimits = rig.frames[frame]
    factor = largest**share
    if kind == 0:
        limits = replace(limits, min=limits.min - math.pi * share, max=limits.max + math.pi * share)
    elif kind == 1:
        limits = replace(limits, max_rate=limits.max_rate * factor)
    else:
        limits = replace(limits, max_acceleration=limits.max_acceleration * factor)
    frames = list(rig.frames)
    frames[frame] = limits
    return replace(
        rig,
        name=f"{rig.name}, {FRAMES[frame]} {LIMITS[kind]} raised",
        frames=(frames[0], frames[1], frames[2], frames[3]),
    )
