"""`exact`: the quadratic step in closed form, put on the exact solution curve (mathematics, sections 3 and 4)."""

from dataclasses import dataclass

import numpy as np

from fullpose._jit import inner
from fullpose._typing import Array
from fullpose.kinematics import four_axis_pose
from fullpose.methods.base import StepMethod, Stepper
from fullpose.methods.block import block_kernel
from fullpose.methods.limited import (
    Gains,
    LimitedStepper,
    closed_form_step,
    finish,
    flight_from,
    goal_from,
    null_space_increment,
)
from fullpose.methods.state import Flight, box_ahead
from fullpose.options import Options, ranged
from fullpose.rig import Rig


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


@inner
def exact_step(flight: Flight, _parameters: Array, C: Array) -> tuple[int, int]:
    """See `block.propose`."""
    box_ahead(flight)
    null_space_increment(flight)
    manipulability = four_axis_pose(flight.horizontal, flight.pose, flight.F, flight.J, flight.null)
    goal_from(flight, C)
    closed_form_step(flight, manipulability, flight.pose, flight.guess)
    return finish(flight)


exact_block = block_kernel("exact_block", exact_step)


def _stepper(rig: Rig, options: ExactOptions, start: Array | None, attitude: Array) -> Stepper:
    gains = Gains(options.avoidance, options.centring, options.homing, options.recovery)
    return LimitedStepper(exact_block, np.empty(0), gains, flight_from("exact", rig, start, attitude))


METHOD = StepMethod(
    name="exact",
    source="the closed-form null-space step with the exact charts (Lin 2022; Zhao 2025, second optimisation)",
    claims_limits=True,
    options=ExactOptions,
    stepper=_stepper,
)
