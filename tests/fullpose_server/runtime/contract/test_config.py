"""Settings travel to the rig process as they are."""

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest

from fullpose.rig import FrameLimits, Rig, builtin_rigs
from fullpose_server.runtime.contract.config import (
    GuardConfig,
    LiveConfig,
    MotionConfig,
    OperatingConfig,
    RigConfig,
    Tolerance,
    decode,
    encode,
)
from fullpose_server.session.machine import SilencePolicy


@pytest.mark.parametrize("rig", builtin_rigs().values(), ids=str)
def test_what_is_encoded_is_decoded(rig: Rig) -> None:
    config = RigConfig(
        "bench",
        rig,
        Path("/a"),
        Path("/b"),
        rate_hz=2000.0,
        drive="udp",
        drive_options={"port": 7450, "axes": [1, 2.5, "x", True], "table": {"ratio": 0.1 + 0.2}},
        owner=SilencePolicy(1.0, 2.0, 3.0),
        server=SilencePolicy(0.1, 0.2, 0.3),
        realtime_priority=None,
        cpu=1,
        guard=GuardConfig(following_deg=Tolerance(None, 0.0), max_step_deg=1.0 / 3.0),
        motion=MotionConfig(stop_fraction=1.0),
        min_free_mb=0.0,
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


def test_how_a_rig_is_operated_goes_to_its_process_whole() -> None:
    operating = OperatingConfig(drive="udp", cpu=0, motion=MotionConfig(move_rate_deg_s=1.0))
    config = RigConfig("x", builtin_rigs()["vertical-4"], Path("/a"), Path("/b"), **vars(operating))
    assert {key: getattr(config, key) for key in vars(operating)} == vars(operating)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("name", ""),
        ("exit_idle_s", 0.0),
        ("exit_idle_s", math.nan),
        ("min_free_mb", math.nan),
        ("drive", ""),
        ("cpu", -1),
    ],
)
def test_settings_of_a_process_that_cannot_be_are_named(field: str, value: Any) -> None:
    sound = RigConfig("x", builtin_rigs()["vertical-4"], Path("/a"), Path("/b"))
    with pytest.raises(ValueError, match=f"^{field} = .*expected"):
        dataclasses.replace(sound, **{field: value})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("udp_port", 0),
        ("udp_port", 65536),
        ("udp_host", ""),
        ("delay_ms", -5.0),
        ("delay_ms", math.nan),
        ("extrapolate_ms", 0.0),
        ("extrapolate_ms", math.inf),
    ],
)
def test_settings_of_a_live_source_that_cannot_be_are_named(field: str, value: Any) -> None:
    with pytest.raises(ValueError, match=f"^{field} = .*expected"):
        LiveConfig(**{field: value})


def test_a_file_with_a_value_that_cannot_be_is_refused() -> None:
    data = encode(RigConfig("x", builtin_rigs()["vertical-4"], Path("/a"), Path("/b")))
    with pytest.raises(ValueError, match=r"stop_fraction = 0\.0: expected"):
        decode(data.replace(b'"stop_fraction": 0.8', b'"stop_fraction": 0.0'))
