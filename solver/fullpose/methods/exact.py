"""`exact`: the quadratic step in closed form, put on the exact solution curve (mathematics, sections 3 and 4)."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Codes, Counts, Integers
from fullpose.errors import MethodError
from fullpose.kinematics import four_axis_pose
from fullpose.limits import WEIGHT, limit_table
from fullpose.methods.base import Block, StepMethod
from fullpose.methods.start_pose import start_pose
from fullpose.methods.state import (
    CLOCK,
    CODE,
    FRESH,
    GUESS,
    HI,
    INCREMENT,
    LO,
    NULL,
    PHASE,
    POSE,
    ROWS,
    TOLERANCE,
    advance,
    finish,
    goal_from,
    hold_position,
    new_state,
    null_space_increment,
    prepare,
)
from fullpose.options import Options, ranged
from fullpose.rig import Rig
from fullpose.step import quadratic_step


@dataclass(frozen=True)
class ExactOptions(Options):
    """How the redundant frame is used. Raises `MethodError` where a gain is negative or not a number.

    The pose nearest (in the rig's weights) to the last one plus these movements along the self-motion is taken; with
    all of them zero it is the minimum-norm step of the literature. The defaults fly more of the random flights than
    that (docs/decisions/0010-null-space-defaults.md) and take a level turn past the singularity.
    avoidance: how fast the frames leave the singularity [rad/s]; centring: how fast they leave their end stops [rad/s];
    homing: how fast they return home [1/s]; recovery: share of the smallest frame acceleration that brakes the return
    to the attitude after a limited sample.
    """

    avoidance: float = ranged(2.0, 0.0)
    centring: float = ranged(2.0, 0.0)
    homing: float = ranged(0.0, 0.0)
    recovery: float = ranged(0.5, 0.0, 1.0, open=True)


@kernel
def exact_block(
    horizontal: bool,
    axes: Integers,
    table: Array,
    gains: Array,
    time: Array,
    attitude: Array,
    state: Array,
    target: Array,
    angles: Array,
    limited: Codes,
    iterations: Counts,
) -> None:
    """Advance `state` over m samples: time (m,), attitude (m, 3, 3) in; angles (m, 4), limited, iterations (m,) out.

    gains: avoidance, centring, homing, recovery.
    """
    work = np.empty((ROWS, 4))
    J = np.empty((3, 4))
    F = np.empty((3, 3))
    G = np.empty((3, 3))
    A = np.empty((4, 5))
    e = np.empty(3)
    lo_code = np.empty(4, np.int16)
    hi_code = np.empty(4, np.int16)
    d = state[0:4]
    for k in range(time.shape[0]):
        C = attitude[k]
        if state[PHASE] == FRESH:
            code = int(state[CODE])
            iterations[k] = 0
            for i in range(4):
                work[POSE, i] = d[i]
        else:
            h = time[k] - state[CLOCK]
            prepare(table, state, h, work, lo_code, hi_code)
            null_space_increment(table, d, h, gains, work[INCREMENT])
            manipulability = four_axis_pose(horizontal, d, F, J, work[NULL])
            on_target = goal_from(table, axes, state, target, C, h, gains[3], F, G, e)
            quadratic_step(
                J,
                work[NULL],
                manipulability,
                table[WEIGHT],
                d,
                work[INCREMENT],
                e,
                work[LO],
                work[HI],
                work[TOLERANCE],
                work[GUESS],
            )
            iterations[k], code = finish(
                horizontal, axes, table, state, on_target, G, J, e, F, work, A, lo_code, hi_code
            )
        for i in range(4):
            angles[k, i] = work[POSE, i]
        limited[k] = code
        advance(state, target, time[k], work[POSE], code, C)


class ExactStepper:
    """One flight in progress with `exact`."""

    def __init__(self, rig: Rig, options: ExactOptions, start: Array | None, attitude: Array) -> None:
        if not rig.geometry.redundant:
            raise MethodError(f"exact needs the fourth axis; {rig.name} is {rig.geometry.value}: use three_axis")
        self._rig = rig
        self._table = limit_table(rig)
        self._gains = np.array([options.avoidance, options.centring, options.homing, options.recovery])
        self._state = new_state(*start_pose(rig, attitude, start))
        self._target = np.array(attitude, order="C")

    def begin_at_rest(self, dt: float) -> None:
        """Stand at the start pose at time 0, `dt` [s] after standing there; without it the first rate is free."""
        hold_position(self._state, dt)

    def block(self, time: Array, attitude: Array) -> Block:
        """Advance over samples: time (m,) [s], attitude (m, 3, 3)."""
        m = len(time)
        out = Block(np.empty((m, 4)), np.empty(m, np.int16), np.empty(m, np.int32))
        exact_block(
            self._rig.geometry.horizontal,
            self._rig.axes,
            self._table,
            self._gains,
            time,
            attitude,
            self._state,
            self._target,
            out.angles,
            out.limited,
            out.iterations,
        )
        return out


METHOD = StepMethod(
    name="exact",
    source="the closed-form null-space step with the exact charts (Lin 2022; Zhao 2025, second optimisation)",
    claims_limits=True,
    options=ExactOptions,
    stepper=ExactStepper,
)
