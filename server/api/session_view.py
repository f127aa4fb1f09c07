"""A rig's snapshot on the wire."""

import math
from dataclasses import asdict

from server.api.hosts import RigHosts
from server.api.wire import Four
from server.api.wire_session import AlarmOut, LeaseOut, PlanRef, RecorderOut, RigHealth, SessionOut
from server.runtime.wire import Health, Snapshot
from server.session.alarms import Alarm
from server.session.lease import Lease


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
    )


def _alarm(alarm: Alarm) -> AlarmOut:
    values = asdict(alarm)
    for key in ("value", "limit"):
        if values[key] is not None and not math.isfinite(values[key]):
            values[key] = None  # the message holds the word for it
    return AlarmOut.model_validate(values)


def _without_process(rig: str, rate_hz: float) -> SessionOut:
    health = RigHealth(
        realtime="no rig process: connect starts one",
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
        state="disconnected",
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
