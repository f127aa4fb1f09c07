"""The stepper of `preview` in live use: jobs asked for, run elsewhere and adopted, late, wrong or not at all."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from fullpose.errors import MethodError
from fullpose.limits import limit_table
from fullpose.preview.replan import Replan
from fullpose.preview.stepper import PreviewStepper, start_nodes
from fullpose.scenarios import DEG
from fullpose.verify import attitude_errors, payload_attitudes
from tests.support.previews import HORIZONTAL, LIMITED, check, fast, flight


def begun(samples: int = 30, **options) -> tuple[PreviewStepper, np.ndarray, np.ndarray]:
    time, attitude = flight(2, 4.0, 60.0)
    stepper = PreviewStepper(LIMITED, fast(**options), np.zeros(4), attitude[0])
    for k in range(samples):
        stepper.block(time[k : k + 1], attitude[k : k + 1])
    return stepper, time, attitude


def test_a_job_survives_a_pickle_and_says_the_same() -> None:
    stepper, _, _ = begun()
    job = stepper.replan()
    copy = pickle.loads(pickle.dumps(job))
    assert isinstance(copy, Replan)
    here, there = job.run(), pickle.loads(pickle.dumps(copy.run()))
    assert np.array_equal(here.pose, there.pose)
    assert stepper.adopt(there)
    assert not stepper.adopt(here)  # the same number again


def test_a_job_is_frozen_against_what_comes_after() -> None:
    stepper, time, attitude = begun()
    job = stepper.replan()
    before = job.run()
    stepper.offer(time[40:80], attitude[40:80])
    stepper.block(time[30:40], attitude[30:40])
    assert np.array_equal(job.run().pose, before.pose)


def test_old_and_spent_ways_are_not_adopted() -> None:
    stepper, time, attitude = begun(horizon_s=0.2)
    early, late = stepper.replan(), stepper.replan()
    assert stepper.adopt(late.run())
    assert not stepper.adopt(early.run())
    third = stepper.replan()
    stepper.block(time[30:60], attitude[30:60])  # 0.3 s on: past the horizon
    assert not stepper.adopt(third.run())


def test_without_any_way_the_limits_hold_and_the_step_goes_on() -> None:
    time, attitude = flight(2, 4.0, 120.0)
    stepper = PreviewStepper(LIMITED, fast(), np.zeros(4), attitude[0])
    block = stepper.block(time, attitude)
    check(LIMITED, time, attitude, block.angles, block.limited)


def test_a_way_from_elsewhere_costs_no_limit() -> None:
    stepper, time, attitude = begun()
    way = stepper.replan().run()
    random = np.random.default_rng(0)
    wild = replace(way, pose=way.pose + random.normal(size=way.pose.shape), rate=way.rate * 50.0)
    angles = [stepper._flight.pose.copy()]
    assert stepper.adopt(wild)
    block = stepper.block(time[30:150], attitude[30:150])
    check(LIMITED, time[29:150], attitude[29:150], np.vstack([angles, block.angles]), np.r_[0, block.limited])


def test_nothing_to_plan_from_before_the_first_sample() -> None:
    stepper = PreviewStepper(LIMITED, fast(), None, np.eye(3))
    assert not stepper.due
    with pytest.raises(MethodError, match="no sample"):
        stepper.replan()


def test_start_nodes_are_exact_and_inside() -> None:
    _, attitude = flight(7, 0.1, 10.0)
    for rig in (LIMITED, HORIZONTAL):
        poses = start_nodes(rig, limit_table(rig), attitude[0])
        assert len(poses) > 20
        error, _ = attitude_errors(payload_attitudes(rig, poses), np.broadcast_to(attitude[0], (len(poses), 3, 3)))
        assert error.max() < 1e-9
        assert (np.abs(poses[:, 3]) <= 60 * DEG).all()
