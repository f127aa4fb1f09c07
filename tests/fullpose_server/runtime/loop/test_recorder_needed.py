"""No run without its record: arming asks for a recorder that runs, and one that has ended is replaced soon."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.formats.plan_folder import write_plan
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.loop.test_control_loop import RATE, RIG, config_of
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.made_up_rig import MadeUpRig, made_up_rig


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    write_plan(tmp_path / "plan", plan_of(RIG, 1.0, RATE))
    with made_up_rig(config_of(tmp_path)) as made:
        made.ready(plan_folder=str(tmp_path / "plan"))
        made.run(1.0)
        yield made


@pytest.fixture
def nobody() -> int:
    """The number of a process that has ended."""
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    return process.pid


def restarts(rig: MadeUpRig) -> int:
    return sum(event["kind"] == "recorder_restarted" for event in rig.shared.events_since(0)[0])


def test_one_that_was_killed_a_moment_ago_bars_arming_though_it_was_heard_just_now(rig: MadeUpRig, nobody: int) -> None:
    rig.recorder.pid = nobody
    rig.tick()
    refused = rig.say("arm")
    assert refused.error is not None
    assert refused.error.code == "no_record"
    assert rig.state is State.READY


def test_it_is_replaced_within_a_second_at_rest_and_arming_goes_on(rig: MadeUpRig, nobody: int) -> None:
    rig.recorder.pid = nobody
    rig.run(1.0)
    assert restarts(rig) == 1
    rig.must("arm")


def test_in_motion_it_is_not_replaced(rig: MadeUpRig, nobody: int) -> None:
    rig.must("arm")
    rig.run(0.1)
    rig.must("start")
    rig.until(State.RUNNING)
    rig.recorder.pid = nobody
    rig.run(0.5)
    assert (rig.state, restarts(rig)) == (State.RUNNING, 0)
    rig.until(State.ARMED)
    assert restarts(rig) == 0
    rig.must("disarm")
    rig.run(1.0)
    assert restarts(rig) == 1
