"""What would make a flight fit: a tolerance, flying it slower, turning it by a constant, or raising one limit.

Each remedy is a search over plans and returns the one it ends with, ready to fly: the ways from rest and back to rest
count, too. The trials skip the least-error path of an infeasible flight and, where the samples are dense, look at every
few of them; what is returned is planned anew from all of them (`fullpose.plan.remedy`). A search by halves assumes that
a flight which fits goes on fitting as the factor grows; larger ones are looked at too, and one that fails is told.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from fullpose._typing import Array, Progress
from fullpose.attitude import dcm_from_quaternion, quaternion_from_dcm
from fullpose.errors import InputError
from fullpose.plan.remedy import NOTHING, Remedy, Trials
from fullpose.plan.tolerance_remedy import TRIALS, least_change
from fullpose.plan.verdict import Margins
from fullpose.resample import continuous, resample
from fullpose.rig import FRAMES, LIMITS, FrameLimits, Rig
from fullpose.trajectory.curve import LOCKED
from fullpose.trajectory.options import PlanOptions
from fullpose.vocabulary import RemedyKind

LARGEST_RAISE = 8.0  # times a rate or acceleration limit
SLOW_TRIALS = 20  # at most: 8 up to 16 times, 6 halvings, 2 beyond, 4 of every sample
RELAX_TRIALS = 10  # of one limit at most
RELATIVE = 0.01  # to which factors are found
BEYOND = (
    1.3,
    1.8,
)  # times the factor that was found: looked at too, for a flight that fits slower need not fit slower still
AGAIN = (1.01, 1.05, 1.15)  # times it, where the thinned samples did not show what is wrong
AXES = ("roll", "yaw", "pitch")  # of the body's x, y, z
UP = AXES[1]
OFFSETS = (RemedyKind.HEADING_OFFSET, RemedyKind.MOUNTING_OFFSET)


def slow_down(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, start: ArrayLike | None = None, options: PlanOptions | None = None,
    progress: Progress | None = None, largest: float = 16.0,
) -> Remedy:  # fmt: skip
    """The least factor on the time, within 1 %, that makes the flight feasible; flown at its own sample rate.

    time (n,) [s], attitude (n, 3, 3). The answer where even `largest` does not do is the plan at `largest`, infeasible.
    Raises `CancelledError` from progress, `InputError` as `plan` does.
    """
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    trials = Trials(SLOW_TRIALS, progress, options or PlanOptions(), start)

    def fits(factor: float) -> bool:
        return trials.fits(t[0] + (t - t[0]) * factor, C, rig)

    high = 1.0
    low = 1.0
    while high <= largest and not fits(high):
        low, high = high, high * (1.25 if high < 1.5 else 1.6)
    if high > largest:
        return _slowed(trials, t, C, rig, largest)
    while high / low > 1.0 + RELATIVE:
        middle = math.sqrt(high * low)
        low, high = (low, middle) if fits(middle) else (middle, high)
    fails = next(
        (high * more for more in BEYOND if high > 1.0 and high * more <= largest and not fits(high * more)), None
    )
    remedy = _slowed(trials, t, C, rig, high)
    for more in AGAIN:
        if remedy.plan.ready or high * more > largest:
            break
        remedy = _slowed(trials, t, C, rig, high * more)
    return replace(remedy, fails_again=fails, given_up=trials.given_up)


def _slowed(trials: Trials, t: Array, C: Array, rig: Rig, factor: float) -> Remedy:
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
    trials = Trials(1 + len(axes) * (count - 1) + 4 + 1, progress, options or PlanOptions(), start)

    def room(axis: str, angle: float) -> float:
        made = trials.feasible(t, turned(C, kind, axis, angle), rig)
        return smallest_share(made.margins, rig) if made is not None and made.ready else -math.inf

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
        kind, axis, math.remainder(angle, 2.0 * math.pi), t, attitude_there, rig,
        trials.final(t, attitude_there, rig), given_up=trials.given_up,
    )  # fmt: skip


def smallest_share(margins: Margins, rig: Rig) -> float:
    """The smallest margin of all as a share of its limit (positions: of half the range, locked frames apart)."""
    half = np.where(np.isfinite(rig.position_max), 0.5 * (rig.position_max - rig.position_min), 1.0)
    shares = np.concatenate(
        [
            (margins.position[:, 0] / half)[half > LOCKED],
            (margins.rate[:, 0] / np.where(np.isfinite(rig.max_rate), rig.max_rate, 1.0)),
            (margins.acceleration[:, 0] / np.where(np.isfinite(rig.max_acceleration), rig.max_acceleration, 1.0)),
            (margins.jerk[:, 0] / np.where(np.isfinite(rig.max_jerk), rig.max_jerk, 1.0)),
        ]
    )
    return float(shares.min())


def relax(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, frame: str | None = None, limit: str | None = None,
    start: ArrayLike | None = None, options: PlanOptions | None = None, progress: Progress | None = None,
) -> list[Remedy]:  # fmt: skip
    """Which single limit, raised by how much, would make the flight feasible: the ones that would, least raise first.

    frame, limit: of the rig's frames and `LIMITS`, to look at one alone; None: all. Rates, accelerations and jerks are
    raised up to `LARGEST_RAISE` times, ranges widened on both sides up to a turn in all, to within 1 %. A flight that
    fits as it is has one remedy, `NOTHING`; the list is empty where no single limit is enough. Raises `CancelledError`
    from progress, `InputError` for names that are none.
    """
    present = [FRAMES[i] for i in rig.geometry.frames]
    if frame is not None and frame not in present:
        raise InputError("frame", None, frame, f"one of {', '.join(present)}, the frames of {rig.name}")
    if limit is not None and limit not in LIMITS:
        raise InputError("limit", None, limit, f"one of {', '.join(LIMITS)}")
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    candidates = [(i, kind) for i, kind in _limits(rig) if frame in (None, FRAMES[i]) and limit in (None, LIMITS[kind])]
    trials = Trials(len(candidates) * RELAX_TRIALS + 1, progress, options or PlanOptions(), start)
    found: list[tuple[float, int, int, float | None]] = []
    if trials.fits(t, C, rig):
        made = trials.final(t, C, rig)
        if made.ready:  # else the thinned samples did not show what is wrong
            return [Remedy(RemedyKind.RELAX, NOTHING, 0.0, t, C, rig, made)]
    for number, (i, kind) in enumerate(candidates):
        trials.done = RELAX_TRIALS * number

        def fits(share: float, i: int = i, kind: int = kind) -> bool:
            return trials.fits(t, C, raised(rig, i, kind, share))

        if not fits(1.0):
            continue
        low, high = 0.0, 1.0
        while high - low > RELATIVE:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if fits(middle) else (middle, high)
        between = 0.5 * (high + 1.0)
        found.append((high, i, kind, None if fits(between) else between))
    remedies = []
    for share, i, kind, failing in sorted(found, key=lambda each: each[:3]):
        wider = raised(rig, i, kind, share)
        made = trials.final(t, C, wider)
        if made.ready:
            fails = None if failing is None else _limit_of(raised(rig, i, kind, failing), i, kind)
            what, value = f"{FRAMES[i]} {LIMITS[kind]}", _limit_of(wider, i, kind)
            remedies.append(
                Remedy(RemedyKind.RELAX, what, value, t, C, wider, made, fails_again=fails, given_up=trials.given_up)
            )
    return remedies


def _limit_of(rig: Rig, frame: int, kind: int) -> float:
    return float((rig.position_max, rig.max_rate, rig.max_acceleration, rig.max_jerk)[kind][frame])


def tolerance(
    time: ArrayLike, attitude: ArrayLike, rig: Rig, start: ArrayLike | None = None, options: PlanOptions | None = None,
    progress: Progress | None = None,
) -> Remedy:  # fmt: skip
    """The least tolerance that was found for which the flight fits; `Remedy.deviation` is what it costs.

    Of a recorded flight whose noise matters, what the recording added is taken away first. The search for an exact path
    is one trial, which a caller may give up; the least tolerance, which takes time in proportion to the flight, is the
    other. Raises `CancelledError` from
    progress, `InputError` as `plan` does.
    """
    t, C = np.asarray(time, float), np.asarray(attitude, float)
    return least_change(t, C, rig, Trials(TRIALS, progress, options or PlanOptions(), start))


def _limits(rig: Rig) -> Iterator[tuple[int, int]]:
    """(frame, kind) of every limit that the rig has and that can be raised."""
    for i in rig.geometry.frames:
        present = (
            not rig.frames[i].continuous,
            math.isfinite(rig.frames[i].max_rate),
            math.isfinite(rig.frames[i].max_acceleration),
            math.isfinite(rig.frames[i].max_jerk),
        )
        for kind in range(len(LIMITS)):
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
    elif kind == 2:
        limits = replace(limits, max_acceleration=limits.max_acceleration * factor)
    else:
        limits = replace(limits, max_jerk=limits.max_jerk * factor)
    frames = list(rig.frames)
    frames[frame] = limits
    return replace(
        rig,
        name=f"{rig.name}, {FRAMES[frame]} {LIMITS[kind]} raised",
        frames=(frames[0], frames[1], frames[2], frames[3]),
    )
