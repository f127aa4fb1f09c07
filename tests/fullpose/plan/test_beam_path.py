"""Node paths that know the accelerations: flights flyable by construction, pieces, first poses, attainable rates."""

from importlib import import_module

import numpy as np
import pytest

from fullpose.errors import CancelledError
from fullpose.flyable import flyable_path, rig_of
from fullpose.plan import PlanOptions, plan
from fullpose.plan.beam_path import BREADTHS, attainable_rates, beam_path, first_poses
from fullpose.rig import Geometry
from fullpose.trajectory.beam_search import Start
from fullpose.trajectory.problem import Problem
from fullpose.trajectory.windows import stage_samples
from fullpose.verify import attitude_errors, payload_attitudes, verify

PLAIN = PlanOptions(best_effort=False)


@pytest.mark.parametrize(
    ("name", "geometry", "share", "seed"),
    [
        ("narrow", "vertical-4", 0.9, 0),
        ("narrow", "vertical-4", 0.9, 5),
        ("multi", "vertical-4", 0.9, 1),
        ("multi", "vertical-4", 0.9, 4),
        ("free", "vertical-4", 0.7, 3),
        ("narrow", "horizontal-4", 0.7, 3),
    ],
)
def test_a_flight_that_is_known_to_be_flyable_is_flown(name, geometry, share, seed):
    rig = rig_of(name, Geometry(geometry))
    t, x = flyable_path(seed, rig, share, 4.0, 500.0)
    assert verify(t, x, rig).violations == ()
    C = payload_attitudes(rig, x)
    made = plan(t, C, rig, options=PLAIN)
    assert made.verdict.feasible
    found = verify(t, made.solution.angles, rig, C)
    assert found.violations == ()
    assert found.max_error < 1e-12


def stages_of(name="multi", seed=1, duration=4.0):
    rig = rig_of(name, Geometry.VERTICAL_4)
    t, x = flyable_path(seed, rig, 0.5, duration, 100.0)
    samples = stage_samples(t, 0.05)
    return rig, t[samples], np.ascontiguousarray(payload_attitudes(rig, x)[samples])


def test_pieces_are_exact_continuous_and_inside_the_rates(monkeypatch):
    rig, t, C = stages_of()
    monkeypatch.setattr(import_module("fullpose.plan.beam_path"), "PIECE", 1.0)
    monkeypatch.setattr(import_module("fullpose.plan.beam_path"), "FORESIGHT", 0.5)
    told = []
    poses = first_poses(C[0], rig)
    stages, first = Problem(t, C, rig), Start(poses, np.zeros_like(poses), 0.0)
    node_path = beam_path(stages, BREADTHS[0], first, lambda done, total: told.append((done, total)))
    assert len(told) > 2
    assert told[-1] == (len(t), len(t))
    assert attitude_errors(payload_attitudes(rig, node_path), C)[0].max() < 1e-9
    assert (np.abs(np.diff(node_path, axis=0)) <= 1.01 * rig.max_rate * 0.05).all()

    def stop(done, total):
        raise CancelledError("enough")

    with pytest.raises(CancelledError):
        beam_path(stages, BREADTHS[0], first, stop)


@pytest.mark.parametrize("name", ["narrow", "multi", "free", "tight"])
def test_first_poses_are_exact_and_inside_the_ranges(name):
    rig, _, C = stages_of(name)
    poses = first_poses(C[0], rig)
    assert len(poses) > 0
    assert attitude_errors(payload_attitudes(rig, poses), np.repeat(C[:1], len(poses), axis=0))[0].max() < 1e-9
    assert ((poses >= rig.position_min) & (poses <= rig.position_max)).all()


def test_attainable_rates_lead_to_the_next_attitude():
    rig, t, C = stages_of("free")
    poses = first_poses(C[0], rig)
    rates = attainable_rates(C[1], t[1] - t[0], rig, poses, np.array([1.0, 0.0, 0.0, 0.0]))
    moved = poses + rates * (t[1] - t[0])
    assert attitude_errors(payload_attitudes(rig, moved), np.repeat(C[1:2], len(moved), axis=0))[0].max() < 1e-9
