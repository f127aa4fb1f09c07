"""What the noise of a record costs the frames of a rig (mathematics, sections 2 and 13)."""

import numpy as np

from fullpose._jit import kernel
from fullpose._typing import Array, Integers
from fullpose.kinematics import jacobian
from fullpose.rig import Rig

_SINGULAR = 1e-6  # of the largest singular value: nearer to it the cost is without bound, and no figure


@kernel
def _jacobians(axes: Integers, angles: Array, J: Array) -> None:
    for k in range(angles.shape[0]):
        jacobian(axes, angles[k], J[k])


def frame_noise_acceleration(rig: Rig, angles: Array, body: Array) -> Array:
    """The standard deviation of each frame's acceleration (m, 4) [rad/s^2] at the poses angles (m, 4) [rad].

    body (3,): that of the body's acceleration [rad/s^2]. By the least-norm share, d'' = J^+ w': on a four-axis rig
    another share only costs more in all. A frame that is absent has zero.
    """
    J = np.empty((len(angles), 3, 4))
    _jacobians(rig.axes, np.ascontiguousarray(angles, dtype=np.float64), J)
    share = np.linalg.pinv(J, rcond=_SINGULAR)  # (m, 4, 3)
    return np.asarray(np.sqrt(np.einsum("mij,j->mi", share**2, body**2)))
