"""Live source at 1 kHz on loopback: sample to reply, and whether the rig process's memory stays flat.

    python -m bench.realtime.live_latency [--seconds 60] [--way udp|websocket]        (600 for the soak)

Round trip: from before the send to after the reply's arrival, the wait for the loop's next tick included. Latency: the
loop's own figure, from the sample's arrival in the rig process to the reply. By WebSocket the samples go through a
real `fullpose serve`, in binary.
"""

import argparse
import asyncio
import json
import math
import select
import socket
import tempfile
import threading
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import numpy as np
from websockets.sync.client import connect

from bench.machine import machine
from bench.realtime.operator import Operator
from bench.realtime.rig_load import served
from fullpose.rig import builtin_rigs
from fullpose_server.client import Client
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.live.packets import (
    REPLY_SIZE,
    Kind,
    LiveReply,
    LiveStatus,
    decode_reply,
    encode_sample,
)
from fullpose_server.runtime.supervisor.rig_client import RigHost

RIG = "vertical-4"


def resident_kb(pid: int) -> int:
    """Resident memory of a process [kB]."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith("VmRSS")).split()[1])


class Udp:
    """Datagrams to the rig process."""

    def __init__(self, port: int) -> None:
        self._link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._link.connect(("127.0.0.1", port))
        self._link.setblocking(False)

    @property
    def address(self) -> str:
        """Where they come from."""
        return "{}:{}".format(*self._link.getsockname())

    def send(self, sample: bytes) -> None:
        self._link.send(sample)

    def reply(self, seconds: float) -> bytes | None:
        """The next reply, waited for as long; None without one."""
        return self._link.recv(REPLY_SIZE) if select.select([self._link], [], [], seconds)[0] else None

    def close(self) -> None:
        self._link.close()


class WebSocket:
    """The server's live WebSocket, binary."""

    def __init__(self, port: int, key: str) -> None:
        url = f"ws://127.0.0.1:{port}/api/v1/rigs/{RIG}/live"
        self._link = connect(url, proxy=None, compression=None)
        self._link.send(json.dumps({"type": "open", "key": key}))
        self._link.recv(timeout=30.0)

    def send(self, sample: bytes) -> None:
        self._link.send(sample)

    def reply(self, seconds: float) -> bytes | None:
        """The next reply, waited for as long; None without one."""
        try:
            data = self._link.recv(timeout=seconds)
        except TimeoutError:
            return None
        return data if isinstance(data, bytes) else None

    def close(self) -> None:
        self._link.close()


class Source(threading.Thread):
    """Sends a smooth flight at 1 kHz and notes when each reply comes."""

    def __init__(self, link: Udp | WebSocket, seconds: float) -> None:
        super().__init__(daemon=True)
        self._link = link
        self._seconds = seconds
        self.sent = 0
        self.trips: list[float] = []
        self.latency: list[float] = []
        self.errors: list[float] = []
        self.statuses: dict[int, int] = {}

    def run(self) -> None:
        """Until the time is over."""
        sent_at: dict[int, int] = {}
        begun = due = time.monotonic()
        while (t := time.monotonic() - begun) < self._seconds:
            ramp = min(1.0, t / 3.0) ** 3
            angles = tuple(ramp * a * math.sin(w * t) for a, w in ((30.0, 0.7), (15.0, 1.1), (40.0, 0.9)))
            sent_at[self.sent] = time.monotonic_ns()
            self._link.send(encode_sample(Kind.EULER, self.sent, t, angles, ()))
            self.sent += 1
            due = max(due + 1e-3, time.monotonic() - 0.01)
            while (left := due - time.monotonic()) > 0.0:
                data = self._link.reply(left)
                if data is None:
                    break
                self._note(decode_reply(data), sent_at)
        self._link.close()

    def _note(self, reply: LiveReply | None, sent_at: dict[int, int]) -> None:
        now = time.monotonic_ns()
        if reply is None or reply.sequence not in sent_at:
            return
        self.trips.append((now - sent_at.pop(reply.sequence)) / 1e3)
        self.latency.append(reply.latency_us)
        self.statuses[reply.status] = self.statuses.get(reply.status, 0) + 1
        if reply.status == LiveStatus.FOLLOWED:
            self.errors.append(reply.error_deg)


async def by_udp(seconds: float) -> None:
    """Straight to a rig process."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        live = LiveConfig(udp_port=port, extrapolate_ms=90.0)  # below the guard's trip: the end is a controlled stop
        rig = builtin_rigs()[RIG]
        host = RigHost(RigConfig("live", rig, root / "rig", root / "runs", live=live, min_free_mb=1.0))
        await host.start()
        operator = Operator(host)
        udp = Udp(port)
        await operator.arm(live={"method": "exact", "udp_from": udp.address})
        await operator.must("go_live")
        source = Source(udp, seconds)
        memory = await followed(source, host.snapshot().health.rig_pid, operator.renew)
        await operator.until("armed", "faulted")
        snapshot = host.snapshot()
        await host.close(stop_rig=True)
    report(source, memory, snapshot.state, [a.code for a in snapshot.alarms])


async def by_websocket(seconds: float) -> None:
    """Through a server."""
    with tempfile.TemporaryDirectory() as folder, served(Path(folder)) as (port, _):
        async with Client(f"http://127.0.0.1:{port}", name="bench") as client:
            await client.take_lease(RIG)
            await client.command(RIG, "connect")
            loaded = await client.command(RIG, "load", live={"method": "exact"})
            source = Source(WebSocket(port, loaded["live_key"]), seconds)
            await client.command(RIG, "arm")
            await client.command(RIG, "go_live")
            pid = (await client.session(RIG))["health"]["rig_pid"]
            memory = await followed(source, pid, lambda: client.take_lease(RIG, "renew"))
            session = await client.wait_state(RIG, "armed", "faulted")
    report(source, memory, session["state"], [a["code"] for a in session["alarms"]])


async def followed(source: Source, pid: int, renew: Callable[[], Awaitable[object]]) -> list[int]:
    """Let the source fly; the rig process's memory [kB], once a second."""
    memory = []
    source.start()
    begun = time.monotonic()
    while source.is_alive():
        await asyncio.sleep(1.0)
        await renew()
        if time.monotonic() - begun > 5.0:
            memory.append(resident_kb(pid))
    return memory


def report(source: Source, memory: list[int], state: str, alarms: list[str]) -> None:
    """Print the figures."""
    print(machine())
    for name, values in (("round trip [us]", source.trips), ("latency in the rig process [us]", source.latency)):
        p50, p99, p999 = np.percentile(values, [50, 99, 99.9])
        print(f"{name:34s} p50 {p50:8.1f}  p99 {p99:8.1f}  p99.9 {p999:8.1f}  max {max(values):8.1f}")
    print(f"sent {source.sent}, answered {len(source.trips)}, by status {source.statuses}")
    print(f"largest solve error where followed {max(source.errors):.2e} deg")
    print(f"memory of the rig process {memory[0]} kB -> {memory[-1]} kB over {len(memory)} s")
    print(f"ended {state}, alarms {alarms}")


def main() -> None:
    """Read the command line and measure."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=60.0)
    arguments.add_argument("--way", choices=("udp", "websocket"), default="udp")
    given = arguments.parse_args()
    asyncio.run((by_udp if given.way == "udp" else by_websocket)(given.seconds))


if __name__ == "__main__":
    main()
