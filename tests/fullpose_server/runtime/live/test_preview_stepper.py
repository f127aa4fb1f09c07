"""A live source flown by `preview`: foresight from a process of its own, which may die without anybody falling."""

import asyncio
import math
import os
import signal
from pathlib import Path

import numpy as np

from fullpose_server.runtime.contract.config import LiveConfig
from fullpose_server.runtime.live.packets import LiveStatus
from tests.fullpose_server.runtime.live.test_source import PATIENT, angle_deg, flight, follow
from tests.fullpose_server.runtime.rigs import config_of, hosted
from tests.fullpose_server.runtime.supervisor.test_rig_client import within_limits

PREVIEW_S = 0.4
LIVE = LiveConfig(extrapolate_ms=500.0, delay_ms=20.0)


def planners(of: int) -> list[int]:
    """Process ids of the planners that are children of `of`."""
    found = []
    for folder in Path("/proc").iterdir():
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except (OSError, ValueError, IndexError):
            continue
        if parent == of and b"fullpose_server.runtime.live.planner_process" in words:
            found.append(int(folder.name))
    return found


def test_what_is_told_ahead_is_flown_exactly_when_it_is_due(tmp_path: Path) -> None:
    async def fly() -> None:
        async with hosted(config_of(tmp_path, guard=PATIENT, live=LIVE)) as (host, operator):
            await operator.take()
            await operator.must("connect")
            wrong = (
                ({"preview_s": 3.0}, "preview_s"),
                ({"beam": 0}, "beam"),
                ({"beam": "x"}, "beam"),
                ({"way": 1}, "way"),
            )
            for options, word in wrong:
                refused = await operator.say("load", live={"method": "preview", "options": options})
                assert refused.error is not None
                assert word in refused.error.message
            await operator.must("load", live={"method": "preview", "options": {"preview_s": PREVIEW_S}})
            await operator.must("arm")
            await asyncio.sleep(0.3)
            assert host.snapshot().state == "armed", host.snapshot().alarms
            with host.live_socket() as source:
                await operator.must("go_live")
                replies = await follow(host, 5.0, source)
                snapshot = host.snapshot()
                assert snapshot.state == "live", snapshot.alarms
                heard = snapshot.health.live
                assert heard is not None
                assert heard.way_age_ms is not None
                assert heard.way_age_ms < 2000.0  # without a word of the planner it were five seconds
            settled = [r for r in replies if r.status == LiveStatus.FOLLOWED][len(replies) // 2 :]
            assert len(settled) > 500
            assert max(r.error_deg for r in settled) <= 1e-9
            behind = LIVE.delay_ms / 1e3 + PREVIEW_S
            for reply in settled[::50]:
                # Behind the sample by what it is told ahead, give or take what a starved machine shifts.
                early, late = (flight(max(0.0, reply.time_s - behind - slack))[0] for slack in (-0.05, 0.05))
                now = flight(reply.time_s)[0]
                low, high = sorted((angle_deg(now, early), angle_deg(now, late)))
                assert low - 1.5 <= reply.lag_deg <= high + 1.5
            snapshot = await operator.until("armed", "faulted")
            assert snapshot.state == "armed", snapshot.alarms
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())


def test_a_planner_that_dies_is_told_and_costs_foresight_alone(tmp_path: Path) -> None:
    async def fly() -> None:
        async with hosted(config_of(tmp_path, guard=PATIENT, live=LIVE)) as (host, operator):
            await operator.take()
            await operator.must("connect")
            await operator.must("load", live={"method": "preview"})
            rig = host.snapshot().health.rig_pid
            (planner,) = planners(rig)
            await operator.must("arm")
            with host.live_socket() as source:
                await operator.must("go_live")
                flying = asyncio.create_task(follow(host, 4.5, source))
                await asyncio.sleep(1.5)
                os.kill(planner, signal.SIGKILL)
                replies = await flying
                snapshot = host.snapshot()
                assert snapshot.state == "live", snapshot.alarms
                assert "preview_late" in [a.code for a in snapshot.alarms]
            settled = [r for r in replies if r.status == LiveStatus.FOLLOWED][len(replies) // 2 :]
            assert len(settled) > 300
            assert max(r.error_deg for r in settled) <= 1e-9
            await operator.until("armed")
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
            assert math.isfinite(float(np.abs(rows["demand"]).max()))
            for word in ("disarm", "unload"):
                await operator.must(word)
            assert planners(rig) == []
            await operator.must("load", live={"method": "preview"})
            assert len(planners(rig)) == 1
            await operator.must("unload")
            assert planners(rig) == []

    asyncio.run(fly())
