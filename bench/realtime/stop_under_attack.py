"""Stop and E-stop of a moving rig while the server is attacked, beside a bare uvicorn's answer in the same run.

    python -m bench.realtime.stop_under_attack [--times 100] [--attacks json,bombs] [--ways HTTP,channel] [--json FILE]

Each stop is asked over HTTP, the connection included, and over the stop channel. Two clocks start with the request: one
ends when the loop has written the first braking command (it notes the time in shared memory), one with the answer. The
attack `full` fills the disk anew before every move, since a rig is not armed on a full one; it needs a data folder on a
file system of its own, given as `--disk FOLDER`, or as root the bench mounts one.
A stop that is refused, or not answered within ten seconds, is counted as lost. A normal viewer's largest gaps between
frames, the server's memory and what the attackers were answered are told too.
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
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bench.machine import machine
from bench.realtime.attacks import NAMES
from bench.realtime.bare_uvicorn import bare_server
from bench.realtime.estop_latency import RIG, row
from bench.realtime.operator import Operator, attached, write_swing
from bench.realtime.rig_load import served
from bench.realtime.stop_ways import Ways
from bench.realtime.witnesses import Gaps, Memory
from fullpose.rig import builtin_rigs
from fullpose_server.gate.system import SERVER, before_others
from fullpose_server.runtime.supervisor.rig_client import RigHost

FILES = 1024
WAYS = ("HTTP", "channel")
Asking = Callable[[str], None]  # to stop or to E-stop
TRIPPED = ("faulted", "ready", "disconnected")
FULL = "full"  # the attack that is no client
DISK_BYTES = 320_000_000  # a rig is armed where 200 MB are free
BOUNDS = {"braking_ms": 20.0, "answer_ms": 100.0, "gap_ms": 100.0, "server_mb": 1024.0}  # p99, and the most


class Stops:
    """The stops of one word over one way: milliseconds to the first braking command and to the answer."""

    def __init__(self) -> None:
        self.braking: list[float] = []
        self.answer: list[float] = []
        self.bare: list[float] = []
        self.lost: list[str] = []
        self.tripped: list[str] = []  # after the stop the rig was faulted, or had been disarmed: why

    async def once(self, host: RigHost, operator: Operator, over: Asking, word: str, sign: float) -> None:
        """One, in the middle of a move."""
        pose = host.snapshot().pose_deg
        await operator.must("move", target_deg=[v + sign * 300.0 for v in pose])
        await asyncio.sleep(0.3)
        try:
            asked, answered = await asyncio.to_thread(_asked, over, word)
        except (AssertionError, OSError, http.client.HTTPException) as refused:
            self.lost.append(repr(refused)[:300])
            await operator.say("stop")
            await operator.until("estopped", "armed", *TRIPPED)
        else:
            await operator.until("estopped" if word == "estop" else "armed", *TRIPPED)
            wrote = int(host.memory.header[f"{word}_wrote_ns"][0])
            assert wrote >= asked, "the rig was not moving"
            self.braking.append((wrote - asked) / 1e6)
            self.answer.append((answered - asked) / 1e6)
        state = host.snapshot().state
        if state in TRIPPED:
            self.tripped.append(", ".join(f"{a.code}: {a.message}" for a in host.snapshot().alarms)[:300] or state)
        if state in ("estopped", "faulted"):
            await asyncio.sleep(0.3)
            await operator.recover()
        elif state == "ready":
            await operator.must("unload")


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
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.readline()  # it begins
    time.sleep(5.0)
    try:
        yield
    finally:
        print(process.communicate(timeout=120)[0], end="", flush=True)


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


async def measure(attack: str, times: int, root: Path, over: Sequence[str] = WAYS) -> dict[str, Any]:
    """One attack's rows."""
    rig = builtin_rigs()[RIG]
    plan = write_swing(Path(tempfile.mkdtemp()) / "plan", rig, 1.0)
    found: dict[str, Stops] = {}
    with served(root / "data", files=FILES) as (port, pid), bare_server() as bare:
        host = await attached(port, root / "data", rig)
        ways, gaps, memory = Ways(port, bare), Gaps(port, RIG), Memory(pid)
        await asyncio.sleep(1.0)
        gaps.found.clear()
        with attacked(attack, port, root / "data"):
            for way in over:
                ask = {"HTTP": ways.http, "channel": ways.channel}[way]
                for word in ("stop", "estop"):
                    stops = found[f"{word} {way}"] = Stops()
                    operator = Operator(host)
                    await operator.take()
                    for k in range(times):
                        if host.snapshot().state != "armed":
                            await operator.arm(plan_folder=str(plan))
                        with filled(root / "data") if attack == FULL else contextlib.nullcontext():
                            await stops.once(host, operator, ask, word, (-1.0) ** k)
                        stops.bare.append(await asyncio.to_thread(timed, ways.bare))
                    told(f"{attack}: {word} {way}", stops)
        memory.close()
        print(row(f"{attack}: a viewer's gap", [1e3 * gap for gap in gaps.found]), flush=True)
        result = summary(found, gaps, memory)
        gaps.close()
        ways.close()
        await host.close(stop_rig=False)
    return result


def told(name: str, stops: Stops) -> None:
    """The rows of one word over one way."""
    for what in ("braking", "answer", "bare"):
        values = getattr(stops, what)
        if values:
            print(row(f"{name}, {'bare uvicorn' if what == 'bare' else what}", values), flush=True)
    for why in stops.tripped:
        print(f"# {name}: the rig tripped: {why}", flush=True)
    for why in stops.lost:
        print(f"# {name}: LOST: {why}", flush=True)


def summary(found: dict[str, Stops], gaps: Gaps, memory: Memory) -> dict[str, Any]:
    """Of one attack, for the table and as JSON: the largest p99 of the words and ways."""

    def largest(what: str) -> float:
        return max((p99(getattr(stops, what)) for stops in found.values()), default=float("nan"))

    values = {"braking_ms": largest("braking"), "answer_ms": largest("answer"), "bare_ms": largest("bare")}
    values |= {"gap_ms": 1e3 * p99(gaps.found), "server_mb": memory.server_mb}
    lost = sum(len(stops.lost) for stops in found.values())
    met = not lost and not gaps.ended and all(values[name] <= bound for name, bound in BOUNDS.items())
    more = {"with_workers_mb": memory.with_workers_mb, "stops": sum(len(stops.answer) for stops in found.values())}
    return values | more | {"lost": lost, "met": met, "all": {name: vars(stops) for name, stops in found.items()}}


def p99(values: list[float]) -> float:
    """The 99th percentile; nan of nothing, which meets no bound."""
    return float(np.percentile(values, 99)) if values else float("nan")


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


def table(results: dict[str, dict[str, Any]]) -> str:
    """A line an attack."""
    names = ["braking_ms", "answer_ms", "bare_ms", "gap_ms", "server_mb", "with_workers_mb", "stops", "lost"]
    lines = [f"{'p99, the largest of words and ways':36s}" + "".join(f"{name:>16s}" for name in names) + "  met"]
    for attack, one in results.items():
        figures = "".join(f"{one[name]:16.1f}" if "_" in name else f"{one[name]:16d}" for name in names)
        lines.append(f"{attack:36s}{figures}  {'yes' if one['met'] else 'NO'}")
    bounds = "".join(f"{BOUNDS[name]:16.1f}" if name in BOUNDS else f"{'':16s}" for name in names)
    return "\n".join([*lines, f"{'bound':36s}{bounds}"])


def main() -> None:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--times", type=int, default=100)
    arguments.add_argument("--attacks", default=",".join(["none", *NAMES, FULL]))
    arguments.add_argument("--ways", default=",".join(WAYS))
    arguments.add_argument("--disk", type=Path, default=None)
    arguments.add_argument("--json", type=Path, default=None)
    given = arguments.parse_args()
    load = os.getloadavg()
    print(machine(), load)
    print(f"{'request to ... [ms]':44s} {'p50':>8s} {'p99':>8s} {'max':>8s} {'times':>6s}")
    results: dict[str, dict[str, Any]] = {}
    for attack in given.attacks.split(","):
        folder = own_disk(given.disk) if attack == FULL else tempfile.TemporaryDirectory()
        with folder as root:
            results[attack] = asyncio.run(measure(attack, given.times, Path(root), given.ways.split(",")))
        if given.json is not None:
            told_of = {"machine": machine(), "load": load, "bounds": BOUNDS, "attacks": results}
            given.json.write_text(json.dumps(told_of, indent=1), encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()
