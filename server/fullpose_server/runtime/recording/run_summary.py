"""What a record says, in a few words: made of the whole of it once, or of its name and beginning."""

import contextlib
import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fullpose_server.formats.output_file import write_text
from fullpose_server.runtime.contract.telemetry import Flag, Samples
from fullpose_server.runtime.recording.mcap_reader import RecordError, read_record, run_of
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
    """What the whole record says, but for whether it is complete. Raises `RecordError`."""
    return summary_of(path, *read_record(path))


def summary_of(path: Path, rows: Samples, events: list[dict[str, Any]]) -> RunSummary:
    """Of a record that has been read. Raises `RecordError`."""
    begun = brief(path)
    flying = np.isin(rows["state"], (State.RUNNING.code, State.HELD.code)) & (rows["flags"] & Flag.LEAD == 0)
    ends = [event for event in events if event.get("kind") == "run_end"]
    ending: dict[str, Any] = ends[-1] if ends else {}
    return replace(
        begun,
        end=_word(ending.get("how")),
        end_code=_word(ending.get("code")),
        started=float(rows["wall_ns"][0]) / 1e9 if rows.size else begun.started,
        ended=float(rows["wall_ns"][-1]) / 1e9 if rows.size else None,
        samples=int(rows.size),
        lost_samples=_lost(rows, events),
        max_solve_error_deg=_largest(rows["solve_error_deg"][flying]),
        max_tracking_error_deg=_largest(rows["tracking_error_deg"][flying]),
        max_lateness_us=_largest(rows["lateness_us"]),
    )


def _lost(rows: Samples, events: list[dict[str, Any]]) -> int:
    """How many of the run's samples are missing: between the rows, and to its beginning and end where it tells them."""
    heads = {event.get("kind"): head for event in events if isinstance(head := event.get("head"), int)}
    first = [int(rows["seq"][0])] if rows.size else []
    last = [int(rows["seq"][-1])] if rows.size else []
    if "run_begin" in heads:
        first.append(heads["run_begin"] + 1)
    if "run_end" in heads:
        last.append(heads["run_end"])
    return max(last) - min(first) + 1 - rows.size if first and last else 0


def _largest(values: np.ndarray[Any, Any]) -> float | None:
    seen = values[np.isfinite(values)]
    return float(seen.max()) if seen.size else None


def _word(value: Any) -> str | None:
    return value if isinstance(value, str) else None


def _object(text: str | None) -> dict[str, Any]:
    try:
        found = json.loads(text or "{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
