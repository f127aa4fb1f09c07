"""How a rig is operated: what cannot be is refused, and named."""

import math
from dataclasses import fields
from typing import Any

import pytest

from fullpose_server.operating import ConfigError, GuardConfig, MotionConfig, OperatingConfig, Tolerance
from fullpose_server.session.machine import SilencePolicy

NO_NUMBERS = (math.nan, math.inf, -1.0)


@pytest.mark.parametrize("name", [field.name for field in fields(MotionConfig)])
@pytest.mark.parametrize("value", [0.0, *NO_NUMBERS])
def test_motions_need_finite_numbers_above_zero(name: str, value: float) -> None:
    with pytest.raises(ConfigError) as caught:
        MotionConfig(**{name: value})
    assert (caught.value.field, repr(caught.value.value)) == (name, repr(value))
    assert str(caught.value).startswith(f"{name} = {value!r}: expected ")


def test_a_stop_takes_at_most_all_of_a_limit() -> None:
    assert MotionConfig(stop_fraction=1.0).stop_fraction == 1.0
    with pytest.raises(ConfigError, match="stop_fraction"):
        MotionConfig(stop_fraction=1.01)


@pytest.mark.parametrize("name", ["warn", "trip"])
@pytest.mark.parametrize("value", NO_NUMBERS)
def test_levels_are_finite_and_none_is_below_zero(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"^{name} = .*zero or more"):
        Tolerance(**({"warn": None, "trip": None} | {name: value}))


def test_no_level_warns_after_it_has_tripped() -> None:
    assert Tolerance(0.0, 0.0).trip == 0.0
    with pytest.raises(ConfigError, match="at most trip"):
        Tolerance(3.0, 1.0)


@pytest.mark.parametrize("value", NO_NUMBERS)
def test_a_step_is_finite(value: float) -> None:
    assert GuardConfig(max_step_deg=0.0).max_step_deg == 0.0
    with pytest.raises(ConfigError, match="max_step_deg"):
        GuardConfig(max_step_deg=value)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("drive", ""),
        ("owner", SilencePolicy(1.0, 2.0, math.inf)),
        ("server", SilencePolicy(1.0, 2.0, math.inf)),
        ("realtime_priority", 0),
        ("realtime_priority", 100),
        ("cpu", -1),
        ("min_free_mb", -1.0),
        ("min_free_mb", math.nan),
        ("min_free_mb", math.inf),
    ],
)
def test_what_else_cannot_be(field: str, value: Any) -> None:
    with pytest.raises(ConfigError) as caught:
        OperatingConfig(**{field: value})
    assert caught.value.field == field
