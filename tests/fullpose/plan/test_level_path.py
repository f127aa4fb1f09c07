"""Level flights that have to change from one sheet of their solutions to another."""

import numpy as np
import pytest

from fullpose.plan.level_path import corners, is_level, level_path
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.trajectory.problem import Problem
from fullpose.verify import payload_attitudes, verify
from tests.support.exactly import assert_flown_exactly

DEG = np.pi / 180.0
T = np.arange(2001) / 500.0
GEOMETRIES = [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4]


def step(begin: float, length: float) -> np.ndarray:
    s = np.clip((T - begin) / length, 0.0, 1.0)
    return s**3 * (10.0 + s * (6.0 * s - 15.0))


def rig_of(geometry: Geometry, base: float = 20.0, inner: float = 40.0) -> Rig:
    limits = [(np.inf, 200, base), (np.inf, 250, 800), (np.inf, 300, 1200), (inner, 600, 4000)]
    frames = [FrameLimits(-a * DEG, a * DEG, v * DEG, c * DEG) for a, v, c in limits]
    return Rig("level", geometry, (frames[0], frames[1], frames[2], frames[3]))


def changing(middle: float = 90.0) -> np.ndarray:
    """Upright for two seconds, the middle frame taking the yaw up; then on edge, the outer taking the roll up."""
    x = np.zeros((len(T), 4))
    x[:, 0] = 0.3 + 0.02 * T
    x[:, 2] = DEG * (middle - np.sign(middle) * 60.0 * (1.0 - step(0.2, 1.6)))
    x[:, 1] = 100.0 * DEG * step(2.1, 1.8)
    x[:, 3] = 10.0 * DEG * np.sin(T)
    return x


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("middle", [90.0, -90.0])
def test_a_flight_that_must_change_sheets_is_flown(geometry: Geometry, middle: float) -> None:
    assert_flown_exactly(T, changing(middle), rig_of(geometry))


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_path_is_exact_inside_the_limits_and_starts_where_it_is_told(geometry: Geometry) -> None:
    rig, x = rig_of(geometry), changing()
    C = payload_attitudes(rig, x)
    path = level_path(Problem(T, C, rig, start=x[0]))
    assert path is not None
    found = verify(T, path, rig, C)
    assert not found.violations
    assert found.max_error < 1e-9
    assert np.abs(path[0] - x[0])[[1, 2]].max() < 1e-6


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_every_corner_gives_the_attitude_on_both_of_its_sheets(geometry: Geometry) -> None:
    rig = rig_of(geometry)
    C = payload_attitudes(rig, changing())
    found = list(corners(Problem(T, C, rig)))
    assert len(found) == 4
    for corner in found:
        for u, w in ((0.4, 0.0), (corner.middle, 0.0), (corner.middle, -1.1)):
            d = corner.fixed + corner.slope @ np.array([u, w])
            assert np.abs(payload_attitudes(rig, d) - C).max() < 1e-12


def test_where_no_sheet_has_room_there_is_none() -> None:
    """The roll goes beyond the inner range while the base may not move at all."""
    rig, x = rig_of(Geometry.VERTICAL_4, base=1e-3, inner=5.0), changing()
    x[:, 0] += 2.0 * step(1.0, 2.0)
    assert level_path(Problem(T, payload_attitudes(rig, x), rig)) is None


def test_a_flight_that_pitches_is_not_level() -> None:
    rig, x = rig_of(Geometry.VERTICAL_4), changing()
    assert is_level(Problem(T, payload_attitudes(rig, x), rig))
    x[1000:, 1] += 0.01
    x[1000:, 2] -= 0.5
    assert not is_level(Problem(T, payload_attitudes(rig, x), rig))
