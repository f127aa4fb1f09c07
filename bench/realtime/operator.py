"""What the rig benchmarks drive a rig process with: an operator who holds the lease, and a flight to fly."""

import asyncio
import contextlib
import secrets
from pathlib import Path
from typing import Any

import numpy as np

from bench.realtime.rig_load import post
from fullpose.attitude import quaternion_from_dcm
from fullpose.rig import Rig
from fullpose.verify import payload_attitudes
from fullpose_server.formats.plan_folder import PlanOrigin, PlanPath, make_plan, write_plan
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.messages import Reply
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.secret import proof_of
from fullpose_server.session.lease import LeaseAction, LeaseToken

SWING = np.radians([40.0, 50.0, 35.0, 45.0])
HERTZ = np.array([0.2, 0.17, 0.25, 0.3])


def write_swing(folder: Path, rig: Rig, seconds: float, rate_hz: float = 1000.0) -> Path:
    """A plan in `folder`: every frame swings, run up and down over a second, inside the built-in limits."""
    n = round((seconds + 2.0) * rate_hz) + 1
    share = np.clip(np.minimum(np.arange(n), np.arange(n)[::-1]) / rate_hz, 0.0, 1.0)
    phase = np.cumsum(share**3 * (10.0 - 15.0 * share + 6.0 * share**2)) / rate_hz
    angles = rig.home + SWING * np.sin(2.0 * np.pi * HERTZ * phase[:, None])
    lead = round(rate_hz) + 1
    path = PlanPath(angles, quaternion_from_dcm(payload_attitudes(rig, angles)), np.zeros(n), lead, lead)
    plan = make_plan(PlanOrigin("bench", "0" * 64, "bench"), rig, rate_hz, path, feasible=True)
    write_plan(folder, plan)
    return folder


async def attached(port: int, data: Path, rig: Rig) -> RigHost:
    """The process of a built-in rig of the server at `port`, started by taking its lease, as a second host of it."""
    status, body = post(port, f"/rigs/{rig.name}/lease", {"action": "take"})
    assert status == 200, body
    host = RigHost(RigConfig(rig.name, rig, data / "rigs" / rig.name, data / "runs"))
    await host.start()
    return host


class Operator:
    """Commands a rig process as a client does: takes the lease, counts the sequence."""

    def __init__(self, host: RigHost) -> None:
        self._host = host
        self._proof = proof_of(secrets.token_urlsafe())
        self._token = LeaseToken(0, 0, self._proof)

    async def take(self) -> None:
        """Take the lease from whoever holds it."""
        lease = await self._host.lease(LeaseAction.TAKEOVER, "bench", self._proof)
        self._token = LeaseToken(lease.epoch, lease.sequence, self._proof)

    async def renew(self) -> None:
        """Keep the lease."""
        await self._host.lease(LeaseAction.RENEW, "bench", self._proof)

    async def say(self, command: str, **args: Any) -> Reply:
        """One command, with the next sequence number."""
        self._token = LeaseToken(self._token.epoch, self._token.sequence + 1, self._proof)
        return await self._host.command(command, args, "bench", self._token)

    async def must(self, command: str, **args: Any) -> None:
        """One command that is to be carried out."""
        reply = await self.say(command, **args)
        if not reply.ok:
            raise RuntimeError(f"{command}: {reply}")

    async def arm(self, **load: Any) -> None:
        """With the lease, from wherever the session is at rest to armed with what `load` says."""
        await self.take()
        if self._host.snapshot().state == "disconnected":
            await self.must("connect")
        await self.must("load", **load)
        await self.must("arm")

    async def until(self, *states: str, seconds: float = 30.0) -> None:
        """Wait for one of `states`, keeping the lease alive."""
        async with asyncio.timeout(seconds):
            while (snapshot := self._host.snapshot()).state not in states:
                await self.renew()
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self._host.wait_change(snapshot.revision), 0.2)

    async def recover(self) -> None:
        """Acknowledge, and reset once at rest."""
        await self.must("acknowledge")
        async with asyncio.timeout(4.0):
            while not (await self.say("reset")).ok:  # noqa: ASYNC110  refused until at rest: there is no event to wait for
                await asyncio.sleep(0.01)
