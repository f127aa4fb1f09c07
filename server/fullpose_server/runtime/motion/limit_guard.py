"""The guard between any source of commands and any drive.

`check_command` looks at a command before it is written: finiteness, step, position, rate, acceleration, and whether
the frame could still brake before its position limit; `check_jerk` at its jerk, of a rig that limits that. A frame that
was found outside its range may stand or come back, never go farther out. `observe` looks at what the rig did. Limits
that a rig has not are infinite; a limit of zero is a limit.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fullpose._jit import kernel
from fullpose._typing import Array
from fullpose.bounds import JERK_ROUNDING, POSITION_TOLERANCE, TOLERANCE
from fullpose.rig import FRAMES, Rig
from fullpose_server.runtime.contract.config import GuardConfig, Tolerance
from fullpose_server.runtime.motion.braking import stopping_distance
from fullpose_server.runtime.motion.path_player import attitude_error
from fullpose_server.session.warning_codes import WarningCode

FINITE, STEP, POSITION, RATE, ACCELERATION, BRAKING, JERK = range(1, 8)
CHECKS = ("", "finite", "step", "position", "rate", "acceleration", "braking", "jerk")
_UNITS = ("", "deg", "deg", "deg", "deg/s", "deg/s^2", "deg", "deg/s^3")
# Rows of the limits.
LOWER, UPPER, MAX_RATE, MAX_ACCELERATION, MAX_STEP = 0, 1, 2, 3, 4
_ROUNDING = 16.0 * 2.22e-16  # of positions, as accelerations see it through two differences


@kernel
def check_command(dt: float, limits: Array, x: Array, x1: Array, v1: Array, v: Array, a: Array, found: Array) -> int:
    """Check the command x after x1 (rate v1), all (4,) [rad]; fills v and a; returns 0, or 1 + 8 frame + check.

    limits (5, 4) as the row names say. found (3,) <- value, limit, and the margin: the smallest relative distance of
    any frame to any of its limits, 0..1.
    """
    margin = 1.0
    for i in range(4):
        if not math.isfinite(x[i]):
            found[0], found[1], found[2] = x[i], math.nan, 0.0
            return 1 + 8 * i + FINITE
        v[i] = (x[i] - x1[i]) / dt
        a[i] = (v[i] - v1[i]) / dt
        step = abs(x[i] - x1[i])
        if step > limits[MAX_STEP, i]:
            found[0], found[1], found[2] = step, limits[MAX_STEP, i], 0.0
            return 1 + 8 * i + STEP
        low = limits[LOWER, i]
        high = limits[UPPER, i]
        if x[i] < min(low - POSITION_TOLERANCE, x1[i]) or x[i] > max(high + POSITION_TOLERANCE, x1[i]):
            found[0], found[1], found[2] = x[i], low if x[i] < low else high, 0.0
            return 1 + 8 * i + POSITION
        rate = limits[MAX_RATE, i]
        if abs(v[i]) > rate * (1.0 + TOLERANCE) + _ROUNDING * (1.0 + abs(x[i])) / dt:
            found[0], found[1], found[2] = v[i], math.copysign(rate, v[i]), 0.0
            return 1 + 8 * i + RATE
        most = limits[MAX_ACCELERATION, i]
        if abs(a[i]) > most * (1.0 + TOLERANCE) + _ROUNDING * (1.0 + abs(x[i])) / (dt * dt):
            found[0], found[1], found[2] = a[i], math.copysign(most, a[i]), 0.0
            return 1 + 8 * i + ACCELERATION
        room = high - x[i] if v[i] > 0.0 else x[i] - low
        needed = 0.0 if math.isinf(most) else stopping_distance(v[i], most, dt)
        if needed > max(0.0, room) + POSITION_TOLERANCE + TOLERANCE * needed:
            found[0], found[1], found[2] = needed, room, 0.0
            return 1 + 8 * i + BRAKING
        if high > low and not math.isinf(high):
            margin = min(margin, min(high - x[i], x[i] - low) / (0.5 * (high - low)))
        margin = min(margin, 1.0 - abs(v[i]) / rate, 1.0 - abs(a[i]) / most)
    found[2] = max(0.0, margin)
    return 0


@kernel
def check_jerk(dt: float, most: Array, x: Array, a: Array, a1: Array, found: Array) -> int:
    """Check the acceleration a after a1, all (4,) [rad/s^2], against the jerk limits `most` (4,); as `check_command`.

    x (4,) [rad]. found (3,): the margin becomes the smaller one.
    """
    for i in range(4):
        jerk = (a[i] - a1[i]) / dt
        if abs(jerk) > most[i] * (1.0 + TOLERANCE) + JERK_ROUNDING * (1.0 + abs(x[i])) / (dt * dt * dt):
            found[0], found[1], found[2] = jerk, math.copysign(most[i], jerk), 0.0
            return 1 + 8 * i + JERK
        found[2] = min(found[2], max(0.0, 1.0 - abs(jerk) / most[i]))
    return 0


@kernel
def observe(axes: NDArray[np.int64], measured: Array, due: Array, target: Array, following: Array) -> float:
    """following (4,) <- measured - due [rad]; returns the payload's geodesic error [rad] against target (4,).

    target is w, x, y, z; the error is nan where there is no target (nan) or a measurement is missing (nan).
    """
    for i in range(4):
        following[i] = measured[i] - due[i]
    if math.isnan(target[0]) or math.isnan(measured[0] + measured[1] + measured[2] + measured[3]):
        return math.nan
    return attitude_error(axes, measured, target)


@dataclass(frozen=True)
class Finding:
    """What the guard found. Values in `unit`, degrees where it is an angle."""

    code: str
    trips: bool
    message: str
    frame: str | None
    value: float
    limit: float
    unit: str


class Guard:
    """One rig's guard. `command` before the write; `measured` and `scalar` after the read."""

    def __init__(self, rig: Rig, config: GuardConfig, dt: float) -> None:
        self._dt = dt
        self._axes = rig.axes
        self._limits = np.zeros((5, 4))
        self._limits[LOWER] = rig.position_min
        self._limits[UPPER] = rig.position_max
        self._limits[MAX_RATE] = rig.max_rate
        self._limits[MAX_ACCELERATION] = rig.max_acceleration
        self._limits[MAX_STEP] = math.radians(config.max_step_deg)
        self._max_jerk = rig.max_jerk if rig.jerk_limited else None
        self._config = config
        self._found = np.zeros(3)
        self._warn = _rad(config.following_deg.warn)
        self._trip = _rad(config.following_deg.trip)
        self.following = np.zeros(4)
        self.margin = 1.0

    def command(self, x: Array, x1: Array, v1: Array, v: Array, a: Array, a1: Array | None = None) -> Finding | None:
        """Check x before it is written; fills its rate v and acceleration a.

        a1 (4,) [rad/s^2]: the last one, from which the jerk counts; None: it does not.
        """
        code = check_command(self._dt, self._limits, x, x1, v1, v, a, self._found)
        if code == 0 and a1 is not None and self._max_jerk is not None:
            code = check_jerk(self._dt, self._max_jerk, x, a, a1, self._found)
        self.margin = float(self._found[2])
        if code == 0:
            return None
        frame, check = divmod(code - 1, 8)
        name, word, unit = FRAMES[frame], CHECKS[check], _UNITS[check]
        value, limit = math.degrees(self._found[0]), math.degrees(self._found[1])
        text = f"{name} frame, {word}: command of {value:.6g} {unit}, limit {limit:.6g} {unit}; not written"
        if check == BRAKING:
            text = f"{name} frame needs {value:.6g} deg to brake and has {limit:.6g} deg; not written"
        if check == FINITE:
            text = f"{name} frame: the command is not a number; not written"
        return Finding(f"guard_{word}", True, text, name, value, limit, unit)

    def measured(self, measured: Array, due: Array, target: Array) -> tuple[float, list[Finding]]:
        """Compare what the drive measured with what was due: (attitude error [rad] or nan, all that was found)."""
        error = observe(self._axes, measured, due, target, self.following)
        largest, frame = 0.0, 0
        for i in range(4):
            size = abs(self.following[i])
            if not size <= largest:
                largest, frame = float(size), i
                if math.isnan(largest):  # nothing is worse than no measurement, whatever the tolerance
                    text = f"{FRAMES[i]} frame: its position is not a number"
                    return error, [Finding("following_error", True, text, FRAMES[i], largest, math.nan, "deg")]
        found = []
        if not (largest <= self._warn and largest <= self._trip):
            tolerance = self._config.following_deg
            found.append(
                self.scalar(WarningCode.FOLLOWING_ERROR, math.degrees(largest), tolerance, "deg", FRAMES[frame])
            )
        if not math.isnan(error):
            found.append(self.scalar(WarningCode.ATTITUDE_ERROR, math.degrees(error), self._config.attitude_deg))
        return error, [each for each in found if each is not None]

    def scalar(
        self, code: str, value: float, tolerance: Tolerance | None, unit: str = "deg", frame: str | None = None
    ) -> Finding | None:
        """Compare `value` with a tolerance: above trip, above warn, or None. A value that is no number trips."""
        if tolerance is None:
            return None
        where = "" if frame is None else f"{frame} frame, "
        for trips, level in ((True, tolerance.trip), (False, tolerance.warn)):
            if level is not None and not value <= level:
                text = f"{where}{code.replace('_', ' ')}: {value:.4g} {unit}, tolerance {level:.4g} {unit}"
                return Finding(code, trips, text, frame, value, level, unit)
        return None


def _rad(level: float | None) -> float:
    return math.inf if level is None else math.radians(level)
