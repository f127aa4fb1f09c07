"""Braking: each frame on its own, inside its acceleration limit and short of its position limits."""

import math

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array


@kernel
def stopping_distance(rate: float, deceleration: float, dt: float) -> float:
    """How far a frame still goes when each tick takes `deceleration` dt off its rate [rad], as `brake_step` does it."""
    speed = abs(rate)
    drop = deceleration * dt
    if not drop > 0.0:
        return math.inf if speed > 0.0 else 0.0
    steps = math.floor(speed / drop)
    return dt * (steps * speed - 0.5 * drop * steps * (steps + 1.0))


@kernel
def brake_step(dt: float, deceleration: Array, x1: Array, v1: Array, x: Array, v: Array) -> bool:
    """One tick of braking from position x1 and rate v1 to x and v, all (4,); returns whether every frame rests."""
    rest = True
    for i in range(4):
        left = abs(v1[i]) - deceleration[i] * dt
        v[i] = math.copysign(left, v1[i]) if left > 0.0 else 0.0
        x[i] = x1[i] + v[i] * dt
        if v[i] != 0.0:
            rest = False
    return rest


def deceleration_for(
    fraction: float, x: Array, v: Array, lower: Array, upper: Array, most: Array, unlimited: float
) -> Array:
    """The deceleration of each frame (4,) [rad/s^2]: `fraction` of its limit, more where a position limit is near.

    `most` (4,) is the acceleration limit, inf where there is none: `unlimited` serves then.
    """
    limit = np.where(np.isfinite(most), most, unlimited)
    room = np.where(v > 0.0, upper - x, x - lower)
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = np.where(v == 0.0, 0.0, v * v / (2.0 * room))
    needed = np.where(room > 0.0, needed, limit)
    return np.asarray(np.minimum(np.maximum(fraction * limit, needed), limit))
