"""What the comparing process is told; light, so that the server need not load the numerics to say it."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from fullpose.registry import Variant
from fullpose.rig import Rig
from fullpose_server.formats.rig_codec import rig_from_values, rig_values

REQUEST, REPORT, PAGE, ERROR = "request.json", "report.json", "page.html", "error.json"


@dataclass(frozen=True)
class CompareRequest:
    """All that the comparing process is told beside its folder; JSON in the job's folder."""

    trajectory_sha256: str
    trajectory: str  # folder of the flight's arrays
    name: str
    rig: Rig
    methods: tuple[Variant, ...]
    rate_hz: float
    start: tuple[float, float, float, float] | None  # [rad]
    created: float  # [s] since the epoch
    tolerance_deg: float | None = None  # by which the attitude may differ from the flight's

    def to_json(self) -> str:
        """One JSON document."""
        return json.dumps({**asdict(self), "rig": rig_values(self.rig)})

    @classmethod
    def from_json(cls, text: str) -> "CompareRequest":
        """The inverse of `to_json`."""
        values = json.loads(text)
        start = values["start"]
        return cls(
            **{
                **values,
                "rig": rig_from_values(values["rig"]),
                "methods": tuple(_variant(method) for method in values["methods"]),
                "start": None if start is None else tuple(start),
            }
        )


def _variant(value: str | Mapping[str, Any]) -> Variant:
    return Variant(value, value) if isinstance(value, str) else Variant(**value)  # earlier servers kept names alone


def read_request(folder: Path) -> CompareRequest:
    """The request of a job's folder."""
    return CompareRequest.from_json((folder / REQUEST).read_text(encoding="utf-8"))
