"""How a run ended is told with it, and the sample of what ended it is in it."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from fullpose_server.formats.plan_folder import write_plan
from fullpose_server.session.run_end import Ending, RunEnd
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.loop.test_control_loop import RATE, RIG, config_of
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.made_up_rig import MadeUpRig, made_up_rig


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    write_plan(tmp_path / "plan", plan_of(RIG, 4.0, RATE))
    with made_up_rig(config_of(tmp_path)) as made:
        made.ready(plan_folder=str(tmp_path / "plan"))
        made.must("arm")
        made.run(0.1)
        made.must("start")
        made.until(State.RUNNING)
        made.run(1.0)
        yield made


def end_of(rig: MadeUpRig) -> dict[str, Any]:
    """What is told with the run's end, once it has ended."""
    for _ in range(round(20.0 * RATE)):
        found = [e for e in rig.shared.events_since(0)[0] if e["kind"] == "run_end"]
        if found:
            (end,) = found
            return end
        rig.tick()
    raise AssertionError(f"the run does not end: {rig.state}, {rig.codes()}")


def broken(rig: MadeUpRig) -> None:
    """Every read raises."""

    def raises(*_: object) -> int:
        raise OSError(5, "gone")

    rig.drive.read = raises  # type: ignore[method-assign]


def silent_owner(rig: MadeUpRig) -> None:
    rig.owner_heard = False


def silent_server(rig: MadeUpRig) -> None:
    rig.server_heard = False


@pytest.mark.parametrize(
    ("cause", "how", "code"),
    [
        (MadeUpRig.tick, "completed", None),
        (lambda rig: rig.must("stop"), "stopped", None),
        (lambda rig: rig.must("estop"), "estop", "estop"),
        (lambda rig: rig.drive.brake(), "fault", "drive_not_enabled"),
        (broken, "fault", "drive_failed"),
        (lambda rig: rig.drive.close(), "link_lost", "link_lost"),
        (silent_owner, "owner_silent", "owner_silent"),
        (silent_server, "server_silent", "server_silent"),
    ],
    ids=["completed", "stop", "estop", "lets go", "raises", "link", "owner", "server"],
)
def test_a_run_tells_how_it_ended(rig: MadeUpRig, cause: Callable[[MadeUpRig], None], how: str, code: str) -> None:
    cause(rig)
    end = end_of(rig)
    assert (end["how"], end.get("code")) == (how, code)
    last = rig.shared.ring.since(int(end["head"]) - 1, 1)[0]
    assert State(end["state"]).code == last["state"][0]  # the sample in which it ended is the record's last


def test_a_fault_on_the_way_to_rest_counts_and_the_first_of_two(rig: MadeUpRig) -> None:
    rig.must("stop")
    rig.run(0.05)
    rig.must("estop")
    assert end_of(rig)["how"] == "estop"
    fault = Ending(RunEnd.FAULT, "a")
    assert Ending(RunEnd.ESTOP).after(fault) is fault
    assert Ending(RunEnd.STOPPED).after(fault) is fault


def test_a_fault_that_nobody_has_acknowledged_bars_arming(rig: MadeUpRig, tmp_path: Path) -> None:
    rig.drive.close()
    rig.until(State.DISCONNECTED)
    rig.must("connect")
    rig.tick()
    rig.must("load", plan_folder=str(tmp_path / "plan"))
    refused = rig.say("arm")
    assert refused.error is not None
    assert refused.error.code == "standing_fault"
    assert "link_lost" in refused.error.message
    assert rig.state is State.READY
    rig.must("acknowledge")
    rig.must("arm")
    assert rig.state is State.ARMED
