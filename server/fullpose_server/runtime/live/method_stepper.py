"""A live flight with a step method of the solver that keeps the limits."""

import numpy as np

from fullpose._typing import Array
from fullpose.errors import SolverError
from fullpose.methods.base import LiveStepper
from fullpose.registry import find_step, method_options
from fullpose.rig import Rig
from fullpose_server.runtime.live.settings import LiveError, LiveSettings
from fullpose_server.runtime.live.steppers import Flight


class MethodStep:
    """A step method of the solver."""

    preview_s = 0.0
    plan_age_s = float("nan")

    def __init__(self, rig: Rig, settings: LiveSettings, dt: float) -> None:
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
