"""No flight is refused that a method flies which looks at less of it."""

import math

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.plan import PlanOptions, plan
from fullpose.plan.fallback import FORESIGHTS, Fallback
from fullpose.plan.refinement import Task, flown_beside
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.solve import solve
from fullpose.trajectory.problem import Problem
from fullpose.verify import attitude_errors, payload_attitudes, verify
from tests.support.flights import example_flight


def tumble(seed: int, degrees_per_second: float) -> tuple[np.ndarray, np.ndarray]:
    time, quaternion = random_flight(seed, 3.0, 100.0, degrees_per_second)
    return time, dcm_from_quaternion(quaternion)


def flown(time: np.ndarray, attitude: np.ndarray, angles: np.ndarray, rig: Rig) -> bool:
    return not verify(time, angles, rig, attitude).violations and bool(
        attitude_errors(payload_attitudes(rig, angles), attitude)[0].max() < 1e-11
    )


def some_limits(seed: int) -> Rig:
    """A rig with few limits, and low ones: what a rig file with few keys asks for."""
    rng = np.random.default_rng(seed)
    frames = []
    for _ in range(4):
        span = math.radians(rng.uniform(60.0, 200.0))
        rate, acceleration = math.radians(rng.uniform(4.0, 60.0)), math.radians(rng.uniform(40.0, 400.0))
        has = rng.random(3) < 0.15
        frames.append(
            FrameLimits(
                min=-span if has[0] else -math.inf,
                max=span if has[0] else math.inf,
                max_rate=rate if has[1] else math.inf,
                max_acceleration=acceleration if has[2] else math.inf,
            )
        )
    geometry = (Geometry.VERTICAL_4, Geometry.HORIZONTAL_4)[seed % 2]
    return Rig("some", geometry, (frames[0], frames[1], frames[2], frames[3]))


@pytest.mark.parametrize("seed", [7, 15, 16, 23, 31])
def test_what_the_step_method_flies_is_planned(seed: int) -> None:
    rig = some_limits(seed)
    time, attitude = tumble(seed, 12.0)
    assert flown(time, attitude, solve(time, attitude, rig, method="exact").angles, rig)
    made = plan(time, attitude, rig, options=PlanOptions(best_effort=False))
    assert made.verdict.feasible
    assert flown(time, attitude, made.solution.angles, rig)


def test_a_real_roll_with_a_slow_inner_frame_is_planned() -> None:
    """The node paths turn this roll over the inner frame; beside the step method's path it need not turn."""
    t, q = example_flight("slow_roll")
    time, attitude = t[::4], dcm_from_quaternion(q[::4])
    free = FrameLimits()
    rig = Rig("few", Geometry.VERTICAL_4, (free, free, free, FrameLimits(max_rate=math.radians(3.0))))
    made = plan(time, attitude, rig)
    assert made.verdict.feasible
    assert flown(time, attitude, made.solution.angles, rig)


def test_the_paths_are_inside_the_limits_and_made_once() -> None:
    rig = builtin_rigs()["vertical-limited"]
    time, attitude = tumble(3, 150.0)
    fallback = Fallback(Problem(time, attitude, rig))
    paths = (fallback.exact, *fallback.foreseen)
    assert len(paths) == 1 + len(FORESIGHTS)
    for path in paths:
        assert not verify(time, path, rig, attitude).violations
    assert fallback.exact is paths[0]
    assert all(again is path for again, path in zip(fallback.foreseen, paths[1:], strict=True))


def test_a_path_that_misses_the_attitude_is_none() -> None:
    rig = some_limits(23)
    time, attitude = tumble(23, 12.0)
    problem = Problem(time, attitude, rig)
    task = Task(problem, Fallback(problem))
    path = task.fallback.exact
    assert flown_beside(task, path) is not None
    off = path.copy()
    off[150:] += 1e-6
    assert flown_beside(task, off) is None
