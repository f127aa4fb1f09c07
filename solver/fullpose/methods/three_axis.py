"""`three_axis`: the Euler angles themselves, to show the singularity that the fourth axis removes.

mathematics, section 7.

Source: the vertical (yaw, pitch, roll) and horizontal (pitch, yaw, roll) three-axis tables that Zhao 2025 and Lin 2022
compare with (mathematics, section 2); singular where the second angle is +-90 deg. A four-axis rig is used as one by
holding its middle frame at zero: base, outer and inner then are the three axes. No limits are looked at.
"""

import math
from dataclasses import dataclass

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.charts import nearest
from fullpose.methods.base import Block, StepMethod, Stepper
from fullpose.options import Options
from fullpose.rig import Rig, Y

# Below this the first axis is lost in rounding; the attitude error of any first angle is no larger than it.
POLE = 1e-15


@dataclass(frozen=True)
class ThreeAxisOptions(Options):
    """The method has none."""


@kernel
def three_axis_angles(first_is_y: bool, C: Array, branch: float, previous: float, out: Array) -> None:
    """out <- (first, second, roll) [rad] of C = Rx(roll) R(second) R(first), sign(cos second) = branch.

    First and second turn about y and z (vertical) or about z and y (horizontal). Each angle is taken from C with the
    earlier ones undone, so that the three together are exact also next to the pole, where the first alone is not
    determined; on the pole it is `previous`. C (3, 3), out (3,).
    """
    side = -C[0, 2] if first_is_y else C[0, 1]
    first = previous if math.hypot(C[0, 0], side) < POLE else math.atan2(branch * side, branch * C[0, 0])
    c = math.cos(first)
    s = math.sin(first)
    along = C[0, 0] * c + side * s
    out[0] = first
    if first_is_y:
        out[1] = math.atan2(C[0, 1], along)
        out[2] = math.atan2(C[1, 0] * s + C[1, 2] * c, C[2, 0] * s + C[2, 2] * c)
    else:
        out[1] = math.atan2(-C[0, 2], along)
        out[2] = math.atan2(C[2, 0] * s - C[2, 1] * c, C[1, 1] * c - C[1, 0] * s)


@kernel
def three_axis_block(first_is_y: bool, columns: Integers, attitude: Array, d: Array, angles: Array) -> None:
    """angles <- for each attitude the set of the two that is nearer to the sample before; d is carried on.

    columns (3,) of first, second, roll; attitude (m, 3, 3); d (4,), angles (m, 4) [rad].
    """
    candidate = np.empty(3)
    for k in range(attitude.shape[0]):
        best = np.inf
        for branch in (1.0, -1.0):
            three_axis_angles(first_is_y, attitude[k], branch, d[columns[0]], candidate)
            distance = 0.0
            for i in range(3):
                candidate[i] = nearest(candidate[i], d[columns[i]])
                distance += (candidate[i] - d[columns[i]]) ** 2
            if distance < best:
                best = distance
                for i in range(3):
                    angles[k, columns[i]] = candidate[i]
        for i in range(3):
            d[columns[i]] = angles[k, columns[i]]


class _ThreeAxisStepper:
    def __init__(self, rig: Rig, start: Array | None) -> None:
        real = [i for i in rig.geometry.frames if not (rig.geometry.redundant and i == 2)]
        self._columns = np.array(real, dtype=np.int64)
        self._first_is_y = rig.geometry.axes[real[0]] == Y
        self._d = np.array(rig.home if start is None else start, dtype=np.float64)

    def block(self, time: Array, attitude: Array) -> Block:
        m = time.size
        angles = np.zeros((m, 4))
        three_axis_block(self._first_is_y, self._columns, np.ascontiguousarray(attitude), self._d, angles)
        return Block(angles, np.zeros(m, np.int16), np.ones(m, np.int32))


def _stepper(rig: Rig, options: ThreeAxisOptions, start: Array | None, first: Array) -> Stepper:  # noqa: ARG001
    return _ThreeAxisStepper(rig, start)


METHOD = StepMethod(
    name="three_axis",
    source="Euler angles Y-Z-X (vertical) and Z-Y-X (horizontal), the three-axis tables of Zhao 2025 and Lin 2022",
    claims_limits=False,
    options=ThreeAxisOptions,
    stepper=_stepper,
)
