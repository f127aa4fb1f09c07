"""The loop's rules on a made-up clock: every row of the table is driven, a minute of flight takes no minute."""

import dataclasses
from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.formats.plan_folder import write_plan
from fullpose_server.runtime.contract.config import RigConfig
from fullpose_server.session.machine import SilencePolicy
from fullpose_server.session.states import Command, Event, State
from fullpose_server.session.table import TABLE, Transition, When
from tests.fullpose_server.runtime.rigs import plan_of
from tests.support.made_up_rig import MadeUpRig, made_up_rig

S, C, V = State, Command, Event
RATE = 500.0  # [Hz] of the loop; its rules know no rate
RIG = builtin_rigs()["vertical-limited"]
SILENCE = SilencePolicy(0.5, 1.0, 1.5)


@pytest.fixture(scope="session")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("plans") / "plan"
    write_plan(folder, plan_of(RIG, 4.0, RATE))
    return folder


def config_of(folder: Path) -> RigConfig:
    config = RigConfig("test", RIG, folder / "rig", folder / "runs", rate_hz=RATE, min_free_mb=0.0)
    return dataclasses.replace(config, owner=SILENCE, server=SILENCE)


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    with made_up_rig(config_of(tmp_path)) as made:
        yield made


def armed(rig: MadeUpRig, plan: Path | None) -> None:
    rig.ready(**({"live": {"method": "exact"}} if plan is None else {"plan_folder": str(plan)}))
    rig.must("arm")
    rig.run(0.1)
    assert rig.state is S.ARMED, rig.codes()


def bring(rig: MadeUpRig, state: State, plan: Path, when: When = When.ALWAYS) -> None:
    """The session from its beginning to `state`, the way an operator goes."""
    if state is S.DISCONNECTED:
        rig.take()
        rig.tick()
        return
    if state in (S.IDLE, S.READY):
        rig.take()
        rig.tick()
        rig.must("connect")
        if state is S.READY:
            rig.must("load", plan_folder=str(plan))
        rig.run(0.1)
        return
    armed(rig, None if state is S.LIVE else plan)
    if state is S.ARMED:
        return
    if state is S.LIVE:
        rig.must("go_live")
        rig.run(0.3)
    elif state is S.POSITIONING and when is When.MOVE:
        rig.must("jog", frame="outer", step_deg=150.0)
        rig.run(0.2)
    elif state is S.POSITIONING:
        rig.must("jog", frame="outer", step_deg=150.0)
        rig.until(S.ARMED)
        rig.must("start")
        rig.run(0.2)
    else:
        rig.must("start")
        rig.until(S.RUNNING)
        rig.run(1.5)
        if state is S.HELD:
            rig.must("hold")
            rig.run(0.1)
        elif state is S.STOPPING:
            rig.must("stop")
            rig.tick()
        elif state is S.ESTOPPED:
            rig.must("estop")
        elif state is S.FAULTED:
            rig.drive.brake()  # behind the loop's back
            rig.until(S.FAULTED)
    assert rig.state is state, rig.codes()


def cause(rig: MadeUpRig, row: Transition, plan: Path) -> None:
    """Make the row's trigger come about by what really brings it: a command, the motion, silence, the drive."""
    match row.trigger:
        case C.LOAD:
            rig.must("load", plan_folder=str(plan))
        case C.MOVE | C.JOG:
            where = {"target_deg": [0.0, 5.0, 5.0, 5.0]} if row.trigger is C.MOVE else {"step_deg": [5.0] * 4}
            rig.must(str(row.trigger), **where)
        case C.GO_LIVE:
            rig.must("disarm")
            rig.must("unload")
            rig.must("load", live={"method": "exact"})
            rig.must("arm")
            rig.run(0.1)
            rig.must("go_live")
        case C.RESET:
            rig.run(3.0)  # to rest
            if row.when is When.UNLINKED:
                rig.drive.close()
                rig.tick()
            rig.must("acknowledge")
            rig.must("reset")
        case Command():
            rig.must(str(row.trigger))
        case V.SILENT_STOP if rig.state is S.RUNNING:
            rig.server_heard = False  # and the owner, who is there, resumes all the same
            rig.until(S.HELD)
            rig.must("resume")
        case V.SILENT_HOLD | V.SILENT_STOP | V.SILENT_DISARM:
            rig.owner_heard = False
        case V.SOURCE_LOST:
            rig.source_heard = False
        case V.LINK_LOST:
            rig.drive.close()
        case V.FAULT if rig.parts.state.enabled:
            rig.drive.brake()  # it lets go, unasked
        case V.FAULT:
            for _ in range(round(0.3 * RATE)):
                rig.drive.enable()  # it follows, unasked
                rig.tick()
        case Event():
            pass  # comes by itself


# Silence comes in stages: a live flight is stopped by the first, before the second is due.
EARLIER: dict[tuple[State, Command | Event], Event] = {(S.LIVE, V.SILENT_STOP): V.SILENT_HOLD}


def happened(rig: MadeUpRig) -> list[tuple[str, str, str]]:
    """Every change of state so far, as the log tells it: from, by what, to."""
    events, _ = rig.shared.events_since(0)
    told = [e for e in events if e["kind"] in ("transition", "command") and not e.get("refused")]
    return [(e["before"], e.get("trigger") or e["command"], e["after"]) for e in told]


ROWS = [(row, source) for row in TABLE for source in State if source in row.sources]


@pytest.mark.parametrize(
    ("row", "source"), ROWS, ids=[f"{source}, {row.trigger}, {row.when or 'always'}" for row, source in ROWS]
)
def test_every_row_of_the_table_happens_in_the_loop(rig: MadeUpRig, plan: Path, row: Transition, source: State) -> None:
    late_hold = row.trigger is V.END and source is S.HELD
    bring(rig, S.RUNNING if late_hold else source, plan, row.when)
    if late_hold:
        while rig.parts.motion.path_time_s < 4.98:
            rig.tick()
        rig.must("hold")
    cause(rig, row, plan)
    expected = (source, EARLIER.get((source, row.trigger), row.trigger), row.target)
    for _ in range(round(20.0 * RATE)):
        if expected in happened(rig):
            break
        rig.tick()
    assert expected in happened(rig)
    if row.target in (S.ESTOPPED, S.FAULTED):
        rig.run(3.0)
        assert rig.state is row.target
        assert rig.speed() < 1e-3
        assert not rig.parts.state.enabled
        assert not rig.parts.machine.moving


def test_a_minute_of_flight_takes_no_minute_of_waiting(rig: MadeUpRig, tmp_path: Path) -> None:
    write_plan(tmp_path / "long", plan_of(RIG, 60.0, RATE))
    armed(rig, tmp_path / "long")
    begun = rig.clock.now
    rig.must("start")
    rig.until(S.RUNNING)
    rig.until(S.ARMED, within_s=70.0)
    assert rig.clock.now - begun > 60e9
    assert rig.codes() == []
    assert rig.parts.state.run_id is None
    assert int(rig.shared.header["misses"][0]) == 0


def test_a_hold_stands_on_the_path_and_goes_on_from_there(rig: MadeUpRig, plan: Path) -> None:
    bring(rig, S.HELD, plan)
    rig.run(3.0)
    at = rig.parts.motion.path_time_s
    assert rig.parts.motion.path_scale == 0.0
    rig.run(1.0)
    assert rig.parts.motion.path_time_s == at
    rig.must("resume")
    rig.until(S.ARMED)
    assert rig.codes() == []


@pytest.mark.parametrize("who", ["owner", "server"])
def test_a_silent_owner_and_a_silent_server_are_held_stopped_and_disarmed(rig: MadeUpRig, plan: Path, who: str) -> None:
    bring(rig, S.RUNNING, plan)
    rig.owner_heard, rig.server_heard = who != "owner", who != "server"
    seen = [rig.state]
    for _ in range(round(3.0 * RATE)):
        rig.tick()
        if rig.state is not seen[-1]:
            seen.append(rig.state)
    assert seen == [S.RUNNING, S.HELD, S.STOPPING, S.ARMED, S.READY]
    assert set(rig.codes()) == {f"{who}_silent"}


def test_missed_deadlines_trip_and_brake(rig: MadeUpRig, plan: Path) -> None:
    bring(rig, S.RUNNING, plan)
    rig.missed = 4
    rig.until(S.FAULTED, within_s=5.0)
    rig.missed = 0
    assert "missed_deadlines" in rig.codes()
    rig.run(3.0)
    assert rig.speed() < 1e-3
    assert int(rig.shared.header["misses"][0]) > 0


def test_an_illegal_command_changes_nothing(rig: MadeUpRig, plan: Path) -> None:
    bring(rig, S.RUNNING, plan)
    before = rig.parts.machine.state, rig.parts.machine.revision, rig.parts.motion.mode, rig.parts.state.plan
    for command, args in (("load", {"plan_folder": str(plan)}), ("arm", {}), ("move", {"target_deg": [0.0] * 4})):
        reply = rig.say(command, **args)
        assert reply.error is not None
        assert reply.error.code == "illegal_command"
    motion = rig.parts.motion
    assert (rig.parts.machine.state, rig.parts.machine.revision, motion.mode, rig.parts.state.plan) == before
