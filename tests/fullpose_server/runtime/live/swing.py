"""A flight that live sources send, a smooth swing about all axes: `tests.fullpose_server.runtime.live.swing`."""

import math

import numpy as np

from fullpose.attitude import quaternion_from_euler


def flight(t: float, swing_deg: float = 20.0) -> tuple[np.ndarray, np.ndarray]:
    """An attitude (4,) w, x, y, z and its body rate (3,) [rad/s] at time t: begins at rest at t = 0."""

    def q(at: float) -> np.ndarray:
        u = min(1.0, max(0.0, at / 2.0))
        ramp = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
        a = math.radians(swing_deg) * ramp * np.sin(2.0 * np.pi * np.array([0.3, 0.23, 0.4]) * at)
        return np.asarray(quaternion_from_euler(a[0], a[1], a[2])[0])

    h = 1e-6
    now, dq = q(t), (q(t + h) - q(t - h)) / (2.0 * h)
    w, x, y, z = now
    rate = 2.0 * np.array(
        [
            w * dq[1] - x * dq[0] - y * dq[3] + z * dq[2],
            w * dq[2] - y * dq[0] - z * dq[1] + x * dq[3],
            w * dq[3] - z * dq[0] - x * dq[2] + y * dq[1],
        ]
    )
    return now, rate


def angle_deg(a: np.ndarray, b: np.ndarray) -> float:
    """The turn between two attitudes (4,)."""
    return float(np.degrees(2.0 * np.arccos(min(1.0, abs(float(a @ b))))))
