"""Playing a plan: bit for bit at full speed, exact and inside the limits through hold and resume."""

import math

import numpy as np
import pytest

from fullpose.rig import FrameLimits, Rig, builtin_rigs
from fullpose_server.runtime.motion.path_player import PathPlayer
from tests.fullpose_server.runtime.rigs import plan_of

RATE = 1000.0
FOUR = ["vertical-4", "horizontal-4", "vertical-limited"]


def play(player: PathPlayer, wanted: list[float], most: int = 200_000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Commands, attitudes and time scales while `wanted` (one a tick, the last one kept) is followed to the end."""
    x1 = player.start_pose(np.zeros(4))
    v1 = np.zeros(4)
    x, q = np.zeros(4), np.zeros(4)
    player.rewind()
    xs, qs, scales = [x1.copy(), x1.copy()], [], []
    for tick in range(most):
        player.scale_to(wanted[min(tick, len(wanted) - 1)])
        code = player.tick(x1, v1, x, q)
        v1[:] = (x - x1) * RATE
        x1[:] = x
        xs.append(x.copy())
        qs.append(q.copy())
        scales.append(player.scale)
        if code < 0:
            break
    return np.array(xs), np.array(qs), np.array(scales)


def errors_deg(rig: Rig, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Geodesic errors [deg] of angles (n, 4) against attitudes (n, 4), by SciPy alone."""
    from scipy.spatial.transform import Rotation

    letters = {0: "x", 1: "y", 2: "z"}
    columns = list(rig.geometry.frames)
    # Active rotations, outermost first: the transposed order of the passive product.
    axes = "".join(letters[rig.geometry.axes[i]] for i in columns).upper()
    payload = Rotation.identity(len(x))
    for letter, column in zip(axes, columns, strict=True):
        payload = payload * Rotation.from_euler(letter, x[:, column, None])
    target = Rotation.from_quat(q[:, [1, 2, 3, 0]])
    return np.degrees((payload.inv() * target).magnitude())


@pytest.mark.parametrize("name", [*FOUR, "vertical-3", "horizontal-3"])
def test_at_full_speed_every_sample_is_played_bit_for_bit(name: str) -> None:
    rig = builtin_rigs()[name]
    plan = plan_of(rig, 1.0)
    x, _, scale = play(PathPlayer(plan, rig, RATE, 2.0, 20.0), [1.0])
    np.testing.assert_array_equal(x[2:], plan.angles[1:])
    assert (scale == 1.0).all()


@pytest.mark.parametrize("name", FOUR)
@pytest.mark.parametrize("seed", range(8))
def test_hold_and_resume_stay_exact_and_inside_the_limits(name: str, seed: int) -> None:
    rig = builtin_rigs()[name]
    plan = plan_of(rig, 4.0)
    generator = np.random.default_rng(seed)
    wanted: list[float] = []
    for _ in range(4):
        wanted += [1.0] * int(generator.integers(200, 1500)) + [0.0] * int(generator.integers(20, 1500))
    x, q, scale = play(PathPlayer(plan, rig, RATE, 2.0, 20.0), [*wanted, 1.0])
    v = np.diff(x, axis=0) * RATE
    a = np.diff(v, axis=0) * RATE
    assert np.abs(v / rig.max_rate).max() <= 1.0 + 1e-6
    assert np.abs(a / rig.max_acceleration).max() <= 1.0 + 1e-6
    flight = np.isfinite(q[:, 0])
    assert flight.sum() > 4000
    assert errors_deg(rig, x[2:][flight], q[flight]).max() <= 1e-9
    assert scale.min() == 0.0  # it did come to rest
    assert np.abs(x[-1] - plan.angles[-1]).max() == 0.0


def test_a_plan_at_its_limits_can_be_held_anywhere() -> None:
    """Limits taken from the plan itself: no room is left but what slowing down makes."""
    free = builtin_rigs()["vertical-4"]
    plan = plan_of(free, 4.0)
    v = np.diff(plan.angles, axis=0) * RATE
    a = np.abs(np.diff(v, axis=0)).max(axis=0) * RATE
    frames = tuple(FrameLimits(max_rate=r, max_acceleration=b) for r, b in zip(np.abs(v).max(axis=0), a, strict=True))
    rig = Rig("tight", free.geometry, frames)  # type: ignore[arg-type]
    plan = plan_of(rig, 4.0)
    for start in range(1000, 5000, 400):
        x, _, scale = play(PathPlayer(plan, rig, RATE, 2.0, 20.0), [1.0] * start + [0.0] * 3000 + [1.0])
        v = np.diff(x, axis=0) * RATE
        assert np.abs(v / rig.max_rate).max() <= 1.0 + 1e-6
        assert np.abs(np.diff(v, axis=0) * RATE / rig.max_acceleration).max() <= 1.0 + 1e-6
        assert scale[start + 2900] == 0.0, f"not held from tick {start}"


def test_after_a_resume_the_plan_s_own_samples_are_played_again() -> None:
    rig = builtin_rigs()["vertical-4"]
    plan = plan_of(rig, 8.0)
    x, _, _ = play(PathPlayer(plan, rig, RATE, 2.0, 20.0), [1.0] * 2000 + [0.0] * 1500 + [1.0])
    tail = x[-3000:]
    np.testing.assert_array_equal(tail, plan.angles[-3000:])


def test_a_plan_at_another_rate_is_played_in_its_own_time() -> None:
    rig = builtin_rigs()["vertical-4"]
    plan = plan_of(rig, 2.0, rate_hz=500.0)
    x, q, _ = play(PathPlayer(plan, rig, RATE, 2.0, 20.0), [1.0])
    assert abs(len(x) / 2.0 - len(plan.angles)) < 3
    flight = np.isfinite(q[:, 0])
    assert errors_deg(rig, x[2:][flight], q[flight]).max() <= 1e-9


def test_a_frame_without_end_begins_on_the_nearest_turn() -> None:
    rig = builtin_rigs()["vertical-4"]
    player = PathPlayer(plan_of(rig, 1.0), rig, RATE, 2.0, 20.0)
    start = player.start_pose(np.array([0.0, 4.0 * math.pi + 0.3, -6.1, 0.0]))
    np.testing.assert_allclose(start, [0.0, 4.0 * math.pi, -2.0 * math.pi, 0.0])
    limited = builtin_rigs()["vertical-limited"]
    start = PathPlayer(plan_of(limited, 1.0), limited, RATE, 2.0, 20.0).start_pose(np.full(4, 7.0))
    assert start[3] == 0.0  # a frame with a range has no other turn
