"""What the rig is commanded to do next: rest, move to a point, play a path, follow a live source, or brake.

`Motion.tick` proposes one command; the guard checks it; `commit` makes it the last one. A proposal that the guard
refuses is dropped, and braking starts from the last command that was written.
"""

import math
from dataclasses import dataclass, replace
from enum import Enum, auto
from typing import ClassVar, Protocol, TypeAlias, assert_never

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.rig import Rig
from fullpose_server.formats.plan_folder import PlanFolder
from fullpose_server.runtime.contract.config import MotionConfig
from fullpose_server.runtime.motion.braking import brake_step, deceleration_for
from fullpose_server.runtime.motion.jerk_braking import JerkBraking, jerk_braking
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


class MotionError(Exception):
    """Motion was asked for something for which nothing is loaded: a fault of ours, the session does not order it."""


@dataclass(frozen=True)
class Resting:
    """Stay."""

    mode: ClassVar = Mode.REST


@dataclass(frozen=True)
class Moving:
    """Make `move`; `event` is reported when it has ended."""

    mode: ClassVar = Mode.POINT
    move: PointMove
    event: Event


@dataclass(frozen=True)
class Playing:
    """Play a plan."""

    mode: ClassVar = Mode.PATH
    player: PathPlayer


@dataclass(frozen=True)
class Following:
    """Follow a live source."""

    mode: ClassVar = Mode.LIVE
    live: LiveFollower


@dataclass(frozen=True)
class Braking:
    """Brake by `deceleration` (4,) [rad/s^2]; frames with a jerk limit along `jerk_limited`, begun `time` [s] ago."""

    mode: ClassVar = Mode.BRAKE
    deceleration: Array
    jerk_limited: JerkBraking | None = None
    time: float = 0.0


Task: TypeAlias = Resting | Moving | Playing | Following | Braking
_REST = Resting()


class Motion:
    """One rig's motion. `x`, `v`, `a` hold the proposal, `x1`, `v1`, `a1` the last command; (4,) [rad], base first."""

    def __init__(self, rig: Rig, config: MotionConfig, rate_hz: float) -> None:
        self._rig = rig
        self._config = config
        self._dt = 1.0 / rate_hz
        self._rate_hz = rate_hz
        self._task: Task = _REST
        self.x, self.v, self.a = np.zeros(4), np.zeros(4), np.zeros(4)
        self.q = np.full(4, math.nan)
        self.x1, self.v1, self.a1 = np.zeros(4), np.zeros(4), np.zeros(4)
        self.jerk_yielded = False  # a brake is beyond a jerk limit, since a limit of position or rate comes first
        self.q1 = np.full(4, math.nan)
        self._player: PathPlayer | None = None
        self._limits = (rig.position_min, rig.position_max, rig.max_acceleration)

    # --- what to do ---

    def ready(self, plan: PlanFolder) -> PathPlayer:
        """A player for `plan`; changes nothing."""
        c = self._config
        return PathPlayer(plan, self._rig, self._rate_hz, c.hold_scale_rate, c.hold_scale_jerk)

    def bind(self, player: PathPlayer) -> None:
        """Take a player that was made ready."""
        self._player = player

    def load(self, plan: PlanFolder) -> None:
        """Make ready to play `plan`."""
        self.bind(self.ready(plan))

    def unload(self) -> None:
        """Forget the plan."""
        self._player = None

    def rest_at(self, position: Array) -> None:
        """Rest at `position`: where the table stands when its drive is enabled, or while the drive itself brakes."""
        self._task = _REST
        self.x[:] = self.x1[:] = position
        self.v[:] = self.v1[:] = self.a[:] = self.a1[:] = 0.0
        self.jerk_yielded = False
        self.q[:] = self.q1[:] = math.nan

    def plan_start(self) -> PointMove:
        """The move to where the loaded path begins. Raises `MoveError`."""
        return PointMove(self._rig, self._config, self.x1, self._loaded().start_pose(self.x1))

    def plan_move(self, target: Array) -> PointMove:
        """A move from the last command to `target`. Raises `MoveError`."""
        return PointMove(self._rig, self._config, self.x1, target)

    def go(self, move: PointMove, event: Event) -> None:
        """Make `move`; `event` is reported when it has ended."""
        self._task = Moving(move, event)

    def run(self) -> None:
        """Play the path from its start."""
        player = self._loaded()
        player.rewind()
        self._task = Playing(player)

    def hold(self, on: bool) -> None:
        """Slow down to a hold on the path, or back to full speed."""
        self._loaded().scale_to(0.0 if on else 1.0)

    def follow(self, live: LiveFollower) -> None:
        """Follow a live source."""
        self._task = Following(live)

    def brake(self, *, fastest: bool) -> None:
        """Brake from the last command: by the configured share of each limit, or as fast as the limits allow."""
        share = 1.0 if fastest else self._config.stop_fraction
        unlimited = math.radians(self._config.unlimited_brake_deg_s2)
        wanted = deceleration_for(share, self.x1, self.v1, *self._limits, unlimited)
        if isinstance(self._task, Braking):  # an E-stop during a stop may brake harder, never softer
            if self._task.jerk_limited is not None and self._task.jerk_limited.fastest and not fastest:
                return
            wanted = np.maximum(wanted, self._task.deceleration)
        self._task = Braking(wanted, self._jerk_braking(share, fastest=fastest))

    def _jerk_braking(self, share: float, *, fastest: bool) -> JerkBraking | None:
        if not self._rig.jerk_limited:
            return None
        state = (self.x1, self.v1, self.a1)
        chosen = jerk_braking(self._rig, self._dt, state, share, fastest=fastest)
        self.jerk_yielded = self.jerk_yielded or chosen.jerk_yielded
        return chosen

    def _loaded(self) -> PathPlayer:
        if self._player is None:
            raise MotionError("no plan is loaded")
        return self._player

    # --- each tick ---

    def tick(self) -> Event | None:
        """Propose the next command in x and q; returns what has happened, if anything."""
        self.q[:] = math.nan
        match self._task:
            case Playing(player=player):
                if player.tick(self.x1, self.v1, self.x, self.q) < 0:
                    self._task = _REST
                    return Event.END
            case Moving(move=move, event=event):
                if move.tick(self._dt, self.x):
                    self._task = _REST
                    return event
            case Following(live=live):
                if not live.tick(self.x1, self.v1, self.x, self.q):
                    return Event.SOURCE_LOST
            case Braking() as braking:
                return self._brake_on(braking)
            case Resting():
                self.x[:] = self.x1
            case _:
                assert_never(self._task)
        return None

    def _brake_on(self, braking: Braking) -> Event | None:
        rest = brake_step(self._dt, braking.deceleration, self.x1, self.v1, self.x, self.v)
        if braking.jerk_limited is not None:
            profiles = braking.jerk_limited.profiles
            rest = all(profile is not None or self.v[i] == 0.0 for i, profile in enumerate(profiles))
            time = braking.time + self._dt
            rest = braking.jerk_limited.positions(time, self.x) and rest
            self._task = replace(braking, time=time)
        if not rest:
            return None
        self._task = _REST
        return Event.AT_REST

    def commit(self) -> None:
        """The proposal was written: it is the last command now."""
        self.x1[:] = self.x
        self.v1[:] = self.v
        self.a1[:] = self.a
        if self.jerk_yielded and self._task is _REST and not self.a1.any():
            self.jerk_yielded = False
        self.q1[:] = self.q

    def solve_error(self, axes: NDArray[np.int64]) -> float:
        """Geodesic error [rad] of the proposed angles against the attitude they follow; nan where there is none."""
        if math.isnan(self.q[0]):
            return math.nan
        return float(attitude_error(axes, self.x, self.q))

    @property
    def rate_hz(self) -> float:
        """Of the commands."""
        return self._rate_hz

    @property
    def jerk_from(self) -> Array | None:
        """The last acceleration (4,) [rad/s^2], from which the jerk counts; None where it has yielded."""
        return None if self.jerk_yielded else self.a1

    @property
    def mode(self) -> Mode:
        """What drives the command."""
        return self._task.mode

    @property
    def stale(self) -> bool:
        """Whether a live source is followed and late: the attitude is extrapolated."""
        return isinstance(self._task, Following) and self._task.live.stale

    @property
    def limited(self) -> bool:
        """Whether limits keep the command from the attitude it follows."""
        return isinstance(self._task, Following) and self._task.live.limited

    @property
    def path_time_s(self) -> float:
        """The flight's time; nan off the path."""
        return self._task.player.time_s if isinstance(self._task, Playing) else math.nan

    @property
    def path_scale(self) -> float:
        """The path's time scale; nan off the path."""
        return self._task.player.scale if isinstance(self._task, Playing) else math.nan
