"""The words of plans that are named outside the planner too, which is heavy: an API takes them from here."""

from enum import StrEnum


class Decision(StrEnum):
    """The stage of the planner that decided whether a flight can be flown."""

    CHECKED = "checked"  # it can: every sample was checked
    TOLERANCE = "tolerance"  # it can, within the tolerance asked for: every sample was checked
    POSITION = "position"  # no node path, for want of range
    RATE = "rate"  # no node path, for want of rate
    ACCELERATION = "acceleration"  # node paths, but none that was refined came inside the limits
    BEYOND = "beyond"  # the attitude accelerates more than all frames together can
    START_RATE = "start_rate"  # nothing that was found takes up the start rate
    THREE_AXIS = "three-axis"  # no choice on a three-axis rig but the Euler set and its turns


class RemedyKind(StrEnum):
    """What may be changed to make a flight fit a rig."""

    TOLERANCE = "tolerance"
    SLOW_DOWN = "slow_down"
    HEADING_OFFSET = "heading_offset"
    MOUNTING_OFFSET = "mounting_offset"
    RELAX = "relax"


class Certainty(StrEnum):
    """How sure a verdict is."""

    CHECKED = "checked"  # every sample was checked
    GRID_COMPLETE = "grid_complete"  # no path exists on the grid, even widened; no theorem
    EVIDENCE = "evidence"  # none was found
    COMPLETE = "complete"  # there is nothing else to try


class Consequence(StrEnum):
    """What the attitude asks for once a frame has reached its limit."""

    ANOTHER_FRAME = "another_frame"  # another frame would have to go beyond a limit
    SAME_FRAME = "same_frame"  # the frame itself would, whatever the others do
    NOT_NAMED = "not_named"  # no single limit of another frame
