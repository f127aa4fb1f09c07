"""A rig's snapshot on the wire."""

import math
from dataclasses import asdict
from typing import Any

from fullpose_server.api.schemas.base import Four
from fullpose_server.api.schemas.lease import LeaseOut
from fullpose_server.api.schemas.session import (
    AlarmOut,
    DriveTimes,
    LiveOut,
    PlanRef,
    RecorderOut,
    RigHealth,
    SessionOut,
    ShelfOut,
)
from fullpose_server.runtime.contract.messages import Health, Snapshot
from fullpose_server.runtime.recording.playback import RunPlayback
from fullpose_server.runtime.supervisor.registry import RigHosts
from fullpose_server.session.alarms import Alarm
from fullpose_server.session.lease import Lease
from fullpose_server.session.states import STATES, State


def session_out(hosts: RigHosts, rig: str, rate_hz: float) -> SessionOut:
    """The session of a rig as of now; of a rig without a process: disconnected, and what can be done about it."""
    host = hosts.get(rig)
    if host is None:
        return _without_process(rig, rate_hz)
    return from_snapshot(host.snapshot())


def from_snapshot(snapshot: Snapshot) -> SessionOut:
    """The wire's words for a snapshot."""
    a, b, c, d = (round(v, 9) if math.isfinite(v) else 0.0 for v in snapshot.pose_deg)
    pose: Four | None = (a, b, c, d) if all(map(math.isfinite, snapshot.pose_deg)) else None
    return SessionOut.model_validate(
        {
            "rig": snapshot.rig,
            "state": snapshot.state,
            "revision": snapshot.revision,
            "allowed": list(snapshot.allowed),
            "lease": lease_out(snapshot.lease),
            "plan": None if snapshot.plan is None else PlanRef(**asdict(snapshot.plan)),
            "alarms": [_alarm(alarm) for alarm in snapshot.alarms],
            "history": [_alarm(alarm) for alarm in snapshot.history],
            "shelves": [ShelfOut.model_validate(asdict(shelf)) for shelf in snapshot.shelves],
            "run_id": snapshot.run_id,
            "drive": snapshot.drive,
            "health": health_out(snapshot.health),
            "pose_deg": pose,
        }
    )


def lease_out(lease: Lease) -> LeaseOut:
    """The wire's words for a lease."""
    return LeaseOut(
        holder=lease.holder,
        epoch=lease.epoch,
        sequence=lease.sequence,
        expires_s=lease.expires_s,
        requested_by=list(lease.requested_by),
    )


def health_out(health: Health) -> RigHealth:
    """The wire's words for a rig's health."""
    recorder = asdict(health.recorder)
    return RigHealth(
        realtime=health.realtime,
        rate_hz=health.rate_hz,
        lateness_us={key: value for key, value in health.lateness_us.items() if math.isfinite(value)},
        busy_us=health.busy_us,
        ticks=health.ticks,
        deadline_misses=health.deadline_misses,
        rig_alive=health.rig_alive,
        rig_pid=health.rig_pid,
        heartbeat_age_s=health.heartbeat_age_s,
        recorder=RecorderOut(**{key: recorder[key] for key in RecorderOut.model_fields}),
        drive=DriveTimes(**asdict(health.drive)),
        live=None if health.live is None else LiveOut(**asdict(health.live)),
    )


def _alarm(alarm: Alarm) -> AlarmOut:
    values = asdict(alarm)
    for key in ("value", "limit"):
        if values[key] is not None and not math.isfinite(values[key]):
            values[key] = None  # the message holds the word for it
    return AlarmOut.model_validate(values)


def replayed_session(rig: str, playback: RunPlayback, row: Any) -> SessionOut:
    """The session as a record has it at the telemetry row; nothing is allowed in it."""
    session = _without_process(rig, playback.rate_hz, f"replay of {playback.run}")
    if row is None:
        return session.model_copy(update={"allowed": []})
    plan = playback.plan
    alarms = [_recorded_alarm(event) for event in playback.alarms()]
    a, b, c, d = row["measured"].tolist()
    return session.model_copy(
        update={
            "state": STATES[row["state"]],
            "revision": int(row["revision"]),
            "allowed": [],
            "lease": session.lease.model_copy(update={"holder": playback.who or None}),
            "plan": PlanRef(
                plan_id=plan["plan_id"],
                plan_hash=plan["plan_hash"],
                rig_hash=plan["rig_hash"],
                live=plan["live"],
                name="",
                duration_s=None,
            )
            if plan
            else None,
            "alarms": alarms,
            "history": alarms,
            "run_id": playback.run,
            "pose_deg": (a, b, c, d) if all(map(math.isfinite, (a, b, c, d))) else None,
        }
    )


def _recorded_alarm(event: dict[str, Any]) -> AlarmOut:
    return AlarmOut.model_validate({name: event.get(name) for name in AlarmOut.model_fields if name in event})


def _without_process(rig: str, rate_hz: float, why: str = "no rig process: connect starts one") -> SessionOut:
    health = RigHealth(
        realtime=why,
        rate_hz=rate_hz,
        lateness_us={},
        busy_us=0.0,
        ticks=0,
        deadline_misses=0,
        rig_alive=False,
        rig_pid=None,
        heartbeat_age_s=None,
        recorder=None,
    )
    return SessionOut(
        rig=rig,
        state=State.DISCONNECTED,
        revision=0,
        allowed=["connect"],
        lease=LeaseOut(holder=None, epoch=0, sequence=0, expires_s=None, requested_by=[]),
        plan=None,
        alarms=[],
        history=[],
        run_id=None,
        drive=None,
        health=health,
        pose_deg=None,
    )
