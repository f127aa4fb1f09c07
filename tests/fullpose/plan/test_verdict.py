"""What a verdict says of the time between samples."""

import math
from importlib import import_module

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.plan import plan
from fullpose.plan.verdict import STENCIL, between_samples
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import payload_attitudes

DEG = np.pi / 180.0
RIGS = builtin_rigs()
FREE = RIGS["vertical-4"]


def cubic(t):
    """Angles that are cubics in time, which the interpolation returns exactly. (n, 4)"""
    return np.stack([0.3 * t**3 - t, 0.2 * t**2 + 0.1, 0.1 * t, 0.4 - 0.2 * t**3], axis=1)


def random_time(seed, n):
    return np.cumsum(np.random.default_rng(seed).uniform(0.5e-3, 4e-3, n))


def test_uneven_time_is_interpolated_in_real_time():
    t = random_time(0, 2000)
    x = np.stack([np.sin(t), 0.5 * np.cos(2 * t), 0.3 * np.sin(t), np.cos(t)], axis=1)
    found = between_samples(t, payload_attitudes(FREE, x), x, FREE)
    assert found.matrix < 1e-8
    assert found.angle < 1e-8


def test_every_interval_is_looked_at_the_first_and_the_last_too():
    t = np.arange(40) * 0.01
    for wrong in (0, 39):
        x = cubic(t)
        C = payload_attitudes(FREE, x)
        x[wrong, 3] += 0.1
        assert between_samples(t, C, x, FREE).angle > 0.01


@pytest.mark.parametrize("kind", range(3))
def test_the_limits_between_samples_are_those_of_the_cubics(kind):
    t = random_time(1, 400) * 2.0
    x = cubic(t)
    mid = 0.5 * (t[1:] + t[:-1])
    truth = (np.abs(cubic(mid)[:, 0]), np.abs(0.9 * mid**2 - 1.0), np.abs(1.8 * mid))[kind].max()
    value = [math.inf] * 3
    value[kind] = 0.8 * truth
    rig = Rig("one", Geometry.VERTICAL_4, (FrameLimits(-value[0], value[0], *value[1:]), *[FrameLimits()] * 3))
    found = between_samples(t, payload_attitudes(rig, x), x, rig)
    assert found.violation[kind] == pytest.approx(0.2 * truth if kind == 0 else 0.25, rel=1e-6)
    assert found.frame[kind] == 0
    assert "base frame's" in found.sentence()
    loose = Rig("loose", Geometry.VERTICAL_4, (FrameLimits(-9.0, 9.0, 9.0, 9.0),) * 4)
    assert between_samples(t, payload_attitudes(loose, x), x, loose).violation == (0.0, 0.0, 0.0)


def test_an_excursion_between_samples_is_said():
    """Samples on the stop, and between them the way that leads there beyond it."""
    t = np.arange(8) * 0.1
    x = np.zeros((8, 4))
    x[:, 3] = np.array([0.2, 0.6, 1.0, 1.0, 0.6, 0.2, 0.0, 0.0])
    rig = Rig("stop", Geometry.VERTICAL_4, (*[FrameLimits()] * 3, FrameLimits(-1.0, 1.0)))
    found = between_samples(t, payload_attitudes(rig, x), x, rig)
    assert found.violation[0] == pytest.approx(0.05)
    assert "inner frame's position limit is passed by 2.9 deg" in found.sentence()


def test_pieces_agree_with_the_whole(monkeypatch):
    t = random_time(2, 500)
    x = 3.0 * np.sin(np.outer(t, [3.0, 5.0, 7.0, 9.0]))
    C = payload_attitudes(FREE, 1.01 * x)
    whole = between_samples(t, C, x, FREE)
    monkeypatch.setattr(import_module("fullpose.plan.verdict"), "CHUNK", 61)
    assert between_samples(t, C, x, FREE) == whole


def test_the_statement_gives_the_number():
    t, q = random_flight(1, 2.0, 250.0, 60 * DEG)
    made = plan(t, dcm_from_quaternion(q), FREE)
    assert made.verdict.feasible
    assert made.verdict.between_angle < 1e-6
    assert f"differs by at most {math.degrees(made.verdict.between_angle):.1e} deg" in made.verdict.statement
    assert "limits hold" in made.verdict.statement


@pytest.mark.parametrize("name", ["vertical-4", "vertical-3"])
def test_sparse_samples_are_said_to_be_sparse(name):
    t = np.arange(0.0, 20.0, 1.0)
    made = plan(t, dcm_from_euler(0.9 * np.sin(t), 0.3 * np.sin(0.9 * t), 0.9 * np.cos(t)), RIGS[name])
    assert made.verdict.feasible
    assert made.verdict.between_angle > 0.01 * DEG
    assert "too sparse" in made.verdict.statement
    assert f"up to {math.degrees(made.verdict.between_angle):.2g} deg" in made.verdict.statement


@pytest.mark.parametrize("n", range(1, STENCIL + 1))
def test_too_few_samples_are_not_looked_at(n):
    t = np.arange(n) * 0.01
    made = plan(t, dcm_from_euler(0.1 * t, 0.2 * t, 0.3 + 0.1 * t), FREE)
    assert made.verdict.feasible
    assert ("Not looked at between samples" in made.verdict.statement) == (n < STENCIL)
    assert math.isnan(made.verdict.between) == (n < STENCIL)


def test_an_infeasible_flight_says_nothing_of_it():
    t = np.arange(0.0, 1.0, 0.01)
    made = plan(t, dcm_from_euler(np.where(t < 0.5, 0.0, 1.0), 0.0, 0.0), RIGS["vertical-limited"])
    assert not made.verdict.feasible
    assert "etween samples" not in made.verdict.statement
