"""What an operator reads of a flight that is not flown exactly: what happens first, and what then."""

import math
from typing import TYPE_CHECKING, Any

from fullpose.rig import Limit
from fullpose.vocabulary import Consequence

if TYPE_CHECKING:
    from fullpose.plan.impossible import Beyond
    from fullpose.plan.reason import FrameAtLimit, Reason
    from fullpose.plan.verdict import Verdict
    from fullpose.solution import Blocking

UNITS = {"position": "deg", "rate": "deg/s", "acceleration": "deg/s^2", "jerk": "deg/s^3"}


def reason_report(verdict: "Verdict") -> dict[str, Any]:
    """`what_happens` in words and its figures, `first`, `then`, `consequence` [deg, s]; null where unknown."""
    reason, beyond = verdict.reason, verdict.beyond
    if reason is None:
        told = None if beyond is None else attitude_beyond(beyond)
        return {"what_happens": told, "first": None, "then": None, "consequence": None}
    return {
        "what_happens": what_happens(reason, verdict.closed),
        "first": _figures(reason.first),
        "then": None if reason.then is None else _figures(reason.then),
        "consequence": reason.consequence,
    }


def _figures(told: "FrameAtLimit") -> dict[str, Any]:
    return {
        "time_s": told.time,
        "frame": told.frame,
        "limit": told.limit,
        "value": math.degrees(told.value),
        "bound": math.degrees(told.bound),
    }


def attitude_beyond(beyond: "Beyond") -> str:
    """That no frame is first: the attitude itself cannot be had."""
    return (
        f"at {beyond.time:.3f} s the attitude itself would accelerate by {_number(beyond.needed)} deg/s^2, and all "
        f"frames together can give it {_number(beyond.most)} deg/s^2 at most"
    )


def what_happens(reason: "Reason", closed: "Blocking | None" = None) -> str:
    """One sentence, without its full stop; `closed` is where the search for an exact path came to its end."""
    first, then = reason.first, reason.then
    if first.limit == Limit.POSITION:
        reached = f"reaches its stop at {_number(first.bound)} deg"
    else:
        reached = f"reaches its {first.limit} limit of {_number(abs(first.bound))} {UNITS[first.limit]}"
    told = f"at {first.time:.3f} s the {first.frame} frame {reached}"
    if then is None:
        return f"{told}; from there no exact way was found{_past(closed)}"
    when = "" if f"{then.time:.3f}" == f"{first.time:.3f}" else f" at {then.time:.3f} s"
    if reason.consequence == Consequence.ANOTHER_FRAME:
        return f"{told}; from there the {then.frame} frame {_would(then)}{when}, {_bound(then)}"
    if then.limit == Limit.POSITION:
        return (
            f"{told}; from there it would have to be at {_number(then.value)} deg{when}, whatever the other frames do, "
            f"and is at {_number(then.bound)} deg"
        )
    return f"{told}; from there it {_would(then)}{when}, {_bound(then)}"


def _past(closed: "Blocking | None") -> str:
    if closed is None:
        return ""
    return f" past {closed.time:.3f} s, where the {closed.limit} limit of the {closed.frame} frame closes the last one"


def _would(then: "FrameAtLimit") -> str:
    if then.limit == Limit.POSITION:
        return f"would have to be at {_number(then.value)} deg"
    return f"would need {_number(abs(then.value))} {UNITS[then.limit]}"


def _bound(then: "FrameAtLimit") -> str:
    if then.limit == Limit.POSITION:
        return f"its stop is at {_number(then.bound)} deg"
    return f"its limit is {_number(abs(then.bound))} {UNITS[then.limit]}"


def _number(angle: float) -> str:
    """Degrees to a tenth, whole above a thousand."""
    degrees = math.degrees(angle)
    return f"{degrees:.0f}" if abs(degrees) >= 1000.0 else f"{round(degrees, 1):g}"
