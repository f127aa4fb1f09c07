"""Remedies by name: what would make a flight fit a rig, and in words what was changed. Degrees and seconds."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fullpose._typing import Array
from fullpose.plan import PlanOptions
from fullpose.plan.remedies import NOTHING, Remedy, offset, relax, slow_down
from fullpose.rig import FRAMES, Rig
from fullpose.vocabulary import RemedyKind
from fullpose_server.errors import NoRemedyError
from fullpose_server.formats.reason_text import UNITS
from fullpose_server.planning.remedy_request import RemedyRequest


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
) -> Found:
    """Search the remedy that is asked for, for time (n,) [s], attitude (n, 3, 3).

    `described`: kind, what, value, unit, statement, sufficient, alternatives. A remedy that does not suffice is
    returned too, but for `relax`, which raises `NoRemedyError`. A flight that fits as it is is returned so, of every
    kind. Raises `SolverError`, `ServerError` for names that are none.
    """
    asked.check(rig)
    kind, frame, limit = RemedyKind(asked.kind), asked.frame, asked.limit
    match kind:
        case RemedyKind.SLOW_DOWN:
            found = [slow_down(time, attitude, rig, start, options, progress)]
        case RemedyKind.HEADING_OFFSET | RemedyKind.MOUNTING_OFFSET:
            found = [offset(time, attitude, rig, kind, start, options, progress)]
        case RemedyKind.RELAX:
            found = relax(time, attitude, rig, frame, limit, start, options, progress)
    if not found:
        where = " ".join(filter(None, (frame, limit))) or "single"
        raise NoRemedyError(f"no {where} limit, raised, makes this flight fit {rig.name}: slow it down or turn it")
    first, *others = (_described(kind, remedy, rig) for remedy in found)
    sufficient = found[0].plan.ready
    return Found(found[0], {"kind": kind.value, **first, "sufficient": sufficient, "alternatives": others})


def _described(kind: RemedyKind, remedy: Remedy, rig: Rig) -> dict[str, Any]:
    """what, value, unit, statement."""
    value = remedy.value
    if kind == RemedyKind.SLOW_DOWN:
        said = "flown as it is" if value == 1.0 else f"flown {value:.4g} times as slow"
        return {"what": remedy.what, "value": value, "unit": "times", "statement": said}
    angle = math.degrees(value)
    if remedy.what == NOTHING:
        return {"what": NOTHING, "value": 0.0, "unit": "deg", "statement": "flown as it is: no limit need be raised"}
    if kind != RemedyKind.RELAX:
        turned = "the whole flight" if kind == RemedyKind.HEADING_OFFSET else "the payload in its mount"
        said = f"{turned} turned by {angle:.4g} deg of {remedy.what}" if value else f"{turned} as it is"
        return {"what": remedy.what, "value": angle, "unit": "deg", "statement": said}
    frame, limit = remedy.what.split()
    index = FRAMES.index(frame)
    before, after = rig.frames[index], remedy.rig.frames[index]
    if limit == "position":
        old, new = (_range(limits.min, limits.max) for limits in (before, after))
        said = f"the {frame} frame's range widened from {old} to {new} deg"
    else:
        held = math.degrees(before.max_rate if limit == "rate" else before.max_acceleration)
        said = f"the {frame} frame's {limit} limit raised from {held:.4g} to {angle:.4g} {UNITS[limit]}"
    return {"what": remedy.what, "value": angle, "unit": UNITS[limit], "statement": said}


def _range(low: float, high: float) -> str:
    return f"{math.degrees(low):.4g}..{math.degrees(high):.4g}"
