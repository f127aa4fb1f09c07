"""Every command in every state: the committed table is the session's, and a real rig answers as it says."""

from collections.abc import Iterator
from typing import Any

import pytest

from fullpose_server.session.states import Command, State
from fullpose_server.session.table import allowed
from tests.fullpose_server.api.live_server import LiveServer, Operator, live_server
from tools import commands

# Commands that lead there from one to the next, on a rig without a fault; what happens by itself is waited for.
WAY = (
    (State.IDLE, Command.CONNECT),
    (State.READY, Command.LOAD),
    (State.ARMED, Command.ARM),
    (State.RUNNING, Command.START),
    (State.HELD, Command.HOLD),
    (State.ARMED, Command.STOP),
    (State.READY, Command.DISARM),
    (State.ESTOPPED, Command.ESTOP),
)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    with live_server(tmp_path_factory.mktemp("data"), rig_rate_hz=500.0) as live:
        yield live


def test_the_committed_table_is_the_session_s() -> None:
    assert commands.PAGE.read_text("utf-8") == commands.page(), "run: python -m tools.commands"


def test_every_command_that_a_state_refuses_is_refused_and_changes_nothing(server: LiveServer) -> None:
    text = "time_s,yaw_deg,pitch_deg,roll_deg\n" + "".join(f"{k / 10},{k / 20},0,0\n" for k in range(600))
    plan = server.plan(text=text)
    args: dict[Command, dict[str, Any]] = {
        Command.LOAD: {"plan": plan["id"]},
        Command.MOVE: {"target_deg": [0, 0, 0, 0]},
        Command.JOG: {"frame": "inner", "step_deg": 1.0},
    }
    operator = Operator(server)
    operator.take()
    seen = set()
    for target, command in WAY:
        here = State(operator.session()["state"])
        _refuses(operator, here, args)
        seen.add(here)
        answer = operator.command(command, **args.get(command, {}))
        assert answer.status_code == 200, answer.text
        # What follows by itself may have followed: a rig that is held stands, and its stop is over at once.
        assert answer.json()["state_after"] in (commands.cell(command, here), target)
        operator.wait(target)
    _refuses(operator, State.ESTOPPED, args)
    assert seen | {State.ESTOPPED} == {State.DISCONNECTED} | {state for state, _ in WAY}


def _refuses(operator: Operator, state: State, args: dict[Command, dict[str, Any]]) -> None:
    for command in Command:
        if commands.cell(command, state) != "409":
            continue
        operator.lease()
        answer = operator.command(command, **args.get(command, {}))
        assert answer.status_code == 409, (state, command, answer.text)
        problem = answer.json()
        assert (problem["state"], problem["command"]) == (state, command)
        assert problem["allowed"] == list(allowed(state))
        assert operator.session()["state"] == state
