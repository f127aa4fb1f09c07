"""The job that finds the way ahead: its stages, its smoothing, what it foretells."""

from dataclasses import replace

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.preview.replan import Replan
from fullpose.preview.stepper import PreviewStepper
from fullpose.scenarios import DEG
from fullpose.verify import attitude_errors, payload_attitudes, verify
from tests.support.previews import LIMITED, fast, flight


def announced() -> tuple[np.ndarray, np.ndarray, Replan]:
    """A flight, and the job of a stepper that has flown two of its samples and been told all."""
    time, attitude = flight(2, 3.0, 60.0)
    stepper = PreviewStepper(LIMITED, fast(), None, attitude[0])
    stepper.offer(time, attitude)
    stepper.block(time[:2], attitude[:2])
    job = stepper.replan()
    return time, attitude, job


def test_the_stages_lie_on_the_solutions_and_inside_the_limits() -> None:
    """As samples of their own they pass the independent check; the way runs next to them."""
    time, attitude, job = announced()
    stage, pose, known, over = job.stages()
    assert known == over == len(stage) > 50
    at = np.rint(stage * 100).astype(int)
    kept = at < len(time)
    error, _ = attitude_errors(payload_attitudes(LIMITED, pose[kept]), attitude[at[kept]])
    assert error.max() < 1e-6
    assert not verify(stage, pose, LIMITED).violations
    way = replace(job, options=fast(smoothing=0)).run()
    assert way.lost_at == np.inf
    assert np.allclose(way.time[::2], stage)
    assert np.abs(way.pose[::2] - pose).max() < 1.0 * DEG
    assert not verify(way.time, way.pose, LIMITED).violations


def test_smoothing_takes_the_jerks_from_the_same_way() -> None:
    time, attitude, job = announced()
    rough, smooth = (replace(job, options=fast(smoothing=count)).run() for count in (0, 3))

    def jerk(way) -> float:
        acceleration = np.diff(way.rate, axis=0) / np.diff(way.time)[:, None]
        return float(np.sqrt(np.mean(np.diff(acceleration, axis=0) ** 2)))

    assert jerk(smooth) < 0.5 * jerk(rough)
    assert np.allclose(smooth.pose[0], rough.pose[0])
    assert np.allclose(smooth.rate[0], rough.rate[0])
    assert np.abs(smooth.pose[-1] - rough.pose[-1]).max() < 0.1 * DEG  # where the search wanted to be
    assert not verify(smooth.time, smooth.pose, LIMITED).violations
    at = np.rint(smooth.time * 100).astype(int)
    error, _ = attitude_errors(payload_attitudes(LIMITED, smooth.pose), attitude[np.minimum(at, len(time) - 1)])
    assert error[(at < len(time)) & (np.abs(at - smooth.time * 100) < 1e-6)].max() < 0.1 * DEG


def test_a_loss_is_foretold() -> None:
    # At rest, then a yaw of 700 deg/s, more than the frames have together, announced a second ahead.
    time = np.arange(0.0, 2.0, 0.01)
    angle = 700 * DEG * np.maximum(0.0, time - 1.0)
    attitude = dcm_from_quaternion(np.stack([np.cos(0.5 * angle), 0 * angle, np.sin(0.5 * angle), 0 * angle], axis=1))
    stepper = PreviewStepper(LIMITED, fast(), np.zeros(4), attitude[0])
    stepper.offer(time, attitude)
    stepper.block(time[:10], attitude[:10])
    assert stepper.replan().run().lost_at == pytest.approx(1.1, abs=0.15)
