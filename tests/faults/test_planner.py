"""The planner of a live preview dies: it is told, and costs foresight alone."""

import asyncio
import math
import os
import signal
import socket
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from fullpose_server.runtime.contract.config import LiveConfig, Tolerance
from fullpose_server.runtime.live.packets import (
    REPLY_SIZE,
    Kind,
    LiveReply,
    LiveStatus,
    decode_reply,
    encode_sample,
)
from fullpose_server.runtime.live.provenance import digest_of
from tests.fullpose_server.runtime import rigs
from tests.fullpose_server.runtime.live.swing import flight
from tests.fullpose_server.runtime.rigs import config_of, hosted, within_limits
from tests.support.waiting import soon

# The machine of the tests may starve the sender: bridge longer than on a quiet one.
PATIENT = replace(rigs.PATIENT, stale_ms=Tolerance(None, None))
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


async def follow(operator: rigs.Operator, source: socket.socket, replies: list[LiveReply]) -> None:
    """Send the swing at 500 Hz and gather the replies, until cancelled."""
    started, sequence = time.monotonic(), 0
    while True:
        t = time.monotonic() - started
        q, rate = flight(t)
        sample = encode_sample(Kind.QUATERNION, sequence, t, tuple(q), tuple(np.degrees(rate)))
        source.send(sample + digest_of(rigs.LIVE_KEY))
        sequence += 1
        while True:
            try:
                reply = decode_reply(source.recv(REPLY_SIZE))
            except BlockingIOError:
                break
            assert reply is not None
            replies.append(reply)
        if sequence % 200 == 0:
            await operator.renew()
        await asyncio.sleep(0.002)


def test_a_planner_that_dies_is_told_and_costs_foresight_alone(tmp_path: Path) -> None:
    async def fly() -> None:
        async with hosted(config_of(tmp_path, guard=PATIENT, live=LIVE)) as (host, operator):
            await operator.take()
            await operator.must("connect")
            await operator.must("load", live={"method": "preview"})
            rig = host.snapshot().health.rig_pid
            (planner,) = planners(rig)
            await operator.must("arm")
            replies: list[LiveReply] = []

            def followed() -> list[LiveReply]:
                return [reply for reply in replies if reply.status == LiveStatus.FOLLOWED]

            with host.live_socket() as source:
                await operator.must("go_live")
                flying = asyncio.create_task(follow(operator, source, replies))
                await soon(lambda: len(followed()) > 100)
                os.kill(planner, signal.SIGKILL)
                await soon(lambda: "preview_late" in [alarm.code for alarm in host.snapshot().alarms])
                before = len(followed())
                await soon(lambda: len(followed()) > before + 300)
                snapshot = host.snapshot()
                assert snapshot.state == "live", snapshot.alarms
                flying.cancel()
            assert max(reply.error_deg for reply in followed()) <= 1e-9
            await operator.until("armed")
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
            assert math.isfinite(float(np.abs(rows["demand"]).max()))
            for word in ("disarm", "unload"):
                await operator.must(word)
            assert planners(rig) == []
            await operator.must("load", live={"method": "preview"})
            await soon(lambda: len(planners(rig)) == 1)
            await operator.must("unload")
            assert planners(rig) == []

    asyncio.run(fly())
