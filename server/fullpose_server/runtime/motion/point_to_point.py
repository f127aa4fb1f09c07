"""Moves from rest to rest: absolute, synchronised over the frames, jerk-limited, inside the rig's limits (Ruckig)."""

import math

import numpy as np
from ruckig import InputParameter, Result, Ruckig, RuckigError, Synchronization, Trajectory

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.runtime.contract.config import MotionConfig

# Of the rig's own limits: a sampled move is differenced over ticks, and the guard allows a millionth more.
_SHARE = 0.999


class MoveError(Exception):
    """A move that cannot be made: which frame, which value, which limit [deg]."""

    def __init__(self, message: str, frame: str | None = None) -> None:
        super().__init__(message)
        self.frame = frame


class PointMove:
    """One move from `start` to `target`, both at rest. (4,) [rad]

    Raises `MoveError` where the target is not finite, outside a frame's range (a frame that begins outside may stay or
    come nearer), or too far for the rates. (Ruckig's profiles end at about two hours.)
    """

    def __init__(self, rig: Rig, config: MotionConfig, start: Array, target: Array) -> None:
        for name, value, low, high, begin in zip(
            FRAMES, target, rig.position_min, rig.position_max, start, strict=True
        ):
            if not min(low, begin) - 1e-9 <= value <= max(high, begin) + 1e-9:
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
        plan.max_jerk = [min(math.radians(config.move_jerk_deg_s3), _SHARE * float(v)) for v in rig.max_jerk]
        plan.synchronization = Synchronization.Time
        self._path = Trajectory(4)
        try:
            possible = Ruckig(4).calculate(plan, self._path) in (Result.Working, Result.Finished)
        except (ValueError, RuckigError):  # its results for what is too long have no name in Python
            possible = False
        if not possible:
            seconds = np.abs(target - start) / np.array(plan.max_velocity)
            slow = int(np.argmax(seconds))
            far, fast = math.degrees(target[slow] - start[slow]), math.degrees(plan.max_velocity[slow])
            text = f"{FRAMES[slow]}: {far:.6g} deg at {fast:.4g} deg/s take {seconds[slow]:.4g} s"
            raise MoveError(f"no move can be made of this, about two hours is the most: {text}", FRAMES[slow])
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
