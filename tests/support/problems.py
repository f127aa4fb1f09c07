"""Random step problems: a pose's Jacobian, an increment to make, a box of steps around it."""

from typing import NamedTuple

import numpy as np

from fullpose._typing import Array
from fullpose.kinematics import jacobian, null_vector
from fullpose.rig import builtin_rigs

RIGS = builtin_rigs()


class Problem(NamedTuple):
    """In the symbols of `fullpose.step`; lo and hi are bounds of the step."""

    J: Array
    n: Array
    manipulability: float
    weight: Array
    g: Array
    e: Array
    lo: Array
    hi: Array


def random_problem(seed: int, width: float, scale: float = 1e-3) -> Problem:
    """A random pose of either four-axis rig; the box is `width` times the increment, whose size is `scale` [rad]."""
    random = np.random.default_rng(seed)
    rig = RIGS[("vertical-4", "horizontal-4")[seed % 2]]
    J, n = np.empty((3, 4)), np.empty(4)
    jacobian(rig.axes, random.uniform(-np.pi, np.pi, 4), J)
    manipulability = null_vector(J, n)
    e = scale * random.normal(size=3)
    middle = 0.3 * scale * random.normal(size=4)
    half = width * scale * random.uniform(0.2, 1.0, 4)
    weight = np.exp(random.normal(size=4))
    return Problem(J, n, manipulability, weight, 0.2 * scale * random.normal(size=4), e, middle - half, middle + half)
