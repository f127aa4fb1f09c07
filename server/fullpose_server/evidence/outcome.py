"""What a run came to, by its record alone: how it ended, its largest errors, and whether the limits were kept.

What is compared with the limits is what was commanded while the drive was enabled, as the record has it; what was
measured has the encoders' noise in it, and is told beside.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fullpose._typing import Array
from fullpose.rig import FRAMES, Rig
from fullpose_server.runtime.contract.telemetry import Flag, Samples
from fullpose_server.runtime.recording.run_summary import RunSummary
from fullpose_server.session.run_end import RunEnd

POSITION_SLACK_DEG = 1e-9
RELATIVE_SLACK = 1e-6  # of a rate, acceleration or jerk, as the guard has it
_ROUNDING = 16.0 * 2.22e-16 * 180.0  # [deg] of a position, which rates, accelerations and jerks see through differences
_ENDED = {
    RunEnd.COMPLETED: "Flown to its end",
    RunEnd.STOPPED: "Stopped by command",
    RunEnd.SOURCE_LOST: "Ended as the live source was lost",
    RunEnd.OWNER_SILENT: "Ended as who held the lease was silent",
    RunEnd.SERVER_SILENT: "Ended as the server was silent",
    RunEnd.ESTOP: "E-stopped",
    RunEnd.FAULT: "Ended by a fault",
    RunEnd.LINK_LOST: "Ended as the link to the drive was lost",
    RunEnd.PROCESS_LOST: "Ended as the rig's process was lost",
}


@dataclass(frozen=True)
class FramePeaks:
    """Of one frame: the range and the largest magnitudes; None where the record has no number."""

    min_deg: float | None
    max_deg: float | None
    rate_deg_s: float | None
    acceleration_deg_s2: float | None
    measured_min_deg: float | None
    measured_max_deg: float | None
    measured_rate_deg_s: float | None


@dataclass(frozen=True)
class Exceeded:
    """A limit that was not kept, at its largest excess; `time_s` after the record's first sample."""

    frame: str
    limit: str
    value: float
    allowed: float
    time_s: float
    samples: int


@dataclass(frozen=True)
class Outcome:
    """`limits_kept` is None where the rig's limits are not known, or nothing was commanded."""

    sentence: str
    limits_kept: bool | None
    exceeded: tuple[Exceeded, ...]
    peaks: dict[str, FramePeaks]

    def to_json(self) -> dict[str, Any]:
        """Values for `json`."""
        return asdict(self) | {"exceeded": [asdict(one) for one in self.exceeded]}


def outcome_of(run: RunSummary, rows: Samples, rig: Rig | None) -> Outcome:
    """`rows` is the whole record; `rig` None: what it was is not known any more."""
    driven = rows[(rows["flags"] & Flag.ENABLED) != 0]
    time_s = (driven["time_ns"] - rows["time_ns"][0]) / 1e9 if len(rows) else np.empty(0)
    frames = range(4) if rig is None else rig.geometry.frames
    peaks = {FRAMES[index].value: _peaks(driven, index) for index in frames}
    exceeded: tuple[Exceeded, ...] = ()
    kept: bool | None = None
    if rig is not None and len(driven):
        exceeded = tuple(found for index in frames for found in _exceeded(driven, time_s, index, rig))
        kept = not exceeded
    return Outcome(_sentence(run, kept, exceeded), kept, exceeded, peaks)


def _peaks(rows: Samples, index: int) -> FramePeaks:
    def largest(name: str, sign: float = 0.0) -> float | None:
        values = rows[name][:, index]
        seen = values[np.isfinite(values)]
        if not seen.size:
            return None
        return float(np.abs(seen).max()) if sign == 0.0 else sign * float((sign * seen).max())

    return FramePeaks(
        min_deg=largest("demand", -1.0),
        max_deg=largest("demand", 1.0),
        rate_deg_s=largest("demand_rate"),
        acceleration_deg_s2=largest("demand_acceleration"),
        measured_min_deg=largest("measured", -1.0),
        measured_max_deg=largest("measured", 1.0),
        measured_rate_deg_s=largest("measured_rate"),
    )


def _exceeded(rows: Samples, time_s: Array, index: int, rig: Rig) -> list[Exceeded]:
    limits = rig.frames[index]
    rate_hz = 1e9 / float(np.median(np.diff(rows["time_ns"]))) if len(rows) > 1 else 1.0
    low, high, most_rate, most_acceleration, most_jerk = (
        math.degrees(each)
        for each in (limits.min, limits.max, limits.max_rate, limits.max_acceleration, limits.max_jerk)
    )
    position, rate, acceleration = (
        np.nan_to_num(rows[name][:, index]) for name in ("demand", "demand_rate", "demand_acceleration")
    )
    found = []
    for name, values, allowed, slack in (
        ("min_deg", -position, -low, POSITION_SLACK_DEG),
        ("max_deg", position, high, POSITION_SLACK_DEG),
        ("max_rate_deg_s", np.abs(rate), most_rate, RELATIVE_SLACK * most_rate + _ROUNDING * rate_hz),
        (
            "max_acceleration_deg_s2",
            np.abs(acceleration),
            most_acceleration,
            RELATIVE_SLACK * most_acceleration + _ROUNDING * rate_hz**2,
        ),
        (
            "max_jerk_deg_s3",
            np.abs(_jerk(rows, acceleration, rate_hz)),
            most_jerk,
            RELATIVE_SLACK * most_jerk + _ROUNDING * rate_hz**3,
        ),
    ):
        beyond = values > allowed + slack
        if beyond.any():
            at = int(np.argmax(values))
            sign = -1.0 if name == "min_deg" else 1.0
            told = sign * float(values[at]), sign * allowed
            found.append(Exceeded(FRAMES[index].value, name, *told, float(time_s[at]), int(beyond.sum())))
    return found


def _jerk(rows: Samples, acceleration: Array, rate_hz: float) -> Array:
    """Of one frame [deg/s^3], from the sample before each; 0 where that is missing or was not driven."""
    follows = np.diff(rows["seq"].astype(np.int64), prepend=rows["seq"][:1].astype(np.int64)) == 1
    changes: Array = np.where(follows, np.diff(acceleration, prepend=acceleration[:1]) * rate_hz, 0.0)
    return changes


def _sentence(run: RunSummary, kept: bool | None, exceeded: tuple[Exceeded, ...]) -> str:
    """The one sentence that a person reads."""
    if run.incident is not None:
        begun = f"No flight: what was kept around a fault ({run.incident})"
    else:
        begun = _ENDED[RunEnd(run.end)] if run.end in set(RunEnd) else "How it ended is not known"
        begun += f" ({run.end_code})" if run.end_code and run.end_code != run.end else ""
    told = [begun]
    if run.max_solve_error_deg is not None:
        told.append(f"largest solve error {_degrees(run.max_solve_error_deg)}")
    if run.max_tracking_error_deg is not None:
        told.append(f"largest tracking error {_degrees(run.max_tracking_error_deg)}")
    if run.lost_samples:
        told.append(f"{run.lost_samples} samples are missing from the record")
    if kept is None:
        told.append("whether the limits were kept is not known")
    elif kept:
        told.append("every limit of the rig was kept")
    else:
        first = exceeded[0]
        told.append(f"limits were exceeded: {first.frame} {first.limit} {first.value:.6g} of {first.allowed:.6g}")
    return "; ".join(told) + "."


def _degrees(value: float) -> str:
    return f"{value:.3g} deg"
