"""A data folder in which a run has been flown, made without a server: record, plan, flight, audit, alarms."""

from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fullpose.rig import Rig, builtin_rigs
from fullpose_server.formats.plan_folder import rig_hash, sealed_plan, write_plan
from fullpose_server.formats.rig_toml import rig_toml
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.trajectory_file import read_trajectory
from fullpose_server.runtime.contract.telemetry import SAMPLE, Flag, Samples
from fullpose_server.runtime.recording.mcap_writer import RunRecord
from fullpose_server.session.alarms import Alarm, Severity
from fullpose_server.session.states import STATES
from fullpose_server.store.alarms import AlarmHistory, RaisedAlarm
from fullpose_server.store.audit import AuditLog
from fullpose_server.store.audit_entry import AuditEntry
from fullpose_server.store.database import Database
from fullpose_server.store.plans import PlanAsked, PlanStore
from fullpose_server.store.trajectories import TrajectoryStore
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.stores import Stores

RUN = "20270115T080000-bench-000001"
WALL_NS = 1_800_000_000_000_000_000
RATE_HZ = 200.0
FLIGHT = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 20},{k % 7},{k % 5},{-k % 3}\n" for k in range(21))


@dataclass(frozen=True)
class Flown:
    """Where it is; who opens the database again closes it."""

    folder: Path
    rig: Rig
    plan: str

    @property
    def record(self) -> Path:
        return self.folder / "runs" / f"{RUN}.mcap"


BENCH = replace(builtin_rigs()["vertical-limited"], name="bench")


def flown(folder: Path, seconds: float = 1.0, rig: Rig = BENCH) -> Flown:
    """A run of a rig, by default one whose file is in the folder; flown to its end with one alarm."""
    (folder / "rigs").mkdir(parents=True)
    (folder / "runs").mkdir()
    if rig is BENCH:
        (folder / "rigs" / "bench.toml").write_text(rig_toml(rig))
    database = Database(folder / "fullpose.db")
    try:
        stores = Stores(
            database,
            TrajectoryStore(database, folder / "trajectories"),
            PlanStore(database, folder / "plans"),
            folder,
        )
        source = folder / "upload"
        source.write_text(FLIGHT)
        sha256 = stores.keep(read_trajectory(source, Convention.NUE), source, "a flight")[0].sha256
        row = stores.plans.add(
            PlanAsked(
                trajectory=sha256,
                rig=rig.name,
                rig_hash=rig_hash(rig),
                method="plan",
                options={},
                start_deg=None,
                rate_hz=RATE_HZ,
            )
        )
        made = plan_of(rig, seconds, RATE_HZ, swing=0.2, plan_id=row.id)
        plan = sealed_plan(replace(made, info=replace(made.info, trajectory_sha256=sha256)))
        write_plan(stores.plans.folder(row.id), plan)
        rows = samples(plan.angles)
        bound = {"plan_id": row.id, "plan_hash": plan.info.plan_hash, "rig": rig.name, "rig_hash": rig_hash(rig)}
        write_record(folder / "runs" / f"{RUN}.mcap", rows, bound | {"live": False}, rig=rig.name)
        AuditLog(database).write([_command(word, at, rig.name) for word, at in COMMANDS])
        AuditLog(database).write([AuditEntry(WALL_NS / 1e9, "eve", "", "login", {}, None, ("", ""), True, None)])
        alarm = Alarm(1, "late", Severity.WARNING, "a tick was late", WALL_NS / 1e9 + 1.25, unit="us", value=900.0)
        AlarmHistory(database).write([RaisedAlarm(rig.name, "life", alarm)])
    finally:
        database.close()
    return Flown(folder, rig, row.id)


COMMANDS = (("load", -9.0), ("arm", -5.0), ("start", -0.1), ("disarm", 4.0), ("load", 9.0))


def _command(word: str, at: float, rig: str) -> AuditEntry:
    args = {"plan": "p"} if word == "load" else {}
    states = ("idle", "ready")
    return AuditEntry(WALL_NS / 1e9 + at, "ann", rig, word, args, (1, 2), states, True, None, "10.0.0.7")


def samples(angles: Any) -> Samples:
    """What a rig that follows these angles (n, 4) [rad] without error tells."""
    n = len(angles)
    rows = np.zeros(n, SAMPLE)
    rows["seq"] = np.arange(1, n + 1)
    rows["tick"] = np.arange(n)
    rows["time_ns"] = 10**9 + (np.arange(n) * 1e9 / RATE_HZ).astype(np.int64)
    rows["wall_ns"] = WALL_NS + rows["time_ns"] - 10**9
    rows["state"] = STATES.index("running")
    rows["flags"] = Flag.ENABLED
    degrees = np.rad2deg(angles)
    rows["demand"] = rows["measured"] = degrees
    rows["demand_rate"][1:] = rows["measured_rate"][1:] = np.diff(degrees, axis=0) * RATE_HZ
    rows["demand_acceleration"][1:] = np.diff(rows["demand_rate"], axis=0) * RATE_HZ
    rows["solve_error_deg"] = 1e-12
    rows["tracking_error_deg"] = 1e-3 * (1.0 + np.sin(np.arange(n) / 20.0))
    return rows


def write_record(path: Path, rows: Samples, bound: dict[str, Any], how: str = "completed", rig: str = "bench") -> None:
    """The record of a run, whole."""
    made = RunRecord(path, {"run_id": path.stem, "rig": rig, "who": "ann", "plan": bound}, WALL_NS, 10**9)
    begun, last = int(rows["time_ns"][0]), int(rows["time_ns"][-1])
    made.add_event({"kind": "run_begin", "time_ns": begun, "wall_ns": WALL_NS, "head": 0})
    made.add_samples(rows)
    made.add_event({"kind": "run_end", "time_ns": last, "wall_ns": WALL_NS, "head": len(rows), "how": how})
    made.finish()


def alarms(count: int, message: str) -> list[RaisedAlarm]:
    """So many of the bench, while it flew."""
    one = Alarm(0, "guard_rate", Severity.FAULT, message, WALL_NS / 1e9 + 0.5, "inner", 201.5, 200.0, "deg/s")
    return [RaisedAlarm("bench", "more", Alarm(**{**asdict(one), "number": number})) for number in range(count)]
