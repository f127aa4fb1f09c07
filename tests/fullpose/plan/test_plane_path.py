"""The search in the plane of time and base angle, on flights that are flyable by construction."""

import numpy as np
import pytest

from fullpose._typing import Array, Progress
from fullpose.flyable import flyable_path, rig_of
from fullpose.plan.plane_path import PlaneBreadth, plane_path
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.trajectory.frame_chart import INNER, MIDDLE, OUTER
from fullpose.trajectory.needles import Needles, needles
from fullpose.trajectory.problem import Problem
from fullpose.verify import payload_attitudes, verify
from tests.support.exactly import assert_flown_exactly

DEG = np.pi / 180.0
GEOMETRIES = [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4]
QUICK = PlaneBreadth(1000, 1.0, 1.0)
INF = np.inf


def needles_of(problem: Problem) -> Needles:
    return needles(problem.time, problem.attitude, problem.rig.geometry.horizontal)


def searched(problem: Problem, breadth: PlaneBreadth = QUICK, progress: Progress | None = None) -> Array | None:
    return plane_path(problem, needles_of(problem), breadth, progress)


def needle_flight(geometry: Geometry, slow: float) -> tuple[Rig, np.ndarray, np.ndarray]:
    """A slow base, and a middle frame that goes through a right angle three times."""
    limits = [(INF, 200, slow), (INF, 250, 800), (INF, 300, 1200), (60, 600, 4000)]
    frames = [FrameLimits(-a * DEG, a * DEG, v * DEG, c * DEG) for a, v, c in limits]
    rig = Rig("needles", geometry, (frames[0], frames[1], frames[2], frames[3]))
    t = np.arange(3001) / 500.0
    x = np.stack(
        [
            0.5 * slow * DEG * np.sin(t) + 0.7, 50.0 * DEG + 20.0 * DEG * np.sin(1.3 * t),
            np.pi / 2 + 35.0 * DEG * np.sin(1.7 * t + 0.4), 40.0 * DEG * np.sin(2.1 * t),
        ],
        axis=1,
    )  # fmt: skip
    assert not verify(t, x, rig).violations
    return rig, t, x


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("slow", [3.0, 20.0])
def test_a_flight_through_needles_with_a_slow_base_is_flown(geometry: Geometry, slow: float) -> None:
    rig, t, x = needle_flight(geometry, slow)
    assert_flown_exactly(t, x, rig)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_path_is_exact_and_continuous_and_starts_where_it_is_told(geometry: Geometry) -> None:
    rig, t, x = needle_flight(geometry, 20.0)
    C = payload_attitudes(rig, x)
    path = searched(Problem(t, C, rig, start=x[0]))
    assert path is not None
    assert np.abs(path[0] - x[0]).max() < 1e-6
    assert verify(t, path, rig, C).max_error < 1e-9
    assert np.abs(np.diff(path, axis=0)).max() < 0.1


def gated_flight(geometry: Geometry, frame: int) -> tuple[Rig, np.ndarray, np.ndarray]:
    """A slow outer or middle frame, the other of the two going to and fro through where it must be met exactly."""
    limits = [(INF, 200, 500), (INF, 250, 800), (INF, 300, 1200), (60, 600, 4000)]
    limits[frame] = (INF, 250, 5)
    frames = [FrameLimits(-a * DEG, a * DEG, v * DEG, c * DEG) for a, v, c in limits]
    rig = Rig("gates", geometry, (frames[0], frames[1], frames[2], frames[3]))
    t = np.arange(2001) / 500.0
    still, moving = 50.0 * DEG + 1.5 * DEG * np.sin(1.6 * t), 60.0 * DEG * np.sin(2.2 * t + 0.4)
    outer, middle = (still, moving) if frame == OUTER else (0.5 * np.pi + moving, still)
    return rig, t, np.stack([0.7 * np.sin(1.2 * t), outer, middle, 40.0 * DEG * np.sin(1.7 * t)], axis=1)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("frame", [OUTER, MIDDLE])
def test_a_flight_with_a_slow_outer_or_middle_frame_is_flown(geometry: Geometry, frame: int) -> None:
    rig, t, x = gated_flight(geometry, frame)
    assert_flown_exactly(t, x, rig)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("frame", [OUTER, MIDDLE, INNER])
def test_in_every_frames_plane_the_path_is_exact_and_continuous(geometry: Geometry, frame: int) -> None:
    rig, t, x = gated_flight(geometry, OUTER if frame == INNER else frame)
    C = payload_attitudes(rig, x)
    path = searched(Problem(t, C, rig, start=x[0]), PlaneBreadth(300, 1.0, 1.0, frame=frame))
    assert path is not None
    assert np.abs(path[0] - x[0]).max() < 1e-6
    assert verify(t, path, rig, C).max_error < 1e-9
    assert np.abs(np.diff(path, axis=0)).max() < 0.1


def test_a_slow_middle_frame_is_led() -> None:
    rig = rig_of("free", Geometry.VERTICAL_4)
    frames = list(rig.frames)
    frames[2] = FrameLimits(-INF, INF, 300 * DEG, 5 * DEG)
    rig = Rig("slow middle", rig.geometry, (frames[0], frames[1], frames[2], frames[3]))
    t, x = flyable_path(2, rig, 0.5, 6.0, 500.0)
    assert_flown_exactly(t, x, rig)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_a_path_that_must_stand_on_the_end_of_a_range_is_flown(geometry: Geometry) -> None:
    """Pitch reaches exactly what the outer frame's range lets it."""
    limit = 70.0 * DEG
    frames = [FrameLimits(-INF, INF, 200 * DEG, 500 * DEG), FrameLimits(-limit, limit, 250 * DEG, 800 * DEG)]
    frames += [FrameLimits(-INF, INF, 300 * DEG, 1200 * DEG), FrameLimits(-INF, INF, 600 * DEG, 4000 * DEG)]
    rig = Rig("ride", geometry, (frames[0], frames[1], frames[2], frames[3]))
    t = np.arange(2001) / 500.0
    x = np.stack([0.6 * np.sin(t), np.full_like(t, limit), 0.5 * np.sin(1.4 * t + 0.3), 0.4 * np.sin(2.0 * t)], axis=1)
    assert_flown_exactly(t, x, rig)


def test_a_flight_that_is_exactly_level_has_an_exact_path_too() -> None:
    rig = rig_of("free", Geometry.VERTICAL_4)
    t = np.arange(501) / 500.0
    x = np.stack([0.3 * t, 0.0 * t, 0.2 * t, 0.5 * t], axis=1)
    path = searched(Problem(t, payload_attitudes(rig, x), rig))
    assert path is not None
    assert verify(t, path, rig, payload_attitudes(rig, x)).max_error < 1e-9


def test_progress_may_cancel_the_search() -> None:
    rig, t, x = needle_flight(Geometry.VERTICAL_4, 20.0)

    class StopError(Exception):
        pass

    def stop(_done: int, _total: int) -> None:
        raise StopError

    with pytest.raises(StopError):
        searched(Problem(t, payload_attitudes(rig, x), rig), progress=stop)
