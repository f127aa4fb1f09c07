"""What the rig is commanded to do next: rest, move to a point, play a path, follow a live source, or brake.

`Motion.tick` proposes one command; the guard checks it; `commit` makes it the last one. A proposal that the guard
refuses is dropped, and braking starts from the last command that was written.
"""

import math
from enum import Enum, auto
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.formats.plan_folder import PlanFolder
from fullpose_server.runtime.contract.config import MotionConfig
from fullpose_server.runtime.motion.braking import brake_step, deceleration_for
from fullpose_server.runtime.motion.path_player import PathPlayer, attitude_error
from fullpose_server.runtime.motion.point_to_point import PointMove
from fullpose_server.session.states import Event


class Mode(Enum):
    """What drives the command."""

    REST = auto()
    POINT = auto()
    PATH = auto()
    LIVE = auto()
    BRAKE = auto()


class LiveFollower(Protocol):
    """A live source, as motion sees it."""

    stale: bool
    limited: bool

    def tick(self, x1: Array, v1: Array, x: Array, q: Array) -> bool:
        """Fill the next command x and the attitude q it follows; False where the source is lost."""
        ...


class Motion:
    """One rig's motion. `x`, `v`, `a` hold the proposal, `x1`, `v1` the last command; (4,) [rad], base first."""

    def __init__(self, rig: Rig, config: MotionConfig, rate_hz: float) -> None:
        self._rig = rig
        self._config = config
        self._dt = 1.0 / rate_hz
        self._rate_hz = rate_hz
        self.mode = Mode.REST
        self.x, self.v, self.a = np.zeros(4), np.zeros(4), np.zeros(4)
        self.q = np.full(4, math.nan)
        self.x1, self.v1 = np.zeros(4), np.zeros(4)
        self.q1 = np.full(4, math.nan)
        self.player: PathPlayer | None = None
        self._point: PointMove | None = None
        self._point_event = Event.THERE
        self._live: LiveFollower | None = None
        self._deceleration = np.zeros(4)
        self._limits = (rig.position_min, rig.position_max, rig.max_acceleration)

    # --- what to do ---

    def ready(self, plan: PlanFolder) -> PathPlayer:
        """A player for `plan`; changes nothing."""
        c = self._config
        return PathPlayer(plan, self._rig, self._rate_hz, c.hold_scale_rate, c.hold_scale_jerk)

    def bind(self, player: PathPlayer) -> None:
        """Take a player that was made ready."""
        self.player = player

    def load(self, plan: PlanFolder) -> None:
        """Make ready to play `plan`."""
        self.bind(self.ready(plan))

    def unload(self) -> None:
        """Forget the plan."""
        self.player = None

    def rest_at(self, position: Array) -> None:
        """Rest at `position`: where the table stands when its drive is enabled, or while the drive itself brakes."""
        self.mode = Mode.REST
        self.x[:] = self.x1[:] = position
        self.v[:] = self.v1[:] = self.a[:] = 0.0
        self.q[:] = self.q1[:] = math.nan

    def plan_start(self) -> PointMove:
        """The move to where the loaded path begins. Raises `MoveError`."""
        assert self.player is not None
        return PointMove(self._rig, self._config, self.x1, self.player.start_pose(self.x1))

    def plan_move(self, target: Array) -> PointMove:
        """A move from the last command to `target`. Raises `MoveError`."""
        return PointMove(self._rig, self._config, self.x1, target)

    def go(self, move: PointMove, event: Event) -> None:
        """Make `move`; `event` is reported when it has ended."""
        self._point, self._point_event = move, event
        self.mode = Mode.POINT

    def run(self) -> None:
        """Play the path from its start."""
        assert self.player is not None
        self.player.rewind()
        self.mode = Mode.PATH

    def hold(self, on: bool) -> None:
        """Slow down to a hold on the path, or back to full speed."""
        assert self.player is not None
        self.player.scale_to(0.0 if on else 1.0)

    def follow(self, live: LiveFollower) -> None:
        """Follow a live source."""
        self._live = live
        self.mode = Mode.LIVE

    def brake(self, *, fastest: bool) -> None:
        """Brake from the last command: by the configured share of each limit, or as fast as the limits allow."""
        share = 1.0 if fastest else self._config.stop_fraction
        unlimited = math.radians(self._config.unlimited_brake_deg_s2)
        wanted = deceleration_for(share, self.x1, self.v1, *self._limits, unlimited)
        # An E-stop during a stop may brake harder, never softer.
        self._deceleration = np.maximum(wanted, self._deceleration) if self.mode is Mode.BRAKE else wanted
        self.mode = Mode.BRAKE

    # --- each tick ---

    def tick(self) -> Event | None:
        """Propose the next command in x and q; returns what has happened, if anything."""
        self.q[:] = math.nan
        match self.mode:
            case Mode.PATH:
                assert self.player is not None
                if self.player.tick(self.x1, self.v1, self.x, self.q) < 0:
                    self.mode = Mode.REST
                    return Event.END
            case Mode.POINT:
                assert self._point is not None
                if self._point.tick(self._dt, self.x):
                    self.mode = Mode.REST
                    return self._point_event
            case Mode.LIVE:
                assert self._live is not None
                if not self._live.tick(self.x1, self.v1, self.x, self.q):
                    return Event.SOURCE_LOST
            case Mode.BRAKE:
                if brake_step(self._dt, self._deceleration, self.x1, self.v1, self.x, self.v):
                    self.mode = Mode.REST
                    return Event.AT_REST
            case Mode.REST:
                self.x[:] = self.x1
        return None

    def commit(self) -> None:
        """The proposal was written: it is the last command now."""
        self.x1[:] = self.x
        self.v1[:] = self.v
        self.q1[:] = self.q

    def solve_error(self, axes: NDArray[np.int64]) -> float:
        """Geodesic error [rad] of the proposed angles against the attitude they follow; nan where there is none."""
        if math.isnan(self.q[0]):
            return math.nan
        return float(attitude_error(axes, self.x, self.q))

    @property
    def stale(self) -> bool:
        """Whether a live source is followed and late: the attitude is extrapolated."""
        return self.mode is Mode.LIVE and self._live is not None and self._live.stale

    @property
    def limited(self) -> bool:
        """Whether limits keep the command from the attitude it follows."""
        return self.mode is Mode.LIVE and self._live is not None and self._live.limited

    @property
    def path_time_s(self) -> float:
        """The flight's time; nan off the path."""
        return self.player.time_s if self.mode is Mode.PATH and self.player is not None else math.nan

    @property
    def path_scale(self) -> float:
        """The path's time scale; nan off the path."""
        return self.player.scale if self.mode is Mode.PATH and self.player is not None else math.nan
