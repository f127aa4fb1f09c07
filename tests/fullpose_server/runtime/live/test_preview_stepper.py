"""A live source flown by `preview` on a made-up clock; its planner is a real process, and is waited for."""

import dataclasses
import select
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fullpose.rig import builtin_rigs
from fullpose_server.runtime.contract.config import LiveConfig, RigConfig
from fullpose_server.runtime.live import preview_stepper
from fullpose_server.runtime.live.packets import Kind, LiveStatus, decode_reply, encode_sample
from fullpose_server.session.states import State
from tests.fullpose_server.runtime.live.swing import angle_deg, flight
from tests.fullpose_server.runtime.rigs import within_limits
from tests.support.made_up_rig import MadeUpRig, made_up_rig

RIG = builtin_rigs()["vertical-limited"]
PREVIEW_S = 0.4
DELAY_S = 0.02
PATIENCE_S = 120.0


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[MadeUpRig]:
    config = RigConfig("test", RIG, tmp_path / "rig", tmp_path / "runs", rate_hz=500.0, min_free_mb=0.0)
    with made_up_rig(dataclasses.replace(config, live=LiveConfig(delay_ms=1e3 * DELAY_S))) as made:
        yield made
        made.parts.live.close()


@pytest.mark.parametrize(
    ("options", "word"),
    [({"preview_s": 3.0}, "preview_s"), ({"beam": 0}, "beam"), ({"beam": "x"}, "beam"), ({"way": 1}, "way")],
)
def test_options_that_cannot_be_flown_are_named(rig: MadeUpRig, options: dict[str, Any], word: str) -> None:
    rig.take()
    rig.tick()
    rig.must("connect")
    refused = rig.say("load", live={"method": "preview", "options": options})
    assert refused.error is not None
    assert word in refused.error.message


def swing(k: int, t: float) -> bytes:
    q, rate = flight(t)
    return encode_sample(Kind.QUATERNION, k, t, tuple(q), tuple(np.degrees(rate)))


def test_what_is_told_ahead_is_flown_exactly_when_it_is_due(rig: MadeUpRig) -> None:
    rig.source = swing
    rig.ready(live={"method": "preview", "options": {"preview_s": PREVIEW_S}})
    rig.must("arm")
    rig.run(0.1)
    rig.must("go_live")
    planner = rig.parts.live._step._planner  # type: ignore[union-attr]
    for _ in range(2000):
        rig.tick()
        if planner.busy:
            assert select.select([planner], [], [], PATIENCE_S)[0]
    assert rig.state is State.LIVE, rig.codes()
    assert rig.codes() == []
    heard = rig.parts.live.health()
    assert heard is not None
    assert heard.way_age_ms is not None
    assert heard.way_age_ms < 200.0
    replies = [decode_reply(data) for data, _ in rig.link.replies]
    settled = [reply for reply in replies if reply is not None][-1500:]
    assert {reply.status for reply in settled} == {LiveStatus.FOLLOWED}
    assert max(reply.error_deg for reply in settled) <= 1e-9
    behind = DELAY_S + PREVIEW_S
    for reply in settled[::50]:
        # Behind the sample by what it is told ahead, to a tick.
        early, late = (flight(max(0.0, reply.time_s - behind - slack))[0] for slack in (-0.004, 0.004))
        now = flight(reply.time_s)[0]
        low, high = sorted((angle_deg(now, early), angle_deg(now, late)))
        assert low - 0.05 <= reply.lag_deg <= high + 0.05
    rig.source_heard = False
    rig.until(State.ARMED)
    within_limits(rig.rows(), rig)


def test_a_planner_that_does_not_start_holds_up_no_load_and_costs_foresight_alone(
    rig: MadeUpRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preview_stepper.sys, "executable", "false")  # a program that ends at once
    rig.source = swing
    rig.ready(live={"method": "preview"})
    rig.must("arm")
    rig.run(0.1)
    rig.must("go_live")
    rig.run(2.0)
    assert rig.state is State.LIVE
    assert rig.codes() == ["preview_late"]
    settled = [decode_reply(data) for data, _ in rig.link.replies][-500:]
    assert {(reply.status, reply.error_deg <= 1e-9) for reply in settled if reply} == {(LiveStatus.FOLLOWED, True)}
