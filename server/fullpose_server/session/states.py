"""The words of the session: its states, what may be asked of it, what may happen to it, and what it orders done."""

from enum import StrEnum
from typing import Literal


class State(StrEnum):
    """Where a rig's session is. The order is the code in telemetry (`State.code`)."""

    DISCONNECTED = "disconnected"
    IDLE = "idle"
    READY = "ready"
    ARMED = "armed"
    POSITIONING = "positioning"
    RUNNING = "running"
    HELD = "held"
    STOPPING = "stopping"
    LIVE = "live"
    ESTOPPED = "estopped"
    FAULTED = "faulted"

    @property
    def code(self) -> int:
        """The number that stands for this state in telemetry."""
        return _CODES[self]


_CODES = {state: code for code, state in enumerate(State)}
STATES = tuple(State)
IN_MOTION = frozenset({State.POSITIONING, State.RUNNING, State.HELD, State.STOPPING, State.LIVE})


class Command(StrEnum):
    """What an operator may ask."""

    CONNECT = "connect"
    LOAD = "load"
    UNLOAD = "unload"
    ARM = "arm"
    DISARM = "disarm"
    START = "start"
    HOLD = "hold"
    RESUME = "resume"
    STOP = "stop"
    MOVE = "move"
    HOME = "home"
    JOG = "jog"
    GO_LIVE = "go_live"
    ESTOP = "estop"
    ACKNOWLEDGE = "acknowledge"
    SHELVE = "shelve"
    UNSHELVE = "unshelve"
    RESET = "reset"


NEEDS_NO_LEASE = frozenset({Command.STOP, Command.ESTOP})
# IEC 60204-1: 1 stops under control, then takes the power away; 2 stops under control and leaves it on.
STOP_CATEGORY: dict[Command, Literal[1, 2]] = {Command.ESTOP: 1, Command.STOP: 2}


class Event(StrEnum):
    """What the rig process reports."""

    AT_START = "at start"
    THERE = "there"
    END = "end"
    AT_REST = "at rest"
    SOURCE_LOST = "source lost"
    FAULT = "fault"
    LINK_LOST = "link lost"
    SILENT_HOLD = "silent: hold"
    SILENT_STOP = "silent: stop"
    SILENT_DISARM = "silent: disarm"


class Action(StrEnum):
    """What the machine orders; the rig process does it."""

    ENABLE = "enable the drive"
    DISABLE = "disable the drive"
    BIND = "bind plan and rig"
    UNBIND = "unbind"
    POSITION = "position to the lead-in's start"
    MOVE = "move"
    RUN = "run the path"
    HOLD = "hold on the path"
    RESUME = "resume on the path"
    GO_LIVE = "follow the live source"
    BRAKE = "brake inside the limits"
    BRAKE_FASTEST = "brake as fast as the limits allow"
    DISABLE_AT_REST = "disable the drive at rest"
    CLEAR = "clear the alarms"
