"""What the parts of one rig's loop work on: the state of its tick, as data, and the things it is made of."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from fullpose._typing import Array
from fullpose_server.formats.plan_folder import PlanInfo
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.runtime.live.source import LiveSource
from fullpose_server.runtime.loop.clock import Clock
from fullpose_server.runtime.loop.event_log import EventLog
from fullpose_server.runtime.loop.orders import Load
from fullpose_server.runtime.loop.watched_drive import WatchedDrive
from fullpose_server.runtime.motion.generator import Motion
from fullpose_server.runtime.motion.limit_guard import Guard
from fullpose_server.runtime.motion.point_to_point import PointMove
from fullpose_server.session.machine import SessionMachine
from fullpose_server.session.run_end import Ending

Session: TypeAlias = SessionMachine[Load, PointMove]


@dataclass
class LoopState:
    """What the loop knows beside the session and the motion; plain data."""

    measured: Array  # (4,) [rad], what the drive said in this tick
    measured_rate: Array  # (4,) [rad/s]
    status: int = 0  # the drive's, `Status` bits
    enabled: bool = False  # we write to the drive
    drive_brakes: bool = False  # the drive was told to brake by itself: our commands no longer count
    drive_brakes_since: float = 0.0  # [s, monotonic]
    disable_at_rest: bool = False
    run_id: str | None = None  # of the flight that is recorded
    run_ending: Ending | None = None  # why it ends, where that is known
    run_ends: bool = False  # it ends with this tick's sample
    plan: PlanInfo | None = None  # the one that was loaded last; None for a live source
    plan_folder: Path | None = None  # where it is
    ticks: int = 0
    tracking_error: float = math.nan  # [rad]
    ending: bool = False  # the process ends after this tick

    @property
    def commanded(self) -> bool:
        """Whether what we write is what the table does."""
        return self.enabled and not self.drive_brakes


@dataclass(frozen=True)
class Parts:
    """What one rig's loop is made of."""

    config: RigConfig
    clock: Clock
    machine: Session
    drive: WatchedDrive
    motion: Motion
    guard: Guard
    live: LiveSource
    shared: Shared
    log: EventLog
    state: LoopState
    realtime: str = ""  # what the system granted, in words
    life: str = ""  # of this process, unlike any other's
