"""The whole loop of a rig with jerk limits on a made-up clock: what is commanded keeps them, what cannot is refused."""

import dataclasses
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import write_plan
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.runtime.contract.telemetry import Flag
from fullpose_server.session.machine import SilencePolicy
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.made_up_rig import MadeUpRig, made_up_rig

RATE = 500.0
JERK_DEG_S3 = 6000.0
_PLAIN = builtin_rigs()["vertical-limited"]
_FRAMES = tuple(dataclasses.replace(frame, max_jerk=np.radians(JERK_DEG_S3)) for frame in _PLAIN.frames)
RIG = dataclasses.replace(_PLAIN, frames=(_FRAMES[0], _FRAMES[1], _FRAMES[2], _FRAMES[3]))


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    config = RigConfig("test", RIG, tmp_path / "rig", tmp_path / "runs", rate_hz=RATE, min_free_mb=0.0)
    config = dataclasses.replace(config, owner=SilencePolicy(0.5, 1.0, 1.5))
    with made_up_rig(config) as made:
        write_plan(tmp_path / "plan", plan_of(RIG, 4.0, RATE))
        made.ready(plan_folder=str(tmp_path / "plan"))
        made.must("arm")
        made.run(0.1)
        yield made


def largest_jerk(rig: MadeUpRig) -> float:
    """Of the commands that were written one tick after the other [deg/s^3]."""
    rows = rig.rows()
    x = rows["demand"]
    together = (rows["flags"] & Flag.ENABLED) != 0
    four = together[3:] & together[2:-1] & together[1:-2] & together[:-3] & (rows["tick"][3:] - rows["tick"][:-3] == 3)
    return float(np.abs(np.diff(x, 3, axis=0)[four]).max() * RATE**3)


def test_moves_a_flight_and_a_stop_keep_the_limit(rig: MadeUpRig) -> None:
    rig.must("move", target_deg=[60.0, -40.0, 30.0, 50.0])
    rig.until(State.ARMED)
    rig.must("jog", frame="outer", step_deg=150.0)
    rig.run(1.1)
    rig.must("stop")
    rig.until(State.ARMED)
    rig.must("start")
    rig.until(State.RUNNING)
    rig.run(2.0)
    rig.must("stop")
    rig.until(State.ARMED)
    assert rig.codes() == []
    assert 0.1 * JERK_DEG_S3 < largest_jerk(rig) <= JERK_DEG_S3 * (1.0 + 1e-6) + 1e-3


def test_an_estop_keeps_it_where_there_is_room(rig: MadeUpRig) -> None:
    rig.must("start")
    rig.until(State.RUNNING)
    rig.run(2.2)
    rig.must("estop")
    rig.run(1.5)
    assert rig.codes() == ["estop"]
    assert largest_jerk(rig) <= JERK_DEG_S3 * (1.0 + 1e-6) + 1e-3


def test_a_hold_is_refused_and_a_silence_stops_the_rig(rig: MadeUpRig) -> None:
    rig.must("start")
    rig.until(State.RUNNING)
    rig.run(1.0)
    refused = rig.say("hold")
    assert refused.error is not None
    assert refused.error.code == "jerk_limits"
    assert rig.state is State.RUNNING
    rig.owner_heard = False
    rig.run(0.7)
    assert rig.state in (State.STOPPING, State.ARMED)
    assert largest_jerk(rig) <= JERK_DEG_S3 * (1.0 + 1e-6) + 1e-3


def test_a_live_source_is_refused(rig: MadeUpRig) -> None:
    rig.must("disarm")
    rig.must("unload")
    for method in ("exact", "preview"):
        refused = rig.say("load", live={"method": method})
        assert refused.error is not None
        assert "does not keep jerk limits" in refused.error.message
