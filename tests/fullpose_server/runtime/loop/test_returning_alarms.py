"""A condition that returns is said again, acknowledged or not; one that stays is said once."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from fullpose_server.session.states import State
from tests.fullpose_server.runtime.loop.test_control_loop import config_of
from tests.support.made_up_rig import MadeUpRig, level, made_up_rig


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    with made_up_rig(config_of(tmp_path)) as made:
        made.ready(live={"method": "exact"})
        made.must("arm")
        made.run(0.1)
        yield made


@pytest.mark.parametrize("seen", [False, True])
def test_every_loss_of_the_source_is_said(rig: MadeUpRig, seen: bool) -> None:
    for losses in (1, 2, 3):
        rig.source_heard = True
        rig.must("go_live")
        rig.run(1.5)
        assert rig.state is State.LIVE, rig.codes()
        rig.source_heard = False
        rig.until(State.ARMED)
        alarms = [a for a in rig.parts.machine.alarms.history if a.code == "live_source_lost"]
        assert sum(a.count for a in alarms) == losses
        assert len(alarms) == (losses if seen else 1)
        if seen:
            rig.must("acknowledge")
            assert not any(a.code == "live_source_lost" for a in rig.parts.machine.alarms.standing)
        elif losses > 1:
            assert alarms[0].last_time_s is not None
            assert alarms[0].last_time_s > alarms[0].time_s


def test_a_condition_that_stays_is_said_once(rig: MadeUpRig) -> None:
    rig.must("go_live")
    rig.source = lambda k, t: level(k, t) if k < 100 else b"none"  # 400 ticks of a datagram that is no sample
    for k in range(600):
        rig.link.waiting.append((b"no sample", "source"))
        rig.source_heard = True
        rig.source = level
        rig.tick()
        assert k < 1 or sum(a.count for a in rig.parts.machine.alarms.history if a.code == "live_bad") == 1
    rig.run(2.0)
    rig.link.waiting.append((b"no sample", "source"))
    rig.run(0.1)
    assert sum(a.count for a in rig.parts.machine.alarms.history if a.code == "live_bad") == 2


def lose_the_source(rig: MadeUpRig) -> None:
    rig.source_heard = True
    rig.must("go_live")
    rig.run(1.5)
    rig.source_heard = False
    rig.until(State.ARMED)


def standing(rig: MadeUpRig) -> set[str]:
    return {alarm.code for alarm in rig.parts.machine.alarms.standing}


def test_a_shelved_warning_does_not_stand_until_its_time_is_over(rig: MadeUpRig) -> None:
    for code in ("live_source_lost", "live_source_stale"):
        rig.must("shelve", code=code, minutes=0.1, reason="the host is being repaired")
    lose_the_source(rig)  # and the rig has braked all the same
    assert standing(rig) == set()
    assert {a.code for a in rig.parts.machine.alarms.history if a.shelved} >= {"live_source_lost"}
    shelf = rig.parts.machine.alarms.shelves[0]
    assert (shelf.by, shelf.reason) == ("anna", "the host is being repaired")
    rig.run(6.5)
    lose_the_source(rig)
    assert "live_source_lost" in standing(rig)
    assert rig.parts.machine.alarms.shelves == ()


def test_a_shelf_is_taken_away(rig: MadeUpRig) -> None:
    rig.must("shelve", code="live_source_lost", minutes=60)
    rig.must("unshelve", code="live_source_lost")
    lose_the_source(rig)
    assert "live_source_lost" in standing(rig)


@pytest.mark.parametrize(
    ("args", "told"),
    [
        ({}, "expected that of a warning, one of following_error"),
        ({"code": "live_source_losst"}, "'live_source_losst': expected that of a warning"),
        ({"code": "drive_fault"}, "'drive_fault': expected that of a warning"),
        ({"code": "lateness", "frame": "middle-left"}, "frame must be one of base"),
        ({"code": "lateness", "minutes": 1e9}, "expected above 0"),
        ({"code": "lateness", "minutes": "long"}, "minutes = 'long'"),
    ],
)
def test_a_shelf_that_cannot_be_changes_nothing(rig: MadeUpRig, args: dict[str, object], told: str) -> None:
    before = rig.parts.machine.alarms
    reply = rig.say("shelve", **args)
    assert not reply.ok
    assert reply.error is not None
    assert told in reply.error.message
    assert rig.parts.machine.alarms is before


def test_a_clock_that_is_set_back_prolongs_no_shelf(rig: MadeUpRig) -> None:
    rig.must("shelve", code="live_source_lost", minutes=0.1)
    rig.clock.set_by = -3_600_000_000_000
    rig.run(6.5)
    lose_the_source(rig)
    assert "live_source_lost" in standing(rig)
