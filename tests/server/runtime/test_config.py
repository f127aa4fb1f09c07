"""Settings travel to the rig process as they are."""

import dataclasses
import math
from pathlib import Path

import pytest

from server.runtime.config import GuardConfig, LiveConfig, RigConfig, Tolerance, decode, encode
from server.session.machine import SilencePolicy
from solver.rig import FrameLimits, Rig, builtin_rigs


@pytest.mark.parametrize("rig", builtin_rigs().values(), ids=str)
def test_what_is_encoded_is_decoded(rig: Rig) -> None:
    config = RigConfig(
        "bench",
        rig,
        Path("/a"),
        Path("/b"),
        rate_hz=2000.0,
        drive="udp",
        drive_options={"port": 7450},
        owner=SilencePolicy(1.0, 2.0, 3.0),
        realtime_priority=None,
        guard=GuardConfig(following_deg=Tolerance(None, 0.0)),
        live=LiveConfig(udp_port=7460),
    )
    assert decode(encode(config)) == config


def test_limits_survive_to_the_last_bit_and_infinity_too() -> None:
    frame = FrameLimits(-1.0 / 3.0, math.pi / 7.0, math.inf, 0.1 + 0.2)
    rig = dataclasses.replace(builtin_rigs()["vertical-4"], frames=(frame,) * 4)
    again = decode(encode(RigConfig("x", rig, Path("/a"), Path("/b")))).rig
    assert again == rig


@pytest.mark.parametrize("rate_hz", [0.0, 99.0, 4001.0, math.nan])
def test_rates_that_no_loop_keeps_are_refused(rate_hz: float) -> None:
    with pytest.raises(ValueError, match="rate_hz"):
        RigConfig("x", builtin_rigs()["vertical-4"], Path("/a"), Path("/b"), rate_hz=rate_hz)
