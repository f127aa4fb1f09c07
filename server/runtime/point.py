"""Moves from rest to rest: absolute, synchronised over the frames, jerk-limited, inside the rig's limits (Ruckig)."""

import math

import numpy as np
from numpy.typing import NDArray
from ruckig import InputParameter, Result, Ruckig, Synchronization, Trajectory

from server.runtime.config import MotionConfig
from solver.rig import FRAMES, Rig

Array = NDArray[np.float64]
# Of the rig's own limits: a sampled move is differenced over ticks, and the guard allows a millionth more.
_SHARE = 0.999


class MoveError(Exception):
    """A move that cannot be made: which frame, which value, which limit [deg]."""

    def __init__(self, message: str, frame: str | None = None) -> None:
        super().__init__(message)
        self.frame = frame


class PointMove:
    """One move from `start` to `target`, both at rest. (4,) [rad]

    Raises `MoveError` where the target is not finite or outside a frame's range.
    """

    def __init__(self, rig: Rig, config: MotionConfig, start: Array, target: Array) -> None:
        for name, value, low, high in zip(FRAMES, target, rig.position_min, rig.position_max, strict=True):
            if not low - 1e-9 <= value <= high + 1e-9:
                low_deg, high_deg, deg = (math.degrees(v) for v in (low, high, value))
                raise MoveError(f"{name}: {deg:.6g} deg is outside {low_deg:.6g} to {high_deg:.6g} deg", name)
        if not np.isfinite(target).all():
            raise MoveError("the target is not four finite angles")
        plan = InputParameter(4)
        plan.current_position = [float(v) for v in start]
        plan.target_position = [float(v) for v in target]
        plan.current_velocity = plan.target_velocity = [0.0] * 4
        plan.current_acceleration = plan.target_acceleration = [0.0] * 4
        rate, acceleration = math.radians(config.move_rate_deg_s), math.radians(config.move_acceleration_deg_s2)
        plan.max_velocity = [min(rate, _SHARE * float(v)) for v in rig.max_rate]
        plan.max_acceleration = [min(acceleration, _SHARE * float(v)) for v in rig.max_acceleration]
        plan.max_jerk = [math.radians(config.move_jerk_deg_s3)] * 4
        plan.synchronization = Synchronization.Time
        self._path = Trajectory(4)
        result = Ruckig(4).calculate(plan, self._path)
        if result not in (Result.Working, Result.Finished):
            raise MoveError(f"no move from {np.degrees(start)} to {np.degrees(target)} deg: {result}")
        self._target = np.array(target, float)
        self.duration_s = float(self._path.duration)
        self._time = 0.0

    def tick(self, dt: float, x: Array) -> bool:
        """x (4,) <- the next position [rad]; returns whether the move has ended."""
        self._time += dt
        if self._time >= self.duration_s:
            x[:] = self._target
            return True
        x[:] = self._path.at_time(self._time)[0]
        return False
