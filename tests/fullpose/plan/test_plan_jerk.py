"""Plans of rigs with jerk limits: exact and inside every limit by code of its own, or refused with the jerk it would
need."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.kinematics import payload_attitudes
from fullpose.plan import plan
from fullpose.rig import Limit, Rig, builtin_rigs
from fullpose.trajectory.constraints import exceeded, rig_limits
from fullpose.verify import differences, jerks, verify

DEG = np.pi / 180.0


def with_jerk(rig: Rig, deg_s3: float) -> Rig:
    base, outer, middle, inner = (replace(frame, max_jerk=deg_s3 * DEG) for frame in rig.frames)
    return replace(rig, frames=(base, outer, middle, inner))


def third_differences(path, hz):
    """The largest of each frame [deg/s^3], by nothing of the package."""
    return np.abs(np.diff(np.degrees(path), 3, axis=0)).max(axis=0) * hz**3


def flight_of(seed: int, name: str, seconds: float = 4.0, hz: float = 250.0, speed: float = 1.0):
    """The attitude that frame paths of three sines point the payload at: (time, attitude, paths)."""
    rig = builtin_rigs()[name]
    random = np.random.default_rng(seed)
    t = np.arange(round(seconds * hz) + 1) / hz
    d = np.zeros((len(t), 4))
    for i in rig.geometry.frames:
        for _ in range(3):
            f = speed * random.uniform(0.1, 0.5)
            d[:, i] += 12.0 * DEG * np.sin(2.0 * np.pi * (f * t + random.uniform()))
    d[:, 1] += 40.0 * DEG
    F = np.empty((len(t), 3, 3))
    payload_attitudes(rig.axes, d, F)
    return t, F, d


REFUSED = pytest.mark.xfail(strict=True, reason="flyable by construction, and refused: decision 0055")
KNOWN = [(name, seed) for seed in range(4) for name in ("vertical-4", "vertical-limited", "horizontal-4")]
KNOWN.remove(("vertical-4", 3))


@pytest.mark.parametrize(("name", "seed"), [*KNOWN, pytest.param("vertical-4", 3, marks=REFUSED)])
def test_a_plan_keeps_the_limit_that_a_path_is_known_to_keep(name: str, seed: int) -> None:
    t, C, d = flight_of(seed, name)
    most = float(third_differences(d, 250.0).max())
    rig = with_jerk(builtin_rigs()[name], 1.25 * most)
    made = plan(t, C, rig)
    assert made.ready, (made.verdict.statement, made.lead_refusal)
    path = np.vstack([made.lead_in, made.solution.angles, made.lead_out])
    path = np.vstack([path[:1], path[:1], path[:1], path, path[-1:], path[-1:], path[-1:]])
    assert third_differences(path, 250.0).max() <= 1.25 * most * (1.0 + 1e-6)
    assert verify(t, made.solution.angles, rig, C).violations == ()
    assert made.solution.error.max() < 1e-9


def test_it_bends_the_path_of_a_plan_without_it() -> None:
    t, C, _ = flight_of(1, "vertical-4", speed=1.5)
    free = builtin_rigs()["vertical-4"]
    before = third_differences(plan(t, C, free).solution.angles, 250.0).max()
    made = plan(t, C, with_jerk(free, 0.8 * before))
    assert made.verdict.feasible, made.verdict.statement
    assert third_differences(made.solution.angles, 250.0).max() <= 0.8 * before * (1.0 + 1e-6)


def test_what_cannot_be_flown_is_refused_and_the_jerk_is_named() -> None:
    t, C, d = flight_of(2, "vertical-3", speed=2.0)
    most = float(third_differences(d, 250.0).max())
    rig = with_jerk(builtin_rigs()["vertical-3"], 0.5 * most)
    made = plan(t, C, rig)
    assert not made.verdict.feasible
    assert made.verdict.blocking is not None
    reason = made.verdict.reason
    assert reason is not None
    assert Limit.JERK in (reason.first.limit, reason.then.limit if reason.then else None)


def test_over_limits_agrees_with_the_independent_check() -> None:
    t, _, d = flight_of(3, "vertical-4")
    rig = with_jerk(builtin_rigs()["vertical-4"], 500.0)
    violation, _ = exceeded(t, d, rig_limits(rig))
    _, acceleration = differences(t, d)
    expected = (np.abs(jerks(t, acceleration)) / rig.max_jerk).max(axis=1) - 1.0
    np.testing.assert_allclose(violation[2:-1, 3], expected, atol=1e-7)
    assert np.isneginf(violation[[0, 1, -1], 3]).all()


def test_a_rig_without_the_limit_has_no_column_of_it() -> None:
    t, _, d = flight_of(3, "vertical-4")
    violation, _ = exceeded(t, d, rig_limits(builtin_rigs()["vertical-4"]))
    assert violation.shape == (len(t), 3)
