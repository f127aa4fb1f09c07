"""Stop and E-stop of a moving rig while the server is attacked, beside a bare uvicorn's answer in the same run.

    python -m bench.realtime.stop_under_attack [--times 100] [--attacks json,bombs] [--disk FOLDER]

Each stop is asked over HTTP, the connection included, and over the stop channel. Two clocks start with the request: one
ends when the loop has written the first braking command (it notes the time in shared memory), one with the answer. The
attack `full` fills the disk anew before every move, since a rig is not armed on a full one; it needs a data folder on a
file system of its own, given as `--disk`, or as root the bench mounts one.
A normal viewer's largest gaps between frames, the server's memory and what the attackers were answered are told too.
"""

import argparse
import asyncio
import contextlib
import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from websockets.sync.client import connect

from bench.machine import machine
from bench.realtime.attacks import NAMES
from bench.realtime.bare_uvicorn import bare_server
from bench.realtime.estop_latency import RIG, ask, row
from bench.realtime.operator import Operator, attached, write_swing
from bench.realtime.rig_load import Viewer, served
from fullpose.rig import builtin_rigs
from fullpose_server.gate.system import SERVER, before_others
from fullpose_server.runtime.supervisor.rig_client import RigHost

FILES = 1024
Asking = Callable[[str], None]  # to stop or to E-stop
FULL = "full"  # the attack that is no client
DISK_BYTES = 320_000_000  # a rig is armed where 200 MB are free


class Ways:
    """How a stop is asked; each returns the answer's milliseconds."""

    def __init__(self, port: int, bare: int) -> None:
        self._port, self._bare = port, bare
        self._channel = connect(f"ws://127.0.0.1:{port}/api/v1/stop", proxy=None)

    def http(self, word: str) -> None:
        """A connection of its own."""
        ask(self._port, word)

    def channel(self, word: str) -> None:
        """The stop channel, open all the time."""
        self._channel.send(json.dumps({"type": word, "rig": RIG}))
        answer = json.loads(self._channel.recv(10))
        assert answer["type"] == "stopped", answer
        assert answer["done"]["unknown"] is None, answer

    def bare(self) -> None:
        """A bare uvicorn that says ok."""
        link = http.client.HTTPConnection("127.0.0.1", self._bare, timeout=60)
        link.request("POST", "/", b"")
        link.getresponse().read()
        link.close()

    def close(self) -> None:
        """No more."""
        self._channel.close()


class Gaps:
    """A normal viewer, in a thread: the gaps between its frames [s]."""

    def __init__(self, port: int) -> None:
        self._viewer = Viewer(port, RIG)
        self._viewer.link.setblocking(True)
        self.found: list[float] = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        last = time.monotonic()
        with contextlib.suppress(OSError):
            while self._viewer.read():
                now = time.monotonic()
                self.found.append(now - last)
                last = now


async def stop_once(host: RigHost, operator: Operator, over: Asking, word: str, sign: float) -> tuple[float, float]:
    """Milliseconds to the first braking command and to the answer, in the middle of a move."""
    pose = host.snapshot().pose_deg
    await operator.must("move", target_deg=[v + sign * 300.0 for v in pose])
    await asyncio.sleep(0.3)
    asked, answered = await asyncio.to_thread(_asked, over, word)
    await operator.until("estopped" if word == "estop" else "armed")
    wrote = int(host.memory.header[f"{word}_wrote_ns"][0])
    assert wrote >= asked, "the rig was not moving"
    if word == "estop":
        await asyncio.sleep(0.3)
        await operator.recover()
    return (wrote - asked) / 1e6, (answered - asked) / 1e6


def _asked(over: Asking, word: str) -> tuple[int, int]:
    before_others(SERVER)  # this thread: measured is the server, not who asks
    asked = time.monotonic_ns()
    over(word)
    return asked, time.monotonic_ns()


def timed(work: Callable[[], None]) -> float:
    """Milliseconds that it takes."""
    before_others(SERVER)
    begun = time.monotonic_ns()
    work()
    return (time.monotonic_ns() - begun) / 1e6


@contextlib.contextmanager
def attacked(name: str, port: int, data: Path) -> Iterator[None]:
    """The attack, in a process of its own."""
    if name in ("none", FULL):
        yield
        return
    command = [sys.executable, "-m", "bench.realtime.attacks", name, "--port", str(port), "--data", str(data)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE)
    assert process.stdin is not None
    time.sleep(5.0)
    try:
        yield
    finally:
        process.stdin.close()
        process.wait(120)


@contextlib.contextmanager
def filled(folder: Path) -> Iterator[None]:
    """A disk with no room left."""
    filler = folder / "filler"
    try:
        with filler.open("wb", 0) as file:
            for size in (1 << 20, 1 << 12):
                with contextlib.suppress(OSError):
                    while True:
                        file.write(bytes(size))
        yield
    finally:
        filler.unlink(missing_ok=True)


def memory_mb(pid: int) -> float:
    """The most that this process has held [MB]."""
    status = Path(f"/proc/{pid}/status").read_text("utf-8")
    return int(status.split("VmHWM:")[1].split()[0]) / 1024.0


async def measure(attack: str, times: int, root: Path) -> None:
    """One attack's rows."""
    rig = builtin_rigs()[RIG]
    plan = write_swing(Path(tempfile.mkdtemp()) / "plan", rig, 1.0)
    with served(root / "data", files=FILES) as (port, pid), bare_server() as bare:
        host = await attached(port, root / "data", rig)
        ways, gaps = Ways(port, bare), Gaps(port)
        await asyncio.sleep(1.0)
        gaps.found.clear()
        with attacked(attack, port, root / "data"):
            for way, over in (("HTTP", ways.http), ("channel", ways.channel)):
                for word in ("stop", "estop"):
                    operator = Operator(host)
                    await operator.take()
                    if host.snapshot().state != "armed":
                        await operator.arm(plan_folder=str(plan))
                    found = []
                    beside = []
                    for k in range(times):
                        if host.snapshot().state != "armed":
                            await operator.arm(plan_folder=str(plan))
                        with filled(root / "data") if attack == FULL else contextlib.nullcontext():
                            found.append(await stop_once(host, operator, over, word, (-1.0) ** k))
                        beside.append(await asyncio.to_thread(timed, ways.bare))
                    print(row(f"{attack}: {word} {way}, braking", [one[0] for one in found]))
                    print(row(f"{attack}: {word} {way}, answer", [one[1] for one in found]), flush=True)
                    print(row(f"{attack}: bare uvicorn, answer", beside), flush=True)
        print(row(f"{attack}: a viewer's gap", [1e3 * gap for gap in gaps.found]))
        print(f"# {attack}: the server held at most {memory_mb(pid):.0f} MB", flush=True)
        ways.close()
        await host.close(stop_rig=False)


@contextlib.contextmanager
def own_disk(folder: Path | None) -> Iterator[Path]:
    """A folder on a small file system of its own."""
    if folder is not None:
        yield folder
        return
    with tempfile.TemporaryDirectory() as made:
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES}", "tmpfs", made], check=True)
        try:
            yield Path(made)
        finally:
            subprocess.run(["umount", "-l", made], check=True)


def main() -> None:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--times", type=int, default=100)
    arguments.add_argument("--attacks", default=",".join(["none", *NAMES, FULL]))
    arguments.add_argument("--disk", type=Path, default=None)
    given = arguments.parse_args()
    print(machine(), os.getloadavg())
    print(f"{'request to ... [ms]':40s} {'p50':>8s} {'p99':>8s} {'max':>8s} {'times':>6s}")
    for attack in given.attacks.split(","):
        folder = own_disk(given.disk) if attack == FULL else tempfile.TemporaryDirectory()
        with folder as root:
            asyncio.run(measure(attack, given.times, Path(root)))


if __name__ == "__main__":
    main()
