"""The map of the plane of time and base angle, against SciPy's rotations, brute force and finite differences."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

import fullpose
from fullpose.bounds import limited_name
from fullpose.errors import InputError, MethodError
from fullpose.rig import FRAMES, FrameLimits, Geometry, Limit, Rig
from fullpose.trajectory.plane_map import PlaneMap, plane_map
from fullpose.verify import verify

DEG = math.pi / 180.0
H = 1e-4  # [s] of the differences along the self-motion
T = np.arange(1001) / 500.0
ORDERS: dict[Geometry, tuple[str, Any]] = {
    Geometry.VERTICAL_4: ("y", "ZYX"),
    Geometry.HORIZONTAL_4: ("z", "YZX"),
}  # of the base, of the others


def attitude_at(time: np.ndarray | float) -> Rotation:
    """A smooth flight, active: body axes in the reference frame. Its pitch and its heading cross zero."""
    t = np.atleast_1d(time)
    angles = [0.9 * np.sin(1.3 * t) - 0.4, 0.5 * np.sin(2.1 * t - 0.7), 0.7 * np.cos(1.7 * t)]
    return Rotation.from_euler("YZX", np.stack(angles, axis=-1))


def rig_of(geometry: Geometry, **ranges: tuple[float, float]) -> Rig:
    rates = {"base": 80.0, "outer": 120.0, "middle": 100.0, "inner": 200.0}
    frames = []
    for name in map(str, FRAMES):
        low, high = (DEG * v for v in ranges.get(name, (-math.inf, math.inf)))
        frames.append(FrameLimits(low, high, rates[name] * DEG, 500.0 * DEG, home=max(low, 0.0)))
    return Rig("r", geometry, (frames[0], frames[1], frames[2], frames[3]))


def mapped(rig: Rig, **sizes: int) -> PlaneMap:
    return plane_map(T, attitude_at(T).inv().as_matrix(), rig, **sizes)


def frames_at(geometry: Geometry, time: float, base: float, side: int) -> np.ndarray:
    """The pose (4,) of a side with this base angle, by SciPy's Euler angles of what the base leaves to the others."""
    own, others = ORDERS[geometry]
    left = Rotation.from_euler(own, base).inv() * attitude_at(time)[0]
    second, third, fourth = left.as_euler(others)
    if side:
        second, third, fourth = second + math.pi, math.pi - third, fourth + math.pi
    return np.array([base, second, third, fourth])


def rates_at(geometry: Geometry, time: float, base: float, side: int, base_rate: float) -> np.ndarray:
    a = frames_at(geometry, time - H, base - H * base_rate, side)
    b = frames_at(geometry, time + H, base + H * base_rate, side)
    return np.asarray(((b - a + math.pi) % (2.0 * math.pi) - math.pi) / (2.0 * H))


def least_share(rig: Rig, time: float, base: float, side: int) -> float:
    """Of the rate limits, over rates of the base; convex, so what is least between is least."""

    def share(base_rate: float) -> float:
        return float(np.max(np.abs(rates_at(rig.geometry, time, base, side, base_rate)) / rig.max_rate))

    wide = np.linspace(-40.0, 40.0, 81)
    near = wide[int(np.argmin([share(v) for v in wide]))]
    return float(minimize_scalar(share, bounds=(near - 1.0, near + 1.0), options={"xatol": 1e-9}).fun)


def ranges_left(rig: Rig, pose: np.ndarray) -> np.ndarray:
    """What is left of the ranges (4,), each frame but the base in whatever turn leaves most."""
    left = np.full(4, math.inf)
    for i, frame in enumerate(rig.frames):
        if not frame.continuous:
            half = 0.5 * (frame.max - frame.min)
            turns = pose[i] + 2.0 * math.pi * np.arange(-9, 10) * (i > 0)
            left[i] = np.max(np.minimum(turns - frame.min, frame.max - turns)) / half
    return left


@pytest.mark.parametrize("geometry", list(ORDERS))
def test_margins_are_the_least_share_that_any_rate_of_the_base_leaves(geometry: Geometry) -> None:
    rig = rig_of(geometry)
    made = mapped(rig, columns=23, rows=19)
    assert made.margin.shape == (2, 23, 19)
    cells = np.random.default_rng(3).permutation([(s, j, i) for s in (0, 1) for j in range(1, 22) for i in range(19)])
    for side, j, i in cells[:60].tolist():
        margin = made.margin[side, j, i]
        if margin < -3.0:
            continue  # next to a needle, where differences have no digits
        assert margin == pytest.approx(1.0 - least_share(rig, made.time[j], made.base[i], side), abs=2e-4)
        frame, limit = made.limit_at(side, j, i) or (None, None)
        against = limited_name(int(made.against[side, j, i]))
        assert limit == Limit.RATE
        assert against is not None
        assert against[0] != frame


def test_ranges_count_by_their_halves_and_in_the_turn_that_leaves_most() -> None:
    rig = rig_of(Geometry.VERTICAL_4, base=(-100.0, 100.0), middle=(-50.0, 70.0), inner=(300.0, 500.0))
    made = mapped(rig, columns=12, rows=15)
    assert made.base[[0, -1]] == pytest.approx([-100.0 * DEG, 100.0 * DEG])
    seen = set()
    for side in (0, 1):
        for j in range(1, 11):
            for i in range(15):
                left = ranges_left(rig, frames_at(rig.geometry, made.time[j], made.base[i], side))
                found = made.limit_at(side, j, i)
                assert made.margin[side, j, i] <= left.min() + 1e-9
                if found is not None and found[1] == Limit.POSITION:
                    assert made.margin[side, j, i] == pytest.approx(left.min(), abs=1e-9)
                    assert found[0] == FRAMES[int(np.argmin(left))]
                    seen.add(found[0])
    assert seen == {"base", "middle", "inner"}
    assert (made.best == made.margin.max(axis=0)).all()
    assert (np.take_along_axis(made.margin, made.side[None], axis=0)[0] == made.best).all()


@pytest.mark.parametrize("geometry", list(ORDERS))
def test_a_path_beside_a_needle_breaks_the_outer_frames_rate_exactly_within_its_half_width(geometry: Geometry) -> None:
    rig = rig_of(geometry)
    found = mapped(rig, columns=5, rows=5).needles
    assert len(found.time) >= 1
    for time, base, width in zip(*found, strict=True):
        assert 0.0 < width < math.pi / 2
        for beside, base_rate, turn in ((0.97, 0.8, 0.0), (1.03, -0.6, 0.0), (-0.97, 0.0, math.pi), (-1.03, 0.5, 0.0)):
            rate = rates_at(geometry, time, base + beside * width + turn, 0, base_rate)[1]
            assert (abs(rate) > rig.max_rate[1]) == (abs(beside) < 1.0)


def test_a_path_is_as_tight_as_its_check_finds_it() -> None:
    rig = rig_of(Geometry.VERTICAL_4, base=(-100.0, 100.0), inner=(-200.0, 200.0))
    C = attitude_at(T).inv().as_matrix()
    solution = fullpose.solve(T, C, rig)
    path = fullpose.plane_map(T, C, rig, solution.angles, columns=3, rows=3).path
    assert path is not None
    found = verify(T, solution.angles, rig)
    assert found.violations == ()
    spread = np.array([100.0 * DEG, math.inf, math.inf, 200.0 * DEG])
    shares = 1.0 - found.peaks / np.stack([spread, rig.max_rate, rig.max_acceleration, rig.max_jerk], axis=1)
    assert path.margin[path.tightest] == pytest.approx(shares.min(), abs=1e-12)
    frame, limit = np.unravel_index(np.argmin(shares), shares.shape)
    assert limited_name(int(path.binding[path.tightest])) == (FRAMES[frame], list(Limit)[limit])
    assert (path.side == (np.cos(solution.angles[:, 2]) < 0.0)).all()
    faster = plane_map(0.3 * T, C, rig, solution.angles, columns=3, rows=3).path
    assert faster is not None
    assert faster.margin[faster.tightest] < 0.0


def test_the_base_angles_are_the_range_or_half_a_turn_about_the_path() -> None:
    C = attitude_at(T).inv().as_matrix()
    angles = np.zeros((len(T), 4))
    angles[:, 0] = 700.0 * DEG + T
    wide = plane_map(T, C, rig_of(Geometry.VERTICAL_4), angles, columns=3, rows=3)
    assert wide.base[[0, -1]] == pytest.approx([520.0 * DEG, 880.0 * DEG + 2.0])
    ending = plane_map(T, C, rig_of(Geometry.VERTICAL_4, base=(-800.0, 800.0)), angles, columns=3, rows=3)
    assert ending.base[[0, -1]] == pytest.approx([520.0 * DEG, 800.0 * DEG])


def test_a_rig_without_limits_leaves_all_and_nothing_binds() -> None:
    made = mapped(Rig("free", Geometry.VERTICAL_4), columns=4, rows=5)
    assert (made.margin == 1.0).all()
    assert (made.binding == 0).all()
    assert (made.needles.half_width == 0.0).all()


def test_what_has_no_plane_is_refused() -> None:
    C = attitude_at(T).inv().as_matrix()
    with pytest.raises(MethodError, match="three axes"):
        plane_map(T, C, Rig("r", Geometry.VERTICAL_3))
    with pytest.raises(MethodError, match="no range to move in"):
        plane_map(T, C, rig_of(Geometry.VERTICAL_4, base=(0.0, 0.0)))
    rig = rig_of(Geometry.VERTICAL_4)
    with pytest.raises(InputError, match="two samples"):
        plane_map(T[:1], C[:1], rig)
    with pytest.raises(InputError, match="angles"):
        plane_map(T, C, rig, np.zeros((3, 4)))
    for columns, rows in ((1, 5), (5, 1), (10_000, 10_000)):
        with pytest.raises(InputError, match="cells at most"):
            plane_map(T, C, rig, columns=columns, rows=rows)
