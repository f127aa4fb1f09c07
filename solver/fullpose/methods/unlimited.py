"""What the literature's step methods share: the start, the state between blocks and the call of their kernel.

Every one of them knows no limits of the frames; those that avoid a limit (`dwln`, `gradient_projection`) do not
promise to keep it.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Counts, Integers
from fullpose.bounds import EXACT
from fullpose.errors import MethodError
from fullpose.methods.base import Block
from fullpose.methods.start_pose import start_pose
from fullpose.rig import Rig

# State of a flight in progress, one array: d (4), the last step (4), then
LAST_STEP, TARGET, CLOCK, PLACED, MEMORY = 4, 8, 17, 18, 19
STATE = 24  # MEMORY on: what one method keeps for itself

# (horizontal, axes, weight (4,), parameters, time (m,), attitude (m, 3, 3), state, angles (m, 4), iterations (m,))
SequenceKernel = Callable[[bool, Integers, Array, Array, Array, Array, Array, Array, Counts], None]


@kernel
def first_sample(time: float, C: Array, state: Array, out: Array) -> bool:
    """Whether this is the flight's first sample; then out <- the start pose (4,) and the state is set going."""
    if state[PLACED] != 0.0:
        return False
    for i in range(4):
        out[i] = state[i]
    keep_sample(time, C, out, state)
    state[PLACED] = 1.0
    return True


@kernel
def keep_sample(time: float, C: Array, x: Array, state: Array) -> None:
    """Take the pose x (4,) [rad] for the target C (3, 3) at `time` [s] into the state."""
    for i in range(4):
        state[LAST_STEP + i] = x[i] - state[i]
        state[i] = x[i]
    for i in range(3):
        for j in range(3):
            state[TARGET + 3 * i + j] = C[i, j]
    state[CLOCK] = time


def open_rig(rig: Rig) -> Rig:
    """The rig without position limits."""
    frames = tuple(replace(frame, min=-math.inf, max=math.inf) for frame in rig.frames)
    return replace(rig, frames=(frames[0], frames[1], frames[2], frames[3]))


def exact_start(rig: Rig, attitude: Array, near: Array | None) -> Array:
    """The exact pose (4,) [rad] nearest to `near` (or home): inside the position limits where there is one, else any.

    These methods do not know limits, so they rather start outside one than off the attitude.
    """
    pose, code = start_pose(rig, attitude, near)
    return pose if code == EXACT else start_pose(open_rig(rig), attitude, near)[0]


class SequenceStepper:
    """One flight in progress with a method whose block is one kernel."""

    def __init__(self, rig: Rig, run: SequenceKernel, parameters: list[float], pose: Array) -> None:
        self._rig = rig
        self._run = run
        self._parameters = np.array(parameters, dtype=np.float64)
        self._state = np.zeros(STATE)
        self._state[:4] = pose

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        angles = np.empty((m, 4))
        iterations = np.zeros(m, np.int32)
        self._run(
            self._rig.geometry.horizontal,
            self._rig.axes,
            self._rig.weight,
            self._parameters,
            time,
            np.ascontiguousarray(attitude),
            self._state,
            angles,
            iterations,
        )
        return Block(angles, np.zeros(m, np.int16), iterations)


def require_fourth_axis(name: str, rig: Rig) -> None:
    """Raises `MethodError` where the rig has no redundant axis."""
    if not rig.geometry.redundant:
        raise MethodError(f"{name} needs the fourth axis; {rig.name} is {rig.geometry.value}: use three_axis")
