"""The example flights as the library takes them, read without the server."""

import numpy as np

from fullpose._typing import Array
from fullpose.attitude import euler_from_ned, quaternion_from_euler, quaternion_from_ned
from tests.support.repository import FLIGHTS


def example_flight(name: str) -> tuple[Array, Array]:
    """(time (n,) [s], quaternion (n, 4)) of examples/flights/NAME.csv, whose rows are north-east-down."""
    rows = np.loadtxt(FLIGHTS / f"{name}.csv", delimiter=",", skiprows=1)
    if rows.shape[1] == 5:
        return rows[:, 0], quaternion_from_ned(rows[:, 1:])
    return rows[:, 0], quaternion_from_euler(*euler_from_ned(*np.radians(rows[:, 1:]).T))
