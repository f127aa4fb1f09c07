"""Remedies by name: what would make a flight fit a rig, and in words what was changed. Degrees and seconds."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic as clock
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.errors import OutOfTimeError
from fullpose.plan import PlanOptions
from fullpose.plan.impossible import beyond_all_frames
from fullpose.plan.recorded_noise import recorded_noise
from fullpose.plan.remedies import offset, relax, slow_down, tolerance
from fullpose.plan.remedy import NOTHING, Remedy
from fullpose.recorded import Smoothed
from fullpose.recorded.tube import rounded_up
from fullpose.rig import FRAMES, Rig
from fullpose.vocabulary import RemedyKind
from fullpose_server.errors import NoRemedyError
from fullpose_server.formats.reason_text import UNITS
from fullpose_server.planning.remedy_request import RemedyRequest

TRIAL_S = 15.0  # of one trial
SEARCH_S = 120.0  # of all trials of a search; the plan that is returned comes on top


@dataclass(frozen=True)
class Found:
    """The remedy that is taken, and the others that would do as well (`relax` only), in words."""

    remedy: Remedy
    described: dict[str, Any]


def find_remedy(
    asked: RemedyRequest,
    time: Array,
    attitude: Array,
    rig: Rig,
    *,
    start: Array | None = None,
    options: PlanOptions | None = None,
    progress: Callable[[int, int], None] | None = None,
    smoothed: Smoothed | None = None,
) -> Found:
    """Search the remedy that is asked for, for time (n,) [s], attitude (n, 3, 3).

    `described`: kind, what, value, unit, statement, cost, sufficient, alternatives. A remedy that does not suffice is
    returned too, but for `relax`, which raises `NoRemedyError`. A flight that fits as it is is returned so, of every
    kind. smoothed: what was taken away of the flight before. Raises `SolverError`, and `ServerError` for names that are
    none.
    """
    asked.check(rig)
    kind, frame, limit = RemedyKind(asked.kind), asked.frame, asked.limit
    watched = Watched(progress)
    match kind:
        case RemedyKind.TOLERANCE:
            found = [tolerance(time, attitude, rig, start, options, watched)]
        case RemedyKind.SLOW_DOWN:
            found = [slow_down(time, attitude, rig, start, options, watched)]
        case RemedyKind.HEADING_OFFSET | RemedyKind.MOUNTING_OFFSET:
            found = [offset(time, attitude, rig, kind, start, options, watched)]
        case RemedyKind.RELAX:
            found = relax(time, attitude, rig, frame, limit, start, options, watched)
    if not found:
        where = " ".join(filter(None, (frame, limit))) or "single"
        raise NoRemedyError(
            f"no {where} limit, raised, makes this flight fit {rig.name}{watched.told()}: slow it down, turn it, or "
            "give it a tolerance"
        )
    first, *others = (_described(kind, remedy, rig, float(time[-1] - time[0]), smoothed) for remedy in found)
    sufficient = found[0].plan.ready
    return Found(found[0], {"kind": kind.value, **first, "sufficient": sufficient, "alternatives": others})


class Watched:
    """Progress of a search that gives up a trial which takes longer than `TRIAL_S`, and all after `SEARCH_S`."""

    def __init__(self, progress: Callable[[int, int], None] | None) -> None:
        self._progress = progress
        self._trial, self._began = -1, clock()
        self._end = self._began + SEARCH_S
        self._given_up = 0

    def __call__(self, done: int, total: int) -> None:
        """Pass it on. Raises `OutOfTimeError`."""
        if self._progress is not None:
            self._progress(done, total)
        now = clock()
        if done != self._trial:
            self._trial, self._began = done, now
        if done < total and (now > self._began + TRIAL_S or now > self._end):
            self._given_up += 1
            raise OutOfTimeError(f"a trial took more than {TRIAL_S:g} s, or all of them more than {SEARCH_S:g} s")

    def told(self) -> str:
        """How many trials were given up, in words."""
        return f" ({self._given_up} trials took too long and count as failed)" if self._given_up else ""


def refuse_noise(asked: RemedyRequest, time: Array, attitude: Array, rig: Rig) -> None:
    """Raise `NoRemedyError` where a flight needs more of the frames for its noise than all of them have together.

    Nothing but a tolerance helps it then, and no search needs to be begun to say so.
    """
    if asked.kind == RemedyKind.TOLERANCE or beyond_all_frames(time, attitude, rig) is None:
        return
    smoothed = recorded_noise(time, attitude)
    if smoothed is None:
        return
    suggested = math.degrees(smoothed.suggested)
    raise NoRemedyError(
        f"how this flight was recorded asks for more acceleration than all frames of {rig.name} have together, which "
        f"is no matter of speed, heading or one limit: first a tolerance, {suggested:.2g} deg takes that away (remedy "
        "tolerance)"
    )


def _described(
    kind: RemedyKind, remedy: Remedy, rig: Rig, duration: float, smoothed: Smoothed | None
) -> dict[str, Any]:
    """what, value, unit, statement, cost."""
    told = _changed(kind, remedy, rig, duration, smoothed)
    if remedy.fails_again is not None:
        value = remedy.fails_again if kind == RemedyKind.SLOW_DOWN else math.degrees(remedy.fails_again)
        told["statement"] += f"; more is not always enough: at {value:.4g} {told['unit']} it fails again"
    if remedy.given_up:
        told["statement"] += f"; {remedy.given_up} trials took too long and count as failed"
    return told


def _changed(kind: RemedyKind, remedy: Remedy, rig: Rig, duration: float, smoothed: Smoothed | None) -> dict[str, Any]:
    value = remedy.value
    if kind == RemedyKind.SLOW_DOWN:
        longer = (value - 1.0) * duration
        said = f"flown {value:.4g} times as slow, {longer:.3g} s ({100.0 * (value - 1.0):.3g} %) longer"
        said = "flown as it is" if value == 1.0 else said
        cost = {"longer_s": longer, "longer_percent": 100.0 * (value - 1.0)}
        return {"what": remedy.what, "value": value, "unit": "times", "statement": said, "cost": cost}
    angle = math.degrees(value)
    if kind == RemedyKind.TOLERANCE:
        return _tolerated(remedy, smoothed)
    if remedy.what == NOTHING:
        said, cost = "flown as it is: no limit need be raised", {"raised_by": 0.0}
        return {"what": NOTHING, "value": 0.0, "unit": "deg", "statement": said, "cost": cost}
    if kind != RemedyKind.RELAX:
        turned = "the whole flight" if kind == RemedyKind.HEADING_OFFSET else "the payload in its mount"
        said = f"{turned} turned by {angle:.4g} deg of {remedy.what}" if value else f"{turned} as it is"
        cost = {"turned_deg": abs(angle)}
        return {"what": remedy.what, "value": angle, "unit": "deg", "statement": said, "cost": cost}
    frame, limit = remedy.what.split()
    index = FRAMES.index(frame)
    before, after = rig.frames[index], remedy.rig.frames[index]
    if limit == "position":
        old, new = (_range(limits.min, limits.max) for limits in (before, after))
        more = math.degrees(after.max - before.max)
        said = f"the {frame} frame's range widened from {old} to {new} deg, {more:.3g} deg more on each side"
    else:
        held = math.degrees(getattr(before, f"max_{limit}"))
        more = angle - held
        said = (
            f"the {frame} frame's {limit} limit raised from {held:.4g} to {angle:.4g} {UNITS[limit]}, by {more:.3g} "
            f"({100.0 * more / held:.3g} %)"
        )
    return {
        "what": remedy.what, "value": angle, "unit": UNITS[limit], "statement": said, "cost": {"raised_by": more},
    }  # fmt: skip


def _tolerated(remedy: Remedy, smoothed: Smoothed | None) -> dict[str, Any]:
    off = np.zeros(1) if remedy.deviation is None else remedy.deviation
    most, rms, value = float(off.max()), float(np.sqrt(np.mean(off**2))), remedy.value
    if smoothed is not None:  # what was taken away before, and what the limits cost on top, at most
        most, rms = smoothed.max_deviation + most, math.hypot(smoothed.rms_deviation, rms)
        value = max(smoothed.suggested, rounded_up(most))
    angle = math.degrees(value)
    cost = {"deviation_max_deg": math.degrees(most), "deviation_rms_deg": math.degrees(rms)}
    if not value:
        said = "flown as it is: no tolerance is needed"
        return {"what": NOTHING, "value": 0.0, "unit": "deg", "statement": said, "cost": cost}
    said = (
        f"flown within a tolerance of {angle:.3g} deg: off the flight as given by "
        f"{cost['deviation_max_deg']:.3g} deg at most, {cost['deviation_rms_deg']:.3g} deg rms"
    )
    return {"what": "attitude", "value": angle, "unit": "deg", "statement": said, "cost": cost}


def tolerated(described: dict[str, Any]) -> dict[str, Any]:
    """The keys of a report of a flight that the remedy tolerance made fit."""
    most, rms = described["cost"]["deviation_max_deg"], described["cost"]["deviation_rms_deg"]
    return {
        "tolerance_deg": described["value"],
        "within_tolerance": True,
        "deviation_deg": {"max": most, "rms": rms},
        "max_error_deg": most,
    }


def _range(low: float, high: float) -> str:
    return f"{math.degrees(low):.4g}..{math.degrees(high):.4g}"
