"""A server that dies, stops or stays away: the rig holds, and its session is adopted."""

import asyncio
import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import httpx
import numpy as np
import pytest

from fullpose_server.runtime.contract.config import encode
from fullpose_server.runtime.contract.rig_paths import RigPaths
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.session.machine import SilencePolicy
from tests.faults.records import messages
from tests.fullpose_server.runtime.rigs import Operator, config_of, plan_of, within_limits, written
from tests.support.repository import PYTHONPATH
from tests.support.serving import start

CAMPAIGN = "FAULT_ROUNDS" in os.environ
MOMENTS = int(os.environ.get("FAULT_ROUNDS", "3"))
SAID_S = 0.2 if CAMPAIGN else 5.0  # by then the server has said what happened
QUICK = SilencePolicy(0.8, 8.0, 60.0)

SERVER = """
import asyncio, sys
from pathlib import Path
from fullpose_server.runtime.contract import config
from fullpose_server.runtime.supervisor.rig_client import RigHost
from tests.fullpose_server.runtime.rigs import Operator

async def main(settings, plan):
    host = RigHost(config.decode(Path(settings).read_bytes()))
    await host.start()
    operator = Operator(host, "the first server")
    await operator.fly(Path(plan))
    print("running", host.snapshot().health.rig_pid, flush=True)
    while True:
        await operator.renew()
        await asyncio.sleep(0.1)

asyncio.run(main(*sys.argv[1:]))
"""


@pytest.mark.parametrize("seed", range(MOMENTS if CAMPAIGN else 1))
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_a_dead_or_stopped_server_leaves_the_rig_held_and_the_session_is_adopted(
    tmp_path: Path, how: signal.Signals, seed: int
) -> None:
    config = config_of(tmp_path, server=QUICK)
    plan = written(tmp_path / "plan", plan_of(config.rig, 8.0))
    settings = tmp_path / "settings.json"
    settings.write_bytes(encode(config))
    process = subprocess.Popen(
        [sys.executable, "-c", SERVER, str(settings), str(plan)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        word, pid = process.stdout.readline().split()
        assert word == "running"
        time.sleep(float(np.random.default_rng(seed).uniform(0.1, 4.0)))
        process.send_signal(how)
        if how == signal.SIGKILL:
            process.wait()
        asyncio.run(_adopt(config, int(pid)))
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


async def _adopt(config: object, pid: int) -> None:
    await asyncio.sleep(2.0)
    host = RigHost(config)  # type: ignore[arg-type]
    await host.start()
    try:
        assert host.adopted
        snapshot = host.snapshot()
        assert snapshot.health.rig_pid == pid
        assert snapshot.state == "held"
        assert snapshot.lease.holder == "the first server"
        assert snapshot.plan is not None
        assert "server_silent" in [a.code for a in snapshot.alarms]
        within_limits(host.samples(0, 1 << 20)[0], host)
        operator = Operator(host, "the second server")
        await operator.take("takeover")
        await operator.must("resume")
        await operator.until("armed")
        rows, _ = host.samples(0, 1 << 20)
        assert np.nanmax(rows["solve_error_deg"]) <= 1e-9
    finally:
        await host.close(stop_rig=True)
    assert RigPaths(host.config.directory).running() is None


def test_a_server_that_stays_away_means_a_stop_and_in_the_end_the_process_leaves(tmp_path: Path) -> None:
    config = config_of(tmp_path, server=SilencePolicy(0.3, 0.6, 0.9), exit_idle_s=2.0)
    plan = written(tmp_path / "plan", plan_of(config.rig, 8.0))
    settings = tmp_path / "settings.json"
    settings.write_bytes(encode(config))
    process = subprocess.Popen(
        [sys.executable, "-c", SERVER, str(settings), str(plan)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        pid = int(process.stdout.readline().split()[1])
        process.kill()
        process.wait()
        deadline = time.monotonic() + 20.0
        while Path(f"/proc/{pid}").exists() and time.monotonic() < deadline:
            time.sleep(0.1)
        assert not Path(f"/proc/{pid}").exists()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    assert not RigPaths(config.directory).memory().exists()
    numbers = messages(next(iter((tmp_path / "runs").iterdir())))
    assert (np.diff(numbers) == 1).all()


# In a gate's process: as long over its imports as on a starved machine.
SLOW_GATE = """
import sys, time
if "fullpose_server.gate.process" in " ".join(sys.orig_argv):
    time.sleep(9.0)
"""


def test_a_stop_gate_that_takes_long_to_begin_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(SLOW_GATE)
    paths = [str(tmp_path / "site"), *filter(None, [os.environ.get("PYTHONPATH")]), PYTHONPATH]
    served = start("serve", "--port", "0", "--data-dir", tmp_path / "data", PYTHONPATH=os.pathsep.join(paths))
    try:
        assert served.stdout is not None
        url = served.stdout.readline().strip()
        assert httpx.get(f"{url}/api/v1/rigs", timeout=120.0).is_success
    finally:
        served.send_signal(signal.SIGINT)
        _, said = served.communicate(timeout=60)
    assert "started anew" not in said
