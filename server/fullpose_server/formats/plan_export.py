"""A plan as a table to be exported."""

import numpy as np

from fullpose_server.formats.exporters.table import ExportTable, Values, by_frame, motion_of
from fullpose_server.formats.plan_folder import PlanFolder
from fullpose_server.formats.trajectory import QUATERNION


def plan_table(plan: PlanFolder) -> ExportTable:
    """What is flown, leads included, at the rig's rate, with the rates and accelerations of `motion_of`.

    `time_s` is the flight's own; target and error are the flight's, nan in the leads.
    """
    info = plan.info
    time = info.start_s + (np.arange(info.samples) - info.lead_in_samples) / info.rate_hz
    position = np.rad2deg(plan.angles)
    # At the rig's own period: the difference of two stamps that are far from zero has their rounding in it.
    motion = motion_of(np.arange(info.samples) / info.rate_hz, position)
    lead = np.ones(info.samples, np.uint8)
    lead[info.lead_in_samples : info.samples - info.lead_out_samples] = 0
    columns: dict[str, Values] = {
        "time_s": time,
        **by_frame("", "deg", position),
        **by_frame("rate", "deg_s", motion.rate),
        **by_frame("acceleration", "deg_s2", motion.acceleration),
        **{name: np.ascontiguousarray(plan.target[:, k]) for k, name in enumerate(QUATERNION)},
        "error_deg": np.rad2deg(plan.error),
        "lead": lead,
    }
    facts = {
        "plan": info.plan_id,
        "plan_hash": info.plan_hash,
        "flight": info.name,
        "flight_sha256": info.trajectory_sha256,
        "rig": info.rig,
        "method": info.method,
        "rate_hz": repr(info.rate_hz),
        "feasible": str(info.feasible).lower(),
    }
    return ExportTable("plan", columns, facts, lambda: motion)
