"""The map of a stored plan (mathematics, section 14), as the offload process makes it."""

from pathlib import Path
from typing import Any

import numpy as np

from fullpose.attitude import dcm_from_quaternion
from fullpose.rig import Rig
from fullpose_server.formats.plan_folder import read_plan
from fullpose_server.formats.plane_document import plane_document


def plan_plane(folder: Path, rig: Rig, columns: int, rows: int) -> dict[str, Any]:
    """The values of a `PlaneOut`, without the leads.

    The attitude is what the frames make, where the plan is good, since a tolerance may have smoothed the flight;
    the flight's own where it is not.
    """
    stored = read_plan(folder)
    info = stored.info
    flight = slice(info.lead_in_samples, info.samples - info.lead_out_samples)
    time = np.arange(info.samples - info.lead_in_samples - info.lead_out_samples) / info.rate_hz
    attitude = None if info.feasible else dcm_from_quaternion(np.asarray(stored.target[flight]))
    return plane_document(time, attitude, np.asarray(stored.angles[flight]), rig, columns, rows)
