"""A flight thinned for plots."""

from typing import Any

from fullpose._typing import Array
from fullpose_server.formats.trajectory import euler_deg
from fullpose_server.pages.thin import thin


def thinned_flight(time: Array, q: Array, points: int) -> dict[str, Any]:
    """time (n,) [s] and q (n, 4) at about `points` samples, as columns of equal length for JSON."""
    euler = euler_deg(q)  # of all samples: between those that are kept, whole turns may be
    rows = thin(time.size, points, euler)
    yaw, pitch, roll = euler[rows].T.tolist()
    return {
        "time_s": time[rows].tolist(),
        "yaw_deg": yaw,
        "pitch_deg": pitch,
        "roll_deg": roll,
        "q": [tuple(row) for row in q[rows].tolist()],
    }
