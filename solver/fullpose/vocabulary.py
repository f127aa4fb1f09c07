"""The words of plans that are named outside the planner too, which is heavy: an API takes them from here."""

from enum import StrEnum


class Decision(StrEnum):
    """The stage of the planner that decided whether a flight can be flown."""

    CHECKED = "checked"  # it can: every sample was checked
    TOLERANCE = "tolerance"  # it can, within the tolerance asked for: every sample was checked
    POSITION = "position"  # no node path, for want of range
    RATE = "rate"  # no node path, for want of rate
    ACCELERATION = "acceleration"  # node paths, but none that was refined came inside the limits
    START_RATE = "start_rate"  # nothing that was found takes up the start rate
    THREE_AXIS = "three-axis"  # no choice on a three-axis rig but the Euler set and its turns


class RemedyKind(StrEnum):
    """What may be changed to make a flight fit a rig."""

    SLOW_DOWN = "slow_down"
    HEADING_OFFSET = "heading_offset"
    MOUNTING_OFFSET = "mounting_offset"
    RELAX = "relax"
