"""Where the parts of a run's evidence are: read from a data folder, also while its server serves, and changed nowhere.

What is not there any more, or is not what was flown, is left out, and it is said why: the rest is evidence still.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from fullpose.rig import Rig
from fullpose_server.errors import FileError, NotFoundError
from fullpose_server.evidence.errors import NoEvidenceError
from fullpose_server.formats.plan_folder import PlanFolderError, PlanInfo, read_sealed_plan, rig_hash
from fullpose_server.formats.rig_file import RigStore
from fullpose_server.formats.rig_toml import rig_toml
from fullpose_server.location import DATABASE, Location
from fullpose_server.runtime.contract.telemetry import Samples
from fullpose_server.runtime.recording.mcap_reader import RecordError, is_complete, read_record, run_of
from fullpose_server.runtime.recording.record_names import RECORD, is_run
from fullpose_server.runtime.recording.run_index import is_being_written
from fullpose_server.runtime.recording.run_summary import RunSummary, summary_of
from fullpose_server.session.states import Command
from fullpose_server.store.audit import newest_hash, read_rows
from fullpose_server.store.reading import reading
from fullpose_server.store.tables import AlarmRow, AuditRow, PlanRow, TrajectoryRow

AFTER_S = 5.0  # what is done so soon after a run's end belongs to it, but for what begins another
ALARM_AFTER_S = 0.5  # likewise an alarm
BEFORE_S = 60.0  # and what comes before, where no load tells when it began
_BEGINS = frozenset({Command.LOAD.value, Command.ARM.value, Command.START.value, Command.GO_LIVE.value})
PLAN_FILES = ("plan.json", "angles.npy", "target.npy", "error.npy")


@dataclass
class Sources:
    """The parts. `missing` says of each that is not here why it is not."""

    run: RunSummary
    record: Path
    rows: Samples
    bound: dict[str, Any]  # what `load` bound, as the record has it
    rig: Rig | None = None
    rig_text: str | None = None
    plan: PlanInfo | None = None
    plan_folder: Path | None = None
    method: dict[str, Any] = field(default_factory=dict)  # how the plan was made
    flight: dict[str, Any] | None = None  # its row
    flight_folder: Path | None = None
    alarms: list[dict[str, Any]] = field(default_factory=list)
    audit: list[dict[str, Any]] = field(default_factory=list)
    newest_hash: str = ""
    missing: dict[str, str] = field(default_factory=dict)


def sources_of(folder: Path, run: str, database: Location | None = None) -> Sources:
    """The parts of a run's evidence in the data folder, whose rows are in `database` (its own file).

    Raises `NotFoundError`, `NoEvidenceError` while it is being written, `FileError` where the record is none, and as
    `store.reading.reading`.
    """
    found = _recorded(folder, run)
    _take_rig(found, folder)
    with reading(database or folder / DATABASE) as session:
        _take_plan(found, folder, session)
        _take_flight(found, folder, session)
        _take_history(found, session)
    return found


def _recorded(folder: Path, run: str) -> Sources:
    path = folder / "runs" / f"{run}{RECORD}"
    if not is_run(run) or not path.is_file():
        raise NotFoundError("run", run)
    if is_being_written(path):
        raise NoEvidenceError(f"run {run} is being written: there is evidence of it when it has ended")
    try:
        rows, events = read_record(path)
        summary = replace(summary_of(path, rows, events), complete=is_complete(path))
        bound = json.loads(run_of(path).get("plan") or "{}")
    except RecordError as error:
        raise FileError(path.name, f"a record ({error.why})") from None
    except ValueError:
        raise FileError(path.name, "a record, its plan is damaged") from None
    return Sources(summary, path, rows, bound if isinstance(bound, dict) else {})


def _take_rig(found: Sources, folder: Path) -> None:
    flown = found.bound.get("rig_hash")
    try:
        entry = _rig(folder, found.run.rig)
    except (NotFoundError, FileError) as error:
        found.missing["rig"] = str(error)
        return
    if flown is not None and rig_hash(entry[0]) != flown:
        found.missing["rig"] = f"rig {found.run.rig} has been changed since: it is not the one that was flown"
        return
    if flown is None:
        found.missing["rig"] = "nothing was loaded: which rig file counted is not in the record"
        return
    found.rig, found.rig_text = entry


def _rig(folder: Path, name: str) -> tuple[Rig, str]:
    rigs = folder / "rigs"
    if not rigs.is_dir():
        raise NotFoundError("rig", name)
    entry = RigStore(rigs).get(name)
    text = rig_toml(entry.rig) if entry.builtin else (rigs / f"{name}.toml").read_text("utf-8")
    return entry.rig, text


def _take_plan(found: Sources, folder: Path, session: Session) -> None:
    if found.bound.get("live"):
        found.missing["plan"] = found.missing["flight"] = "a live source was followed: there was no plan"
        return
    if found.run.plan_id is None:
        found.missing["plan"] = found.missing["flight"] = "nothing was loaded"
        return
    plans = folder / "plans" / found.run.plan_id
    if not is_run(found.run.plan_id) or not plans.is_dir():
        found.missing["plan"] = f"plan {found.run.plan_id} has been removed"
    else:
        try:
            info = read_sealed_plan(plans).info
        except PlanFolderError as error:
            found.missing["plan"] = f"plan {found.run.plan_id}: {error.path.name}: {error.problem}"
        else:
            if info.plan_hash != found.run.plan_hash:
                found.missing["plan"] = f"plan {found.run.plan_id} is not the one that was flown: its hash is another"
            else:
                found.plan, found.plan_folder = info, plans
    row = session.get(PlanRow, found.run.plan_id)
    if row is not None:
        found.method = {
            "method": row.method,
            "options": row.options,
            "start_deg": row.start_deg,
            "tolerance_deg": row.tolerance_deg,
            "remedy": row.remedy,
        }


def _take_flight(found: Sources, folder: Path, session: Session) -> None:
    if "flight" in found.missing:
        return
    if found.plan is None:
        found.missing["flight"] = "which flight it was is said by the plan, which is not here"
        return
    sha256 = found.plan.trajectory_sha256
    row, flights = session.get(TrajectoryRow, sha256), folder / "trajectories" / sha256
    if row is None or not is_run(sha256) or not flights.is_dir():
        found.missing["flight"] = f"flight {sha256} has been removed"
        return
    found.flight = {column.name: getattr(row, column.name) for column in TrajectoryRow.__table__.columns}
    found.flight_folder = flights


def _take_history(found: Sources, session: Session) -> None:
    """The alarms of the run, and the audit from the load that it flew until its end."""
    run = found.run
    found.newest_hash = newest_hash(session)
    if run.started is None or run.ended is None:
        found.missing["alarms"] = found.missing["audit"] = "the record has no sample: when it was is not known"
        return
    query = select(AlarmRow).where(
        AlarmRow.rig == run.rig,
        AlarmRow.time_s <= run.ended + ALARM_AFTER_S,
        func.coalesce(AlarmRow.last_time_s, AlarmRow.time_s) >= run.started,
    )
    for alarm in session.scalars(query.order_by(AlarmRow.time_s, AlarmRow.id)):
        found.alarms.append({column.name: getattr(alarm, column.name) for column in AlarmRow.__table__.columns})
    found.audit = list(_audit(session, run.rig, run.started, run.ended))


def _audit(session: Session, rig: str, started: float, ended: float) -> Iterator[dict[str, Any]]:
    loads = AuditRow.rig == rig, AuditRow.command == Command.LOAD.value, AuditRow.accepted, AuditRow.at <= started
    loaded = session.scalar(select(func.max(AuditRow.at)).where(*loads))
    since = started - BEFORE_S if loaded is None else loaded
    for row in read_rows(session, rig=rig, since=since, until=ended + AFTER_S):
        if row["at"] > ended and row["command"] in _BEGINS:
            return
        yield row
