"""One step of a live flight: a method of the solver that keeps the limits, or `preview` with its planner."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import msgspec
import numpy as np

from fullpose._typing import Array
from fullpose.errors import SolverError
from fullpose.kinematics import payload_attitude
from fullpose.rig import Rig
from fullpose_server.runtime.motion.path_player import attitude_of

if TYPE_CHECKING:
    from fullpose.methods.base import LiveStepper  # with it come all methods

    Taken = TypeVar("Taken", bound=LiveStepper)
else:
    Taken = TypeVar("Taken")


@dataclass(frozen=True)
class LiveSettings:
    """How a live source is flown: the step method and its options."""

    method: str = "exact"
    options: dict[str, Any] = field(default_factory=dict)
    first_sample_s: float = 5.0  # to wait for the source to begin

    @property
    def hash(self) -> str:
        """sha-256 of the settings: what `arm` is held to."""
        content = [self.method, sorted(self.options.items()), self.first_sample_s]
        return hashlib.sha256(msgspec.json.encode(content)).hexdigest()


class LiveError(Exception):
    """Live settings that cannot be flown: which, and why."""


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
    def way_age_s(self) -> float:
        """How old the planner's last word is [s]; nan for a method that has no planner."""
        ...

    def close(self) -> None:
        """End the planner, where there is one."""
        ...


def live_step(rig: Rig, settings: LiveSettings, dt: float) -> LiveStep:
    """The step for one rig and settings, its kernels compiled. Raises `LiveError` where they do not go together."""
    from fullpose.registry import REGISTRY, Sees  # heavier than the rest of the rig process: only where it is used

    known = [row.name for row in REGISTRY.values() if row.sees is not Sees.FLIGHT]
    if settings.method not in known:
        raise LiveError(f"method {settings.method!r}: expected one of {', '.join(known)}")
    if REGISTRY[settings.method].sees is not Sees.AHEAD:
        return MethodStep(rig, settings, dt)
    from fullpose_server.runtime.live.preview_stepper import PreviewStep  # with it comes the planner

    return PreviewStep(rig, settings, dt)


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


class MethodStep:
    """A step method of the solver."""

    preview_s = 0.0
    way_age_s = float("nan")

    def __init__(self, rig: Rig, settings: LiveSettings, dt: float) -> None:
        # Heavier than the rest of the rig process: only where it is used.
        from fullpose.registry import find_step, method_options

        self._method = find_step(settings.method)
        if not self._method.claims_limits:
            raise LiveError(f"method {settings.method} does not keep the limits: it cannot fly a live source")
        self._rig = rig
        self._dt = dt
        try:
            self._options = method_options(settings.method, settings.options) or self._method.options()
            self.begin(rig.home.copy())  # writable, as in flight: to Numba a type of its own
        except SolverError as cause:
            raise LiveError(str(cause)) from cause
        # Compiled here, at rest, and not in the first live tick.
        self.follow(np.array([1.0, 0.0, 0.0, 0.0]))
        self.begin(rig.home.copy())

    def begin(self, pose: Array) -> None:
        """From rest at `pose` (4,) [rad]."""
        self._flight = Flight(self._rig, self._dt, pose, self._stepper)

    def _stepper(self, pose: Array, attitude: Array) -> LiveStepper:
        from fullpose.methods.base import LiveStepper

        stepper = self._method.stepper(self._rig, self._options, pose, attitude)
        if not isinstance(stepper, LiveStepper):
            raise LiveError(f"method {self._method.name} cannot take over a rig that stands")
        return stepper

    def follow(self, q: Array) -> tuple[Array, int]:
        """The next angles (4,) [rad] toward attitude q (4,), and the code of the limit that keeps them from it."""
        return self._flight.step(q)

    def announce(self, ahead_s: float, q: tuple[float, float, float, float]) -> None:
        """Nothing: a step method looks at the present alone."""

    def void(self) -> None:
        """Nothing: see `announce`."""

    def close(self) -> None:
        """Nothing to end."""
