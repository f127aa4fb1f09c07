"""Jerk limits: what the samples of a curve say of its jerk, who keeps them, and who refuses."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from fullpose.errors import MethodError
from fullpose.rig import FRAMES, Limit, Rig, builtin_rigs, without_jerk_limits
from fullpose.solve import solve
from fullpose.verify import differences, jerks, verify
from tests.fullpose.plan.test_plan import flight

RIG = builtin_rigs()["vertical-4"]


def with_jerk(rig: Rig, jerk: float) -> Rig:
    """The rig with that jerk limit of every frame [rad/s^3]."""
    base, outer, middle, inner = (replace(frame, max_jerk=jerk) for frame in rig.frames)
    return replace(rig, frames=(base, outer, middle, inner))


@given(
    st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=7),
    st.lists(st.floats(0.01, 0.3), min_size=4, max_size=20),
)
def test_samples_show_no_more_jerk_than_the_curve_has(coefficients: list[float], steps: list[float]) -> None:
    """However they are spaced; the oracle is the polynomial's own third derivative."""
    time = np.cumsum(steps)
    curve = Polynomial(coefficients)
    _, acceleration = differences(time, np.tile(curve(time)[:, None], 4))
    fine = np.abs(curve.deriv(3)(np.linspace(time[0], time[-1], 20_001))).max()
    assert np.abs(jerks(time, acceleration)).max() <= fine * (1.0 + 1e-3) + 1e-3


def test_the_check_names_a_jerk_beyond_its_limit() -> None:
    time = np.arange(200) * 0.01
    angles = np.zeros((200, 4))
    angles[100:, 2] = 0.5 * 2.0 * (time[100:] - time[100]) ** 3  # a jerk of 6 rad/s^3 from there on
    inside = verify(time, angles, with_jerk(RIG, 6.001))
    assert inside.peaks[2, 3] == pytest.approx(6.0)
    assert [v.limit for v in inside.violations if v.limit is Limit.JERK] == []
    (found,) = (v for v in verify(time, angles, with_jerk(RIG, 5.9)).violations if v.limit is Limit.JERK)
    assert (found.frame, found.value) == (FRAMES[2], pytest.approx(6.0))


def test_rounding_is_no_jerk() -> None:
    time = np.arange(2000) / 2000.0
    angles = np.tile((1.0 + 0.1 * time)[:, None], 4)
    assert verify(time, angles, with_jerk(RIG, 1e-9)).violations == ()


@pytest.mark.parametrize("method", ["exact", "alm", "clamped", "preview"])
def test_a_step_method_that_claims_limits_refuses_a_rig_with_jerk_limits(method: str) -> None:
    time, attitude = flight(duration=1.0)
    with pytest.raises(MethodError, match="does not keep jerk limits"):
        solve(time, attitude, with_jerk(RIG, math.radians(5000.0)), method)
    solve(time, attitude, without_jerk_limits(with_jerk(RIG, 1.0)), method)


def test_a_rig_without_the_key_is_itself_without_them() -> None:
    assert without_jerk_limits(RIG) is RIG
