"""What a record says, in a few words: made of the whole of it once, or of its name and beginning."""

import contextlib
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fullpose_server.formats.output_file import write_text
from fullpose_server.runtime.contract.telemetry import Flag, Samples
from fullpose_server.runtime.recording.mcap_reader import RecordError, run_of
from fullpose_server.runtime.recording.record_chunks import chunks
from fullpose_server.runtime.recording.record_names import began_at, rig_of
from fullpose_server.session.states import State


@dataclass(frozen=True)
class RunSummary:
    """What a record says, errors over the flight itself: running or held, leads left out."""

    id: str
    rig: str
    end: str | None  # how it ended, a `RunEnd`; None: not known, or no run, or not ended
    end_code: str | None  # of the alarm that ended it
    incident: str | None  # code of the alarm that had it kept while no run was recorded; None: a run
    error: str | None  # why it cannot be read; then nothing but its name is known
    plan_id: str | None
    plan_hash: str | None
    who: str
    started: float | None  # seconds since 1970, of the first sample
    ended: float | None
    samples: int | None  # None, as all that follows from them, while they are being written
    lost_samples: int | None  # sequence numbers that are missing, from the run's beginning to its end
    bytes: int
    complete: bool  # False while it is written, where the recorder was cut off, or a part is damaged
    max_solve_error_deg: float | None
    max_tracking_error_deg: float | None
    max_lateness_us: float | None


def kept_summary(path: Path) -> RunSummary | None:
    """The summary beside the record; None where there is none of it as it is, or one of another version."""
    try:
        summary = RunSummary(**json.loads(path.with_suffix(".json").read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None
    return summary if summary.bytes == path.stat().st_size else None


def keep_summary(path: Path, summary: RunSummary) -> None:
    """Put the summary beside the record."""
    with contextlib.suppress(OSError):  # a full disk, say: the summary is as true, and made again next time
        write_text(path.with_suffix(".json"), json.dumps(asdict(summary)))


def named(path: Path) -> RunSummary:
    """What the file's name says."""
    return RunSummary(
        id=path.stem,
        rig=rig_of(path.stem),
        end=None,
        end_code=None,
        incident=None,
        error=None,
        plan_id=None,
        plan_hash=None,
        who="",
        started=began_at(path.stem),
        ended=None,
        samples=None,
        lost_samples=None,
        bytes=path.stat().st_size,
        complete=False,
        max_solve_error_deg=None,
        max_tracking_error_deg=None,
        max_lateness_us=None,
    )


def unreadable(path: Path, error: Exception) -> RunSummary:
    match error:
        case RecordError():
            why = error.why
        case OSError(strerror=str(told)):
            why = told
        case _:
            why = str(error)
    return replace(named(path), error=why)


def brief(path: Path) -> RunSummary:
    """What the record's beginning says. Raises `RecordError`."""
    run = run_of(path)
    plan = _object(run.get("plan"))
    told = named(path)
    return replace(
        told,
        rig=str(run.get("rig") or plan.get("rig") or told.rig),
        incident=run.get("incident"),
        plan_id=plan.get("plan_id"),
        plan_hash=plan.get("plan_hash"),
        who=run.get("who", ""),
    )


def summarise(path: Path) -> RunSummary:
    """What all of the record says, but for whether it is complete; never all of it in memory. Raises `RecordError`."""
    tally = Tally()
    events: list[dict[str, Any]] = []
    for chunk in chunks(path):
        tally.add(chunk.rows)
        events += chunk.events
    return tally.summary(path, events)


def summary_of(path: Path, rows: Samples, events: list[dict[str, Any]]) -> RunSummary:
    """Of a record that has been read. Raises `RecordError`."""
    tally = Tally()
    tally.add(rows)
    return tally.summary(path, events)


class Tally:
    """What a summary needs of the rows, as they come."""

    def __init__(self) -> None:
        self._largest: dict[str, float] = {}
        self._sequence: tuple[int, int] | None = None  # of the first and the last row
        self._wall_ns = (0, 0)
        self._rows = 0

    def add(self, rows: Samples) -> None:
        """Take rows (n,)."""
        if not rows.size:
            return
        flying = np.isin(rows["state"], (State.RUNNING.code, State.HELD.code)) & (rows["flags"] & Flag.LEAD == 0)
        self._take("solve_error_deg", rows["solve_error_deg"][flying])
        self._take("tracking_error_deg", rows["tracking_error_deg"][flying])
        self._take("lateness_us", rows["lateness_us"])
        first = self._sequence[0] if self._sequence else int(rows["seq"][0])
        begun = self._wall_ns[0] if self._sequence else int(rows["wall_ns"][0])
        self._sequence, self._wall_ns = (first, int(rows["seq"][-1])), (begun, int(rows["wall_ns"][-1]))
        self._rows += rows.size

    def summary(self, path: Path, events: list[dict[str, Any]]) -> RunSummary:
        """The summary of the record that the rows and events are of. Raises `RecordError`."""
        begun = brief(path)
        ends = [event for event in events if event.get("kind") == "run_end"]
        ending: dict[str, Any] = ends[-1] if ends else {}
        return replace(
            begun,
            end=_word(ending.get("how")),
            end_code=_word(ending.get("code")),
            started=self._wall_ns[0] / 1e9 if self._rows else begun.started,
            ended=self._wall_ns[1] / 1e9 if self._rows else None,
            samples=self._rows,
            lost_samples=self._lost(events),
            max_solve_error_deg=self._largest.get("solve_error_deg"),
            max_tracking_error_deg=self._largest.get("tracking_error_deg"),
            max_lateness_us=self._largest.get("lateness_us"),
        )

    def _take(self, name: str, values: np.ndarray[Any, Any]) -> None:
        seen = values[np.isfinite(values)]
        if seen.size:
            self._largest[name] = max(self._largest.get(name, -np.inf), float(seen.max()))

    def _lost(self, events: list[dict[str, Any]]) -> int:
        """How many samples are missing: between the rows, and to the run's beginning and end where it tells them."""
        heads = {event.get("kind"): head for event in events if isinstance(head := event.get("head"), int)}
        first = [self._sequence[0]] if self._sequence else []
        last = [self._sequence[1]] if self._sequence else []
        if "run_begin" in heads:
            first.append(heads["run_begin"] + 1)
        if "run_end" in heads:
            last.append(heads["run_end"])
        return max(last) - min(first) + 1 - self._rows if first and last else 0


def _word(value: Any) -> str | None:
    return value if isinstance(value, str) else None


def _object(text: str | None) -> dict[str, Any]:
    try:
        found = json.loads(text or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
