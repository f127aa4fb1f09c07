"""Lateness of the rig loop at 1 kHz beside viewers, an upload and a planning job, next to a bare loop in the same run.

    python -m bench.realtime.loop_lateness [--seconds 60] [--viewers 200]

Prints one table: a bare SCHED_FIFO loop that only sleeps to its deadlines, then the rig process in a flight with
real-time scheduling, then the same without it; each alone and under load.
"""

import argparse
import asyncio
import dataclasses
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from bench.machine import machine
from bench.realtime.operator import Operator, write_swing
from bench.realtime.rig_load import loaded, post, served
from fullpose.rig import builtin_rigs
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.supervisor.rig_client import RigHost

RIG = "vertical-4"
BARE = """
import os, sys, time
try:
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(60))
except PermissionError:
    print("no real-time scheduling", file=sys.stderr)
period, n = 1_000_000, int(float(sys.argv[1]) * 1000)
due = time.monotonic_ns() + period
late = []
for _ in range(n):
    time.sleep(max(0, due - time.monotonic_ns()) / 1e9)
    late.append(time.monotonic_ns() - due)
    due += period
sys.stdout.write(" ".join(map(str, late)))
"""


def row(name: str, lateness_us: np.ndarray, misses: int) -> str:
    """One line of the table."""
    p50, p99, p999 = np.percentile(lateness_us, [50, 99, 99.9])
    return f"{name:44s} {p50:8.1f} {p99:8.1f} {p999:8.1f} {lateness_us.max():9.1f} {misses:7d} {len(lateness_us):8d}"


def bare(seconds: float) -> np.ndarray:
    """Lateness [us] of a loop that does nothing else."""
    done = subprocess.run([sys.executable, "-c", BARE, str(seconds)], capture_output=True, text=True, check=True)
    return np.array([int(v) for v in done.stdout.split()]) / 1e3


async def fly(host: RigHost, plan: Path, seconds: float) -> tuple[np.ndarray, int]:
    """Lateness [us] and deadlines missed over `seconds` of the loop, flying."""
    operator = Operator(host)
    await operator.arm(plan_folder=str(plan))
    await operator.must("start")
    await operator.until("running")
    missed = host.snapshot().health.deadline_misses
    newest = host.latest()
    assert newest is not None
    at = int(newest["seq"][0])
    parts: list[np.ndarray] = []
    while sum(map(len, parts)) < seconds * host.rate_hz:
        await asyncio.sleep(0.5)
        await operator.renew()
        rows, lost = host.samples(at, 1 << 16)
        assert lost == 0
        at = int(rows["seq"][-1])
        parts.append(rows["lateness_us"])
        assert host.snapshot().state == "running", host.snapshot().alarms
    missed = host.snapshot().health.deadline_misses - missed
    await host.stop("bench")
    await operator.until("armed")
    await operator.must("disarm")
    await operator.must("unload")
    return np.concatenate(parts), missed


async def measure(seconds: float, viewers: int) -> None:
    """Everything, one after another."""
    rig = builtin_rigs()[RIG]
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        plan = write_swing(root / "plan", rig, seconds + 20.0)
        print(machine())
        print(f"{'':44s} {'p50':>8s} {'p99':>8s} {'p99.9':>8s} {'max us':>9s} {'missed':>7s} {'ticks':>8s}", flush=True)
        late = bare(seconds)
        print(row("bare SCHED_FIFO loop, alone", late, int((late >= 1000).sum())), flush=True)
        with served(root / "data") as (port, _):
            status, body = post(port, f"/rigs/{RIG}/lease", {"action": "take"})
            assert status == 200, body
            config = RigConfig(RIG, rig, root / "data" / "processes" / RIG, root / "data" / "runs")
            found = [p.parent for p in (root / "data").rglob("rig.lock")]
            assert len(found) == 1, found
            host = RigHost(dataclasses.replace(config, directory=found[0]))
            await host.start()
            assert host.adopted
            kind = host.snapshot().health.realtime
            print(row("rig process, flying", *await fly(host, plan, seconds)), f" [{kind}]", flush=True)
            span = 2.0 * seconds + 60.0
            with loaded(port, RIG, viewers, span, upload=True, plan=True):
                await asyncio.sleep(5.0)
                name = f"rig process, {viewers} viewers, upload, planning"
                print(row(name, *await fly(host, plan, seconds)), flush=True)
                late = bare(seconds)
                print(row("bare SCHED_FIFO loop, the same load", late, int((late >= 1000).sum())), flush=True)
            await host.close(stop_rig=False)
        plain = RigConfig(RIG, rig, root / "plain", root / "runs", realtime_priority=None)
        host = RigHost(plain)
        await host.start()
        print(row("rig process, ordinary scheduling", *await fly(host, plan, seconds)), flush=True)
        await host.close(stop_rig=True)


def main() -> None:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=float, default=60.0)
    arguments.add_argument("--viewers", type=int, default=200)
    given = arguments.parse_args()
    asyncio.run(measure(given.seconds, given.viewers))


if __name__ == "__main__":
    main()
