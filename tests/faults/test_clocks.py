"""The machine's clock is set while a rig flies: nothing is timed by it, so nothing happens but in the wall times."""

import asyncio
from pathlib import Path

import numpy as np
import pytest

from fullpose_server.runtime.recording.mcap_reader import is_complete, read_samples, recover_messages
from tests.fullpose_server.runtime.rigs import codes_of, config_of, hosted, plan_of, within_limits, written

# Setting the real clock would reach every process of the machine. In the processes of the rig, which begin with this
# module, the clock is the machine's and what the file says [s].
STEPPED = """
import os, time
_time_ns = time.time_ns
def _offset_ns():
    try:
        with open(os.environ["STEPPED_CLOCK"]) as file:
            return round(float(file.read()) * 1e9)
    except (OSError, ValueError):
        return 0
time.time_ns = lambda: _time_ns() + _offset_ns()
time.time = lambda: time.time_ns() / 1e9
"""
HOUR_S = 3600.0


def test_a_clock_that_is_set_in_flight_disturbs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(STEPPED)
    clock = tmp_path / "clock"
    clock.write_text("0")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "site"))
    monkeypatch.setenv("STEPPED_CLOCK", str(clock))

    async def fly() -> None:
        config = config_of(tmp_path)
        plan = written(tmp_path / "plan", plan_of(config.rig, 4.0))
        async with hosted(config) as (host, operator):
            await operator.fly(plan)
            for offset in (HOUR_S, -2.0 * HOUR_S):
                await asyncio.sleep(1.2)
                draft = clock.with_suffix(".tmp")
                draft.write_text(str(offset))
                draft.replace(clock)
            snapshot = await operator.until("armed", "faulted", "held")
            assert snapshot.state == "armed", snapshot.alarms
            assert codes_of(snapshot.alarms) == []
            assert snapshot.lease.holder == operator.who
            rows, _ = host.samples(0, 1 << 20)
            within_limits(rows, host)
        (record,) = (tmp_path / "runs").iterdir()
        assert is_complete(record)
        kept = read_samples(record)
        assert (np.diff(kept["seq"].astype(np.int64)) == 1).all()
        steps = np.diff(kept["wall_ns"]) / 1e9
        assert steps.max() == pytest.approx(HOUR_S, abs=2.0)
        assert steps.min() == pytest.approx(-3.0 * HOUR_S, abs=2.0)
        logged = [message.log_time for topic, message in recover_messages(record) if topic == "/telemetry"]
        assert (np.diff(logged) > 0).all()
        assert (logged[-1] - logged[0]) / 1e9 < 60.0

    asyncio.run(fly())
