"""What the rig process shows: one telemetry row a tick, counters, and the session's snapshot when it changes."""

import math

import numpy as np

from fullpose_server.drives.base import Status
from fullpose_server.runtime.contract import messages, telemetry
from fullpose_server.runtime.contract.shared_memory import BUCKETS
from fullpose_server.runtime.loop.context import Parts
from fullpose_server.runtime.motion.generator import Mode

_DRIVE_BRAKES = int(Status.BRAKING)
# As plain numbers: flags make an object of every "or".
_LATE, _LIMITED, _LEAD, _ENABLED, _BRAKING, _STALE = (int(flag) for flag in telemetry.Flag)
_DEG = 180.0 / math.pi
_REFRESH_S = 0.25  # at least this often, so that the lease's age is fresh


class Publisher:
    """Shows one rig."""

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        self._row = np.zeros(1, telemetry.SAMPLE)
        self._published = -1
        self._published_at = 0.0

    def count(self, lateness_ns: int, missed: int) -> None:
        """Count one tick, and the deadlines that were missed before it."""
        header = self._parts.shared.header
        header["ticks"] += 1
        if missed:
            header["misses"] += missed
        self._parts.shared.histogram[min(lateness_ns // 1000, BUCKETS - 1)] += 1
        if lateness_ns > int(header["max_lateness_ns"][0]):
            header["max_lateness_ns"] = lateness_ns

    def busy(self, work_ns: int) -> None:
        """How long one tick's work took [ns], smoothed."""
        header = self._parts.shared.header
        header["busy_ns"] = (int(header["busy_ns"][0]) * 63 + work_ns) // 64

    def refresh(self, now: float) -> None:
        """Publish where something changed, or enough time has passed."""
        if self._parts.machine.revision != self._published or now - self._published_at > _REFRESH_S:
            self.publish()

    def publish(self) -> None:
        """Publish the session's snapshot."""
        p = self._parts
        now_ns = p.clock.monotonic_ns()
        machine, bound = p.machine, p.machine.binding
        ref = None
        if bound is not None:
            info = p.state.plan
            name, duration = ("", None) if info is None else (info.name, info.duration_s)
            ref = messages.PlanRef(bound.plan_id, bound.plan_hash, bound.rig_hash, bound.live, name, duration)
        lease = machine.lease(now_ns / 1e9)
        hold_s = p.config.owner.hold_s
        published = messages.Published(
            rig=p.config.name,
            life=p.life,
            state=machine.state,
            revision=machine.revision,
            allowed=[str(c) for c in machine.allowed()],
            lease=lease,
            lease_heard_ns=now_ns - int(1e9 * (hold_s - (lease.expires_s or 0.0))),
            lease_silent_s=hold_s,
            plan=ref,
            alarms=list(machine.alarms.standing),
            history=list(machine.alarms.history[-64:]),
            shelves=[s for s in machine.alarms.shelves if s.lasts(p.clock.steady_ns() / 1e9)],
            realtime=p.realtime,
            run_id=p.state.run_id,
            drive=p.drive.name,
            live=p.live.health(),
        )
        p.shared.publish(messages.encode(published), machine.revision)
        self._published = machine.revision
        self._published_at = now_ns / 1e9

    def record(self, now_ns: int, lateness_ns: int, missed: int) -> float:
        """Add the tick's row to the ring. Returns the solve error [deg]."""
        p, state, row = self._parts, self._parts.state, self._row
        motion, machine = p.motion, p.machine
        row["time_ns"] = now_ns
        row["wall_ns"] = p.clock.wall_ns()
        row["state"] = machine.state.code
        flags = _LATE if missed else 0
        flags |= _ENABLED if state.commanded else 0
        if motion.mode is Mode.BRAKE or state.drive_brakes or state.status & _DRIVE_BRAKES:
            flags |= _BRAKING
        if motion.mode is Mode.PATH and math.isnan(motion.q[0]):
            flags |= _LEAD
        if motion.stale:
            flags |= _STALE
        if motion.limited:
            flags |= _LIMITED
        row["flags"] = flags
        row["revision"] = machine.revision
        row["path_time_s"] = motion.path_time_s
        row["path_scale"] = motion.path_scale
        np.multiply(motion.x, _DEG, out=row["demand"][0])
        np.multiply(motion.v, _DEG, out=row["demand_rate"][0])
        np.multiply(motion.a, _DEG, out=row["demand_acceleration"][0])
        np.multiply(state.measured, _DEG, out=row["measured"][0])
        np.multiply(state.measured_rate, _DEG, out=row["measured_rate"][0])
        row["target"] = motion.q
        solved: float = motion.solve_error(p.config.rig.axes) * _DEG
        row["solve_error_deg"] = solved
        row["tracking_error_deg"] = state.tracking_error * _DEG
        if state.enabled:
            np.multiply(p.guard.following, _DEG, out=row["following_error_deg"][0])
        else:
            row["following_error_deg"] = 0.0
        row["margin"] = p.guard.margin
        row["lateness_us"] = lateness_ns / 1e3
        row["tick"] = state.ticks
        row["read_us"] = p.drive.read_ns / 1e3
        row["write_us"] = math.nan if p.drive.write_ns is None else p.drive.write_ns / 1e3
        p.shared.ring.append(row)
        return solved
