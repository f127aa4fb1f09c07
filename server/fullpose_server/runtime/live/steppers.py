"""One step of a live flight: what the loop asks of it, and a stepper of the solver that takes a rig over from rest."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

import numpy as np

from fullpose._typing import Array
from fullpose.kinematics import payload_attitude
from fullpose.rig import Rig
from fullpose_server.runtime.motion.path_player import attitude_of

if TYPE_CHECKING:
    from fullpose.methods.base import LiveStepper  # with it come all methods

    Taken = TypeVar("Taken", bound=LiveStepper)
else:
    Taken = TypeVar("Taken")


class LiveStep(Protocol):
    """A live flight in progress, one tick at a time."""

    preview_s: float  # the samples are told this long [s] before they are flown

    def begin(self, pose: Array) -> None:
        """From rest at `pose` (4,) [rad]."""
        ...

    def follow(self, q: Array) -> tuple[Array, int]:
        """The next angles (4,) [rad] toward attitude q (4,), and the code of the limit that keeps them from it."""
        ...

    def announce(self, ahead_s: float, q: tuple[float, float, float, float]) -> None:
        """The attitude q that is to be flown `ahead_s` [s] after the tick to come."""
        ...

    def void(self) -> None:
        """What was announced is not to come: the source began anew."""
        ...

    @property
    def plan_age_s(self) -> float:
        """How old the planner's last word is [s]; nan for a method that has no planner."""
        ...

    def close(self) -> None:
        """End the planner, where there is one."""
        ...


class Flight(Generic[Taken]):
    """A stepper of the solver that takes a rig over from rest, one attitude a tick."""

    def __init__(self, rig: Rig, dt: float, pose: Array, made: Callable[[Array, Array], Taken]) -> None:
        """`made` makes the stepper from `pose` (4,) [rad] and its attitude (3, 3)."""
        self._C = np.empty((1, 3, 3))
        payload_attitude(rig.axes, pose, self._C[0])
        self.stepper = made(pose, self._C[0].copy())
        self.stepper.begin_at_rest(dt)
        self._dt = dt
        self._tick = 1
        self._time = np.zeros(1)

    @property
    def now(self) -> float:
        """The time of the tick to come [s]."""
        return self._tick * self._dt

    def step(self, q: Array) -> tuple[Array, int]:
        """The next angles (4,) [rad] toward attitude q (4,), and the code of the limit that keeps them from it."""
        attitude_of(q, self._C[0])
        self._time[0] = self.now
        self._tick += 1
        block = self.stepper.block(self._time, self._C)
        return block.angles[0], int(block.limited[0])
