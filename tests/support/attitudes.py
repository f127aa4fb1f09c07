"""The attitude that was read against the truth, by SciPy's rotations: nothing is shared with what reads."""

import numpy as np
from scipy.spatial.transform import Rotation

from fullpose_server.formats.trajectory import Trajectory

# v_ours = (reference) v_theirs of each convention's axes, and the same of its body axes.
OURS_FROM = {
    "nue": (np.eye(3), np.eye(3)),
    "ned": (np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])),
    "enu": (np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])),
}


def attitude_error_deg(flight: Trajectory, body_to_reference: Rotation, axes: str) -> float:
    """The largest angle [deg] between a flight and the truth, given in the axes it was written in."""
    reference, body = OURS_FROM[axes]
    truth = Rotation.from_matrix(reference @ body_to_reference.as_matrix() @ body.T)
    return float(np.degrees((Rotation.from_quat(flight.q, scalar_first=True) * truth.inv()).magnitude().max()))
