"""A real rig process follows a live source, by the local socket and by UDP; each sample waits for its reply."""

import asyncio
import socket
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fullpose_server.operating import GuardConfig, Tolerance
from fullpose_server.runtime.contract.config import LiveConfig
from fullpose_server.runtime.live.packets import (
    REPLY_SIZE,
    Kind,
    LiveReply,
    LiveStatus,
    decode_reply,
    encode_sample,
)
from fullpose_server.runtime.live.provenance import coded, digest_of
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.machine import SilencePolicy
from tests.fullpose_server.runtime.live.swing import flight
from tests.fullpose_server.runtime.rigs import LIVE_KEY, config_of, hosted, within_limits

# Whatever the machine of the tests does meanwhile: what is tested is that samples arrive and are flown.
OFF = Tolerance(None, None)
PATIENT = GuardConfig(following_deg=OFF, attitude_deg=OFF, lateness_ms=OFF, misses_per_s=OFF, stale_ms=OFF)
SILENCE = SilencePolicy(60.0, 120.0, 180.0)
PATIENCE_S = 120.0
FOLLOWED = 500


def udp(port: int) -> socket.socket:
    source = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    source.connect(("127.0.0.1", port))
    source.setblocking(False)
    return source


async def reply_to(source: socket.socket, sample: bytes) -> LiveReply:
    loop = asyncio.get_running_loop()
    await loop.sock_sendall(source, sample)
    async with asyncio.timeout(PATIENCE_S):
        reply = decode_reply(await loop.sock_recv(source, REPLY_SIZE))
    assert reply is not None
    return reply


async def follow(host: RigHost, source: socket.socket, proven: Callable[[bytes], bytes]) -> list[LiveReply]:
    """Send the swing, as time goes, until so many samples were followed: those replies."""
    followed: list[LiveReply] = []
    begun, sequence = time.monotonic(), 0
    while len(followed) < FOLLOWED:
        t = time.monotonic() - begun
        q, rate = flight(t)
        sample = encode_sample(Kind.QUATERNION, sequence, t, tuple(q), tuple(np.degrees(rate)))
        reply = await reply_to(source, proven(sample))
        assert (reply.sequence, reply.time_s) == (sequence, t)
        assert host.snapshot().state == "live", host.snapshot().alarms
        if reply.status == LiveStatus.FOLLOWED:
            followed.append(reply)
        sequence += 1
    return followed


WAYS: dict[str, Callable[[bytes], bytes]] = {
    "local": lambda sample: sample + digest_of(LIVE_KEY),
    "udp, coded": lambda sample: coded(sample, LIVE_KEY),
    "udp, from its address": lambda sample: sample,
}


@pytest.mark.parametrize("way", WAYS)
def test_samples_arrive_and_are_flown_and_the_end_of_them_is_a_controlled_stop(tmp_path: Path, way: str) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    async def fly() -> None:
        live = LiveConfig(udp_port=port, extrapolate_ms=3000.0, delay_ms=20.0)
        config = replace(config_of(tmp_path, guard=PATIENT, live=live), owner=SILENCE, server=SILENCE)
        async with hosted(config) as (host, operator):
            source: AbstractContextManager[socket.socket] = host.live_socket() if way == "local" else udp(port)
            with source as link, udp(port) as stranger:
                named = {"udp_from": "{}:{}".format(*link.getsockname())} if "address" in way else {}
                await operator.arm_live(method="exact", **named)
                await operator.must("go_live")
                unproven = await reply_to(stranger, encode_sample(Kind.QUATERNION, 0, 0.0, (1.0, 0.0, 0.0, 0.0), ()))
                assert unproven.status == LiveStatus.UNPROVEN
                for reply in await follow(host, link, WAYS[way]):
                    assert reply.error_deg <= 1e-9
                    assert 0.0 <= reply.margin <= 1.0
                    assert reply.latency_us >= 0.0
            snapshot = await operator.until("armed", "faulted", seconds=PATIENCE_S)
            assert snapshot.state == "armed", snapshot.alarms
            assert "live_source_lost" in [alarm.code for alarm in snapshot.alarms]
            within_limits(host.samples(0, 1 << 20)[0], host)

    asyncio.run(fly())
