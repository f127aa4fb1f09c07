"""What a planning process is told; light, so that the server need not load the numerics to say it."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from fullpose.errors import InputError
from fullpose.rig import FRAMES, Rig
from fullpose_server.formats.rig_codec import rig_from_values, rig_values


@dataclass(frozen=True)
class PlanRequest:
    """All that a planning process is told."""

    plan_id: str
    folder: Path  # where the plan goes
    trajectory: Path  # folder of the flight's arrays
    trajectory_sha256: str
    name: str
    rig: Rig
    rate_hz: float
    method: str
    options: dict[str, Any]
    start: tuple[float, float, float, float] | None  # [rad]
    tolerance_deg: float | None = None  # by which the attitude may differ from the flight's
    remedy: dict[str, Any] | None = None  # kind, frame, limit: the flight is to be changed until it fits

    def to_json(self) -> dict[str, Any]:
        """Values for `json`."""
        return {
            **asdict(self),
            "rig": rig_values(self.rig),
            "folder": str(self.folder),
            "trajectory": str(self.trajectory),
        }

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "PlanRequest":
        """The inverse of `to_json`."""
        start = values["start"]
        return cls(
            **{
                **values,
                "folder": Path(values["folder"]),
                "trajectory": Path(values["trajectory"]),
                "rig": rig_from_values(values["rig"]),
                "start": None if start is None else tuple(start),
            }
        )


def check_frame(frame: str | None, rig: Rig) -> None:
    """Raise `InputError` where a limit of a frame that the rig has not is asked for."""
    present = [FRAMES[index] for index in rig.geometry.frames]
    if frame is not None and frame not in present:
        raise InputError("frame", None, frame, f"one of {', '.join(present)}: {rig.name} has no {frame} frame")
