"""Braking of frames that have a jerk limit: each on its own, along a profile of jerk, acceleration and jerk (Ruckig).

The commands up to now end as a parabola through the last three of them; the profile takes up its position, rate and
acceleration, so that the sampled jerk is inside the limit across the joint, too (mathematics, section 2).

Position and rate limits come first. Where the profile inside the jerk limit would leave one of them, or an E-stop would
take longer than `LONGER_S` more than without a jerk limit, the frame brakes with twice the jerk, and so on; where not
even `MOST` times it is enough, at once, as a frame without a jerk limit does.
"""

import math
from dataclasses import dataclass

import numpy as np
from ruckig import ControlInterface, InputParameter, Result, Ruckig, Trajectory

from fullpose._typing import Array
from fullpose.bounds import POSITION_TOLERANCE, TOLERANCE
from fullpose.rig import Rig

LONGER_S = 0.25  # [s] that an E-stop may take longer for its jerk limit
MOST = 64.0  # times the jerk limit
_SHARE = 0.9999  # of the limits: what is sampled is differenced, and rounds


@dataclass(frozen=True)
class FrameMotion:
    """One frame at the last command: position [rad], and rate [rad/s] and acceleration [rad/s^2] there."""

    x: float
    v: float
    a: float


@dataclass(frozen=True)
class JerkBraking:
    """The frames' profiles to rest from the tick of the last command: None where a frame brakes without.

    `fastest`: of an E-stop. `jerk_yielded`: whether a frame goes beyond its jerk limit.
    """

    profiles: tuple[Trajectory | None, ...]
    fastest: bool
    jerk_yielded: bool

    def positions(self, time: float, x: Array) -> bool:
        """x (4,) <- the positions [rad] `time` [s] on, of the frames that have a profile; whether all of them rest."""
        rest = True
        for i, profile in enumerate(self.profiles):
            if profile is not None:
                rest = rest and time >= profile.duration
                x[i] = profile.at_time(min(time, profile.duration))[0][0]
        return rest


def jerk_braking(rig: Rig, dt: float, state: tuple[Array, Array, Array], share: float, *, fastest: bool) -> JerkBraking:
    """The profiles to rest from the last command: position, rate, acceleration, (4,) each, as differences give them.

    share: of the acceleration limit, where that is enough.
    """
    profiles: list[Trajectory | None] = []
    jerk_yielded = False
    for i in range(4):
        if not math.isfinite(rig.max_jerk[i]):
            profiles.append(None)
            continue
        x, v, a = (float(each[i]) for each in state)
        profile, jerk_kept = _to_rest(rig, i, FrameMotion(x, v + 0.5 * a * dt, a), share, fastest=fastest)
        profiles.append(profile)
        jerk_yielded = jerk_yielded or not jerk_kept
    return JerkBraking(tuple(profiles), fastest, jerk_yielded)


def _to_rest(rig: Rig, frame: int, now: FrameMotion, share: float, *, fastest: bool) -> tuple[Trajectory | None, bool]:
    """(the first profile that keeps what comes first, whether its jerk is inside the limit); None: brake at once."""
    most, jerk = float(rig.max_acceleration[frame]), float(rig.max_jerk[frame])
    low, high = float(rig.position_min[frame]), float(rig.position_max[frame])
    reserve = POSITION_TOLERANCE
    low, high = min(low, now.x) - reserve, max(high, now.x) + reserve
    longest = math.inf
    if fastest:
        longest = (abs(now.v) / most if math.isfinite(most) else 0.0) + LONGER_S
    tries = [(share, 1.0)] if share < 1.0 else []
    tries += [(1.0, 2.0**k) for k in range(round(math.log2(MOST)) + 1)]
    for part, times in tries:
        profile = _profile(now, part * most, _SHARE * times * jerk)
        if profile is None:
            continue
        bounds = profile.position_extrema[0]
        peak = abs(now.v) + (0.5 * now.a * now.a / (_SHARE * times * jerk) if now.a * now.v > 0.0 else 0.0)
        slow = peak <= max(float(rig.max_rate[frame]), abs(now.v)) * (1.0 + 0.5 * TOLERANCE)
        if slow and bounds.min >= low and bounds.max <= high and profile.duration <= longest:
            return profile, times == 1.0
    return None, False


def _profile(now: FrameMotion, acceleration: float, jerk: float) -> Trajectory | None:
    """From a motion to rest; None where there is none."""
    plan = InputParameter(1)
    plan.control_interface = ControlInterface.Velocity
    plan.current_position, plan.current_velocity, plan.current_acceleration = [now.x], [now.v], [now.a]
    plan.target_velocity = plan.target_acceleration = [0.0]
    # Without an acceleration limit the profile has none: it would need no more than this.
    most = math.sqrt(abs(now.v) * jerk) + abs(now.a) + 1.0
    plan.max_acceleration, plan.max_jerk = [min(_SHARE * acceleration, most)], [jerk]
    profile = Trajectory(1)
    try:
        found = Ruckig(1).calculate(plan, profile) in (Result.Working, Result.Finished)
    except (ValueError, RuntimeError):
        return None
    return profile if found and np.isfinite(profile.duration) else None
