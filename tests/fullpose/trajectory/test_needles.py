"""Needles of a flight, against frame paths that run through them and closed forms."""

import numpy as np
import pytest

from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.trajectory.needles import needles
from fullpose.verify import payload_attitudes

RIG = {
    geometry: Rig("r", geometry, (FrameLimits(), FrameLimits(), FrameLimits(), FrameLimits()))
    for geometry in (Geometry.VERTICAL_4, Geometry.HORIZONTAL_4)
}
T = np.arange(1001) / 500.0


def path(middle: np.ndarray, outer: np.ndarray) -> np.ndarray:
    return np.stack([0.4 + 0.8 * T, outer, middle, 0.3 * np.sin(3.0 * T)], axis=1)


@pytest.mark.parametrize("geometry", list(RIG))
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_where_the_middle_frame_crosses_a_right_angle_is_a_needle_at_the_base_angle(
    geometry: Geometry, side: float
) -> None:
    crossing = 0.7712
    x = path(side * (np.pi / 2 + 0.9 * (T - crossing)), np.full_like(T, 1.0))
    found = needles(T, payload_attitudes(RIG[geometry], x), geometry.horizontal)
    assert len(found.time) == 1
    assert found.time[0] == pytest.approx(crossing, abs=1e-9)
    off = (found.base[0] - (0.4 + 0.8 * crossing)) / np.pi
    assert off == pytest.approx(round(off), abs=1e-8)


@pytest.mark.parametrize("geometry", list(RIG))
def test_where_the_outer_frame_crosses_zero_is_one_too_beside_the_path(geometry: Geometry) -> None:
    x = path(np.full_like(T, 0.5), 0.7 * (T - 1.2345))
    found = needles(T, payload_attitudes(RIG[geometry], x), geometry.horizontal)
    assert found.time == pytest.approx([1.2345], abs=1e-9)
    # cos d3 does not vanish there, so the needle is as far from the base as the middle frame is from +-90 deg.
    assert abs(np.sin(found.base[0] - (0.4 + 0.8 * 1.2345))) == pytest.approx(np.cos(0.5), abs=1e-7)


def test_a_touch_counts_once_and_a_flight_that_never_levels_has_none() -> None:
    rig = RIG[Geometry.VERTICAL_4]
    touching = path(np.full_like(T, 0.5), 0.3 * (T - 1.0) ** 2)
    assert needles(T, payload_attitudes(rig, touching), False).time == pytest.approx([1.0], abs=1e-3)
    climbing = path(np.full_like(T, 0.5), 0.3 + 0.1 * T)
    assert len(needles(T, payload_attitudes(rig, climbing), False).time) == 0


def test_a_few_samples_have_none() -> None:
    x = path(np.full_like(T, 0.5), 0.7 * (T - 0.005))[:5]
    assert len(needles(T[:5], payload_attitudes(RIG[Geometry.VERTICAL_4], x), False).time) == 0
