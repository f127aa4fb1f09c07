"""Lead-in and lead-out: from rest to a path that begins in motion, and from its end to rest.

Each frame's rate follows a cubic from 0 with no acceleration to the path's rate with the path's acceleration, so the
joint is twice continuously differentiable and the rest before it is rest: with s = t / T,
v(t) = v (3 s^2 - 2 s^3) + a T (s^3 - s^2). Each frame takes the shortest time T that keeps its samples inside its
limits; where there is no room for any, an acceleration that ramps up to nearly its limit, holds, and ramps to the
path's, which needs little more than the braking distance. A frame that needs less time than the others rests first.
A lead-out is a lead-in in reversed time.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly

from fullpose._typing import Array
from fullpose.errors import InputError, MethodError
from fullpose.rig import FRAMES, LIMITS, FrameLimits, Rig
from fullpose.verify import POSITION_TOLERANCE, TOLERANCE

SHORTEST, LONGEST = 0.1, 20.0  # [s] of a cubic
STRETCH = 1.02  # from one duration that is tried to the next
RAMPS = (0.2, 0.1, 0.05, 0.02, 0.01)  # [s]
FULL = 0.999  # of the acceleration limit
AT_REST = 1e-9  # of a rate [rad/s] or acceleration [rad/s^2]


def lead_in(rig: Rig, position: ArrayLike, rate: ArrayLike, acceleration: ArrayLike, dt: float) -> Array:
    """Samples from rest to the path, (m, 4) [rad], one every `dt` [s]; the path's own first sample is not repeated.

    position, rate, acceleration (4,) [rad, rad/s, rad/s^2] are those of the path's first sample. m is 0 for a path that
    begins at rest. Raises `MethodError`, naming frame and limit, where there is no room, `InputError` for bad numbers.
    """
    x, v, a = (
        _checked(name, value)
        for name, value in (("position", position), ("rate", rate), ("acceleration", acceleration))
    )
    if not (math.isfinite(dt) and dt > 0.0):
        raise InputError("dt", None, dt, "a number of seconds above zero")
    columns = [
        _frame_lead(FRAMES[i], rig.frames[i], float(x[i]), float(v[i]), float(a[i]), dt)
        if i in rig.geometry.frames
        else np.empty(0)
        for i in range(4)
    ]
    m = max(len(column) for column in columns)
    lead = np.empty((m, 4))
    for i, column in enumerate(columns):
        lead[: m - len(column), i] = column[0] if len(column) else x[i]
        lead[m - len(column) :, i] = column
    return lead


def lead_out(rig: Rig, position: ArrayLike, rate: ArrayLike, acceleration: ArrayLike, dt: float) -> Array:
    """Samples from the path's last sample, which is not repeated, to rest: (m, 4) [rad], one every `dt` [s].

    As `lead_in`, of which it is the mirror in time: rates change their sign, accelerations do not.
    """
    return lead_in(rig, position, -np.asarray(rate, float), acceleration, dt)[::-1].copy()


def _frame_lead(frame: str, limits: FrameLimits, x: float, v: float, a: float, dt: float) -> Array:
    """One frame's lead-in, (m,) [rad], the first candidate that obeys the limits."""
    if abs(v) <= AT_REST and abs(a) <= AT_REST:
        return np.empty(0)
    closest: tuple[float, str, float, float] | None = None
    for lead in _candidates(limits, x, v, a, dt):
        shortfall = _shortfall(limits, lead, x, v, a, dt)
        if shortfall is None:
            return lead
        limit, value, allowed = shortfall
        excess = abs(abs(value) - abs(allowed)) / max(abs(allowed), 1e-12)
        if closest is None or excess < closest[0]:
            closest = (excess, limit, value, allowed)
    _, limit, value, allowed = closest or (0.0, LIMITS[1], v, limits.max_rate)
    raise MethodError(
        f"no lead for the {frame} frame: its {limit} would be {value:.6g} where {allowed:.6g} is allowed (rad, s); "
        f"the path begins or ends with {v:.6g} rad/s and {a:.6g} rad/s^2 at {x:.6g} rad"
    )


def _candidates(limits: FrameLimits, x: float, v: float, a: float, dt: float) -> Iterator[Array]:
    """Lead-ins from smooth and short to tight, each (m,) [rad]."""
    # Below this duration the cubic's peak alone, 1.5 v / T, is above the limit.
    least = 1.5 * abs(v) / limits.max_acceleration if math.isfinite(limits.max_acceleration) else 0.0
    samples = max(2, math.ceil(max(0.9 * least, SHORTEST) / dt))
    while samples * dt <= LONGEST:
        T = samples * dt
        s = np.arange(samples) / samples
        # x(0) = x - v T / 2 + a T^2 / 12, and then the integral of v(t)
        yield x - v * T / 2 + a * T * T / 12 + v * T * (s**3 - s**4 / 2) + a * T * T * (s**4 / 4 - s**3 / 3)
        samples = max(samples + 1, int(samples * STRETCH))
    if math.isinf(limits.max_acceleration):
        return
    for ramp in RAMPS:
        peak = math.copysign(FULL * limits.max_acceleration, v)
        hold = (v - peak * ramp - 0.5 * a * ramp) / peak
        if hold >= 0.0:
            yield _trapezoid(x, a, peak, ramp, hold, dt)


def _trapezoid(x: float, a: float, peak: float, ramp: float, hold: float, dt: float) -> Array:
    """(m,) [rad]: acceleration 0, up to `peak` within `ramp` [s], held for `hold` [s], to `a` within `ramp`."""
    knots = np.cumsum([0.0, ramp, hold, ramp]) if hold > 0.0 else np.array([0.0, ramp, 2.0 * ramp])
    levels = np.array([0.0, peak, peak, a]) if hold > 0.0 else np.array([0.0, peak, a])
    position = PPoly(np.stack([np.diff(levels) / np.diff(knots), levels[:-1]]), knots).antiderivative(2)
    m = math.ceil(knots[-1] / dt)
    t = np.maximum(knots[-1] - dt * np.arange(m, 0, -1), 0.0)
    return np.asarray(x - float(position(knots[-1])) + position(t))


def _shortfall(
    limits: FrameLimits, lead: Array, x: float, v: float, a: float, dt: float
) -> tuple[str, float, float] | None:
    """(limit, value, allowed) of the limit the lead exceeds most plainly, as the samples' differences; None if none."""
    # Rest before, and one sample of the path beyond the joint.
    path = np.concatenate([[lead[0], lead[0]], lead, [x, x + v * dt + 0.5 * a * dt * dt]])
    rate = np.diff(path) / dt
    acceleration = np.diff(rate) / dt
    if path.min() < limits.min - POSITION_TOLERANCE:
        return LIMITS[0], float(path.min()), limits.min
    if path.max() > limits.max + POSITION_TOLERANCE:
        return LIMITS[0], float(path.max()), limits.max
    for limit, values, allowed in ((1, rate, limits.max_rate), (2, acceleration, limits.max_acceleration)):
        worst = int(np.argmax(np.abs(values)))
        if abs(values[worst]) > allowed * (1.0 + 0.5 * TOLERANCE):
            return LIMITS[limit], float(values[worst]), allowed
    return None


def _checked(name: str, value: ArrayLike) -> Array:
    array = np.asarray(value, float)
    if array.shape != (4,) or not np.isfinite(array).all():
        raise InputError(name, None, array.tolist(), "four finite numbers, base first")
    return array
