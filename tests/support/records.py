"""Records of made-up runs, written as the recorder writes them."""

from pathlib import Path
from typing import Any

from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord

WALL_NS = 1_790_000_000_000_000_000


def write_record(path: Path, rows: Samples, events: list[dict[str, Any]], chunk: int = 100, plan: str = "{}") -> Path:
    """A complete record with the rows (n,) in chunks of so many, and the events before them."""
    begun_ns = int(rows["time_ns"][0]) if len(rows) else 0
    made = RunRecord(path, {"run_id": path.stem, "rig": "vertical-4", "who": "ada", "plan": plan}, WALL_NS, begun_ns)
    for event in events:
        made.add_event(event)
    for first in range(0, len(rows), chunk):
        made.add_samples(rows[first : first + chunk])
        made.cut()
    made.finish()
    return path
