"""Attitudes from the wire to the solver and back."""

import numpy as np
from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import limited_name
from fullpose.errors import InputError
from fullpose_server.api.schemas.solve import Attitudes, Limited


def attitudes(message: Attitudes) -> tuple[Array, Array]:
    """time (n,) [s] and C (n, 3, 3). Raises `InputError` for a quaternion that is none."""
    time = np.array(message.time_s)
    if message.q is None:
        yaw, pitch, roll = np.deg2rad(np.array(message.euler_deg)).T
        return time, dcm_from_euler(yaw, pitch, roll)
    q = np.array(message.q)
    norm = np.linalg.norm(q, axis=1)
    bad = np.flatnonzero(~((norm > 0.5) & (norm < 2.0)))
    if bad.size:
        row = int(bad[0])
        raise InputError("q", row, q[row].tolist(), "a unit quaternion")
    return time, dcm_from_quaternion(q / norm[:, None])


def limited_list(codes: NDArray[np.int16]) -> list[Limited]:
    """The samples that a limit kept from their attitude."""
    rows = []
    for sample in np.flatnonzero(codes):
        name = limited_name(int(codes[sample]))
        if name is not None:
            rows.append(Limited.model_validate({"sample": int(sample), "frame": name[0], "limit": name[1]}))
    return rows
