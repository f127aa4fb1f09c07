"""Flights and rig hosts for the tests of the rig process. Imported as `tests.fullpose_server.runtime.rigs`."""

import asyncio
import contextlib
from collections.abc import AsyncIterator, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from fullpose.attitude import quaternion_from_dcm
from fullpose.kinematics import payload_attitudes
from fullpose.rig import Rig, builtin_rigs
from fullpose_server.formats.plan_folder import PlanFolder, PlanOrigin, PlanPath, make_plan, write_plan
from fullpose_server.operating import GuardConfig, Tolerance
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.messages import Reply, Snapshot
from fullpose_server.runtime.contract.telemetry import Flag
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.secret import proof_of
from fullpose_server.session.alarms import Alarm, Severity
from fullpose_server.session.lease import LeaseAction, LeaseToken
from fullpose_server.session.states import IN_MOTION
from tests.support.waiting import answered, soon


def plan_of(
    rig: Rig, seconds: float = 4.0, rate_hz: float = 1000.0, swing: float = 1.0, plan_id: str = "test"
) -> PlanFolder:
    """An exactly solved flight: the angles swing smoothly, and the flight's attitude is what they give.

    A second of lead-in and lead-out; inside the built-in rigs' limits at `swing` 1.
    """
    ramp = round(rate_hz)
    n = round(seconds * rate_hz) + 1
    u = (np.arange(ramp) + 1.0) / (ramp + 1.0)
    smooth = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
    speed = np.concatenate([[0.0], smooth, np.ones(n), smooth[::-1], [0.0]])
    t = np.cumsum(speed) / rate_hz
    amplitude = swing * np.radians([40.0, 50.0, 35.0, 45.0])
    hertz = np.array([0.2, 0.17, 0.25, 0.3])
    angles = rig.home + amplitude * np.sin(2.0 * np.pi * hertz * t[:, None])
    if not rig.geometry.redundant:
        angles[:, 0] = 0.0
    F = np.empty((len(angles), 3, 3))
    payload_attitudes(rig.axes, angles, F)
    path = PlanPath(angles, quaternion_from_dcm(F), np.zeros(len(angles)), ramp + 1, ramp + 1)
    return make_plan(PlanOrigin(plan_id, "0" * 64, "test"), rig, rate_hz, path, feasible=True)


PATIENT_WATCHDOG_S = 5.0  # for so long a starved machine may keep the rig process from writing
LIVE_KEY = "the key of the live source"


class Operator:
    """Drives a host as a client does: takes the lease, counts the sequence."""

    def __init__(self, host: RigHost, who: str = "operator") -> None:
        self.host = host
        self.who = who
        self.epoch = 0
        self.sequence = 0
        self.proof = proof_of(f"the secret of {who}")

    async def take(self, action: str = "take") -> None:
        lease = await self.host.lease(LeaseAction(action), self.who, self.proof)
        self.epoch, self.sequence = lease.epoch, lease.sequence

    async def renew(self) -> None:
        await self.host.lease(LeaseAction.RENEW, self.who, self.proof)

    async def say(self, command: str, **args: Any) -> Reply:
        self.sequence += 1
        token = LeaseToken(self.epoch, self.sequence, self.proof)
        return await self.host.command(command, args, self.who, token, LIVE_KEY)

    async def must(self, command: str, **args: Any) -> Reply:
        reply = await self.say(command, **args)
        assert reply.ok, reply
        return reply

    async def arm(self, plan: Path) -> None:
        """From disconnected to armed with `plan`."""
        await self.take()
        await self.must("connect")
        await self.must("load", plan_folder=str(plan))
        await self.must("arm")

    async def fly(self, plan: Path) -> None:
        """From disconnected to running, with `plan`."""
        await self.arm(plan)
        await self.must("start")
        await self.until("running")

    async def arm_live(self, **settings: Any) -> None:
        """From disconnected to armed with a live source."""
        await self.take()
        await self.must("connect")
        await self.must("load", live=settings)
        await self.must("arm")

    async def until(self, *states: str, seconds: float = 30.0) -> Snapshot:
        """Wait for one of `states`, keeping the lease alive."""
        deadline = asyncio.get_running_loop().time() + seconds
        while True:
            snapshot = self.host.snapshot()
            if snapshot.state in states:
                return snapshot
            assert asyncio.get_running_loop().time() < deadline, f"still {snapshot.state}: {snapshot.alarms}"
            if self.epoch and snapshot.lease.holder == self.who:
                await self.renew()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self.host.wait_change(snapshot.revision), 0.2)

    async def at_rest(self, command: str) -> Reply:
        """What `command` is answered once the rig is at rest."""

        async def ask() -> Reply | None:
            reply = await self.say(command)
            return None if reply.error is not None and reply.error.code == "not_at_rest" else reply

        return await answered(ask)

    async def recover(self) -> None:
        """Acknowledge and reset, once at rest."""
        await self.must("acknowledge")
        reply = await self.at_rest("reset")
        assert reply.ok, reply


class Flown(Protocol):
    """What flew: a rig process, or a rig on a made-up clock."""

    @property
    def rig(self) -> Rig: ...

    @property
    def rate_hz(self) -> float: ...


def within_limits(rows: np.ndarray, host: Flown) -> None:
    """Every command of the run, differenced anew from the positions, obeys rate and acceleration."""
    enabled = (rows["flags"] & Flag.ENABLED) != 0
    tick = np.diff(rows["tick"]) == 1
    both = enabled[1:] & enabled[:-1] & tick
    v = np.diff(rows["demand"], axis=0) * host.rate_hz
    assert (np.abs(v[both]) <= np.degrees(host.rig.max_rate) * (1 + 1e-6)).all()
    a = np.diff(v, axis=0) * host.rate_hz
    three = both[1:] & both[:-1]
    assert (np.abs(a[three]) <= np.degrees(host.rig.max_acceleration) * (1 + 1e-6) + 1e-4).all()


async def ticked(host: RigHost, seconds: float) -> None:
    """Wait until the rig's loop has run on for `seconds` of its own time."""

    def ticks() -> int:
        newest = host.latest()
        return -1 if newest is None else int(newest["tick"][0])

    end = ticks() + seconds * host.rate_hz
    await soon(lambda: ticks() >= end)


# A starved machine is late, and its table lags. It is told in warnings; what is tested is seldom how much.
PATIENT = GuardConfig(
    following_deg=Tolerance(1.0, 15.0),
    attitude_deg=Tolerance(1.0, 20.0),
    lateness_ms=Tolerance(2.0, 500.0),
    misses_per_s=Tolerance(20.0, None),
)
_STARVED = ("lateness", "missed_deadlines", "following_error", "attitude_error")


def codes_of(alarms: Sequence[Alarm]) -> list[str]:
    """The codes of `alarms`, but for the warnings of a starved machine."""
    return [a.code for a in alarms if a.severity is not Severity.WARNING or a.code not in _STARVED]


def config_of(tmp: Path, rig: str = "vertical-limited", **changes: Any) -> RigConfig:
    """A rig process's settings under `tmp`; its simulated table is as patient as its guard."""
    if changes.get("drive", "simulated") == "simulated":
        changes["drive_options"] = {"watchdog_s": PATIENT_WATCHDOG_S, **changes.get("drive_options", {})}
    settings: dict[str, Any] = {
        "realtime_priority": 40,
        "min_free_mb": 1.0,
        "exit_idle_s": 20.0,
        "guard": PATIENT,
    } | changes
    return RigConfig("test", builtin_rigs()[rig], tmp / "rig", tmp / "runs", **settings)


@contextlib.asynccontextmanager
async def hosted(config: RigConfig) -> AsyncIterator[tuple[RigHost, Operator]]:
    """A host with its rig process, ended afterwards."""
    host = RigHost(config)
    await host.start()
    try:
        yield host, Operator(host)
    finally:
        snapshot = host.snapshot()
        if snapshot.health.rig_alive and snapshot.state in IN_MOTION:
            host.estop("test end")
            await soon(lambda: host.snapshot().state not in IN_MOTION)
        await host.close(stop_rig=True)


def written(folder: Path, plan: PlanFolder) -> Path:
    """`plan` on disk."""
    write_plan(folder, plan)
    return folder
