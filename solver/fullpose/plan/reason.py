"""Why a flight is not flown exactly, as an operator would tell it: which frame reaches which limit first, and what the
attitude would ask for from there.

Both are read from the angles as they are written, so that they agree with the plot. First: the limit that a frame is on
where the attitude is given up. Then: with that frame's angles as they are written, the attitude leaves the others no
choice but a branch (`held_frame`); the first limit that this exact path exceeds is named, with what it would need.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array, Integers
from fullpose.plan.held_frame import NO_POSE, held_frame
from fullpose.plan.three_axis import three_axis_path
from fullpose.rig import FRAMES, LIMITS, Frame, Limit, Rig
from fullpose.trajectory.curve import LOCKED
from fullpose.verify import differences, jerks, verify
from fullpose.vocabulary import Consequence

AT_LIMIT = 0.02  # share of a rate or acceleration limit within which a frame is on it
AT_STOP = math.radians(0.05)  # of a position limit
BEFORE = 0.5  # [s] before there is no pose at all: rates rise without bound there, and are not told
AROUND = 0.25  # [s] looked at before and after a stretch that misses the attitude
BRIDGED = 0.05  # [s] off a limit that do not end the time on it, or between two stretches
STRETCHES = 50  # looked at
LONGEST = 60.0  # [s] of a stretch
LEAD = 0.3  # [s] before the search's end that counts as about then
TOGETHER = 0.1  # [s] after the first limit that is exceeded: of those in it a stop is told before a rate, and so on


@dataclass(frozen=True)
class FrameAtLimit:
    """A frame and one of its limits [rad, rad/s, rad/s^2, rad/s^3]: the value with its sign, and the bound it is at.

    Of what the attitude would need the value is that, which exceeds the bound; of a frame that would itself have to be
    elsewhere, `bound` is the angle that it has then.
    """

    time: float
    frame: Frame
    limit: Limit
    value: float
    bound: float


@dataclass(frozen=True)
class Reason:
    """What happens first and what then; `then` is None where no single limit tells it."""

    first: FrameAtLimit
    then: FrameAtLimit | None
    consequence: Consequence


@dataclass(frozen=True)
class _Stretch:
    """A stretch of the flight around samples that miss the attitude."""

    time: Array
    attitude: Array
    angles: Array
    rig: Rig
    onset: float  # [s] what is needed from here on is told


def reason_of(
    time: Array, attitude: Array, angles: Array, missed: NDArray[np.bool_], rig: Rig, closed: float = -math.inf
) -> Reason | None:
    """The reason for the samples `missed` (n,) of angles (n, 4) [rad]; None where no frame is on a limit near them.

    `closed` [s]: up to there an exact path was found, so what is told is what happens about then, if anything does.
    """
    vague: Reason | None = None
    for after in (closed - LEAD, -math.inf) if math.isfinite(closed) else (closed,):
        for stretch in _stretches(time, attitude, angles, missed, rig, after):
            told = _told(stretch)
            if told is not None and told.then is not None:
                return told
            vague = vague or told
    return vague


def _stretches(
    time: Array, attitude: Array, angles: Array, missed: NDArray[np.bool_], rig: Rig, after: float
) -> Iterator[_Stretch]:
    """The stretches around the samples `missed` that last until `after` [s] at least."""
    runs = [(begin, end) for begin, end in _runs(time, np.flatnonzero(missed)) if time[end] >= after]
    for begin, end in runs[:STRETCHES]:
        first = min(max(0, begin - 2), int(np.searchsorted(time, time[begin] - AROUND)))
        until = min(time[end] + AROUND, max(time[begin], after) + LONGEST)
        part = slice(first, max(begin + 3, int(np.searchsorted(time, until, side="right"))))
        yield _Stretch(time[part], attitude[part], angles[part], rig, max(float(time[begin]), after))


def _told(stretch: _Stretch) -> Reason | None:
    """The frame whose limit is the nearest before what cannot be had; positions before rates before accelerations."""
    best: tuple[tuple[int, int, float], Reason] | None = None
    earliest: FrameAtLimit | None = None
    for frame in _free(stretch.rig):
        for limit in range(len(LIMITS)):
            for reached, left in _on_limit(stretch, frame, limit):
                if earliest is None or reached.time < earliest.time:
                    earliest = reached
                needed = _needed(stretch, frame, limit)
                if needed is None or reached.time > needed.time:
                    continue
                consequence = Consequence.SAME_FRAME if needed.frame == reached.frame else Consequence.ANOTHER_FRAME
                off = int(max(0.0, needed.time - left) / TOGETHER)
                rank = off, len(LIMITS) if _late(reached, needed) else limit, abs(needed.value)
                if best is None or rank < best[0]:
                    best = rank, Reason(reached, needed, consequence)
    if best is not None:
        return best[1]
    return None if earliest is None else Reason(earliest, None, Consequence.NOT_NAMED)


def _late(reached: FrameAtLimit, needed: FrameAtLimit) -> bool:
    """Whether a frame that is too slow would have to be elsewhere: it tells less than what another would need."""
    return needed.frame == reached.frame and needed.limit == Limit.POSITION != reached.limit


def _free(rig: Rig) -> list[int]:
    """The frames that have room to move; where none has, all."""
    room = rig.position_max - rig.position_min
    return [i for i in rig.geometry.frames if room[i] > LOCKED] or list(rig.geometry.frames)


def _on_limit(stretch: _Stretch, frame: int, limit: int) -> Iterator[tuple[FrameAtLimit, float]]:
    """The times that a frame is on a limit: when it reaches it, and when it leaves it [s]."""
    rig, time, x = stretch.rig, stretch.time, stretch.angles[:, frame]
    if limit == 0:
        if rig.frames[frame].continuous:
            return
        value, when = x, time
        low, high = rig.position_min[frame], rig.position_max[frame]
        bound = np.where(high - x < x - low, high, low)
        on = np.abs(value - bound) <= AT_STOP
    else:
        if len(time) < 1 + limit:
            return
        most = (rig.max_rate, rig.max_acceleration, rig.max_jerk)[limit - 1][frame]
        rate, acceleration = differences(time, stretch.angles)
        of = rate if limit == 1 else acceleration if limit == 2 else jerks(time, acceleration)
        value, when = of[:, frame], (time[1:], time[1:-1], time[2:-1])[limit - 1]
        bound = np.copysign(most, value)
        on = np.isfinite(most) & (np.abs(value) >= (1.0 - AT_LIMIT) * most)
    for begin, end in _runs(when, np.flatnonzero(on)):
        yield (
            FrameAtLimit(float(when[begin]), FRAMES[frame], LIMITS[limit], float(value[begin]), float(bound[begin])),
            float(when[end]),
        )


def _runs(time: Array, at: Integers) -> list[tuple[int, int]]:
    """(first, last) of the samples `at` that follow one another, or are apart by `BRIDGED` at most."""
    if not at.size:
        return []
    breaks = np.flatnonzero((np.diff(time[at]) > BRIDGED) & (np.diff(at) > 1))
    return list(zip(at[np.r_[0, breaks + 1]].tolist(), at[np.r_[breaks, -1]].tolist(), strict=True))


def _needed(stretch: _Stretch, frame: int, limit: int) -> FrameAtLimit | None:
    """The first limit that the exact path with this frame's angles exceeds; where that is only that a frame without
    room to move has to stay, what the frame itself would need for it."""
    rig = stretch.rig
    if not rig.geometry.redundant:
        return _first(stretch, three_axis_path(stretch.time, stretch.attitude, rig, stretch.angles[0]))
    needed = _beside(stretch, frame)
    if needed is None or limit == 0 or FRAMES.index(needed.frame) in _free(rig):
        return needed
    itself = _beside(stretch, FRAMES.index(needed.frame))
    return itself if itself is not None and itself.frame == FRAMES[frame] else needed


def _beside(stretch: _Stretch, frame: int) -> FrameAtLimit | None:
    """What the exact path with this frame's angles needs first: of others, or that the frame were elsewhere."""
    held = held_frame(stretch.rig, stretch.attitude, stretch.angles, frame)
    off = np.abs(held.nearest - stretch.angles[:, frame])
    without = np.flatnonzero(off > NO_POSE)
    n = int(without[0]) if without.size else len(off)
    open_ended = np.flatnonzero(~held.exists[:n])
    if open_ended.size:  # a pose exists, but the frame does not say which
        return None
    found = _first(stretch, held.angles[:n]) if n else None
    if not without.size or (found is not None and found.time < stretch.time[n] - BEFORE):
        return found
    run = without[: 1 + int(np.argmax(np.diff(np.r_[without, len(off) + 1]) > 1))]
    k = int(run[np.argmax(off[run])])
    there, here = float(held.nearest[k]), float(stretch.angles[k, frame])
    return FrameAtLimit(float(stretch.time[k]), FRAMES[frame], Limit.POSITION, there, here)


def _first(stretch: _Stretch, path: Array) -> FrameAtLimit | None:
    """The first of the limits that path (m, 4) [rad], from the stretch's beginning on, exceeds, at its worst."""
    rig = stretch.rig
    found = verify(stretch.time[: len(path)], path, rig).violations
    exceeded = [v for v in found if v.time >= stretch.onset - BRIDGED]
    if not exceeded:
        return None
    soon = [v for v in exceeded if v.time <= exceeded[0].time + TOGETHER]
    first = min(soon, key=lambda v: LIMITS.index(v.limit))
    i = FRAMES.index(first.frame)
    if first.limit == Limit.POSITION:
        bound = rig.position_max[i] if first.value > rig.position_max[i] else rig.position_min[i]
    else:
        bound = math.copysign(
            (rig.max_rate, rig.max_acceleration, rig.max_jerk)[LIMITS.index(first.limit) - 1][i], first.value
        )
    return FrameAtLimit(first.time, first.frame, first.limit, first.value, float(bound))
