"""The codes of limited samples: the limit that holds them in the written angles, and only limits that the rig has."""

from importlib import import_module

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fullpose.attitude import dcm_from_euler, dcm_from_quaternion
from fullpose.bounds import EXACT, limited_code, limited_name
from fullpose.plan import PlanOptions, plan
from fullpose.plan.active_limits import active_limits
from fullpose.rig import FRAMES, LIMITS, FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import random_flight
from fullpose.verify import payload_attitudes, verify

DEG = np.pi / 180.0
FREE = FrameLimits()
TIME = np.arange(0.0, 3.0, 0.01)


def has(rig, code):
    frame, limit = limited_name(int(code))
    limits = rig.frames[FRAMES.index(frame)]
    value = (limits.max, limits.max_rate, limits.max_acceleration)[LIMITS.index(limit)]
    return FRAMES.index(frame) in rig.geometry.frames and np.isfinite(value)


@st.composite
def partial_rigs(draw):
    """Rigs with at least one limit, and most often not all."""
    some = draw(st.lists(st.booleans(), min_size=12, max_size=12).filter(lambda s: any(s[3:])))
    value = draw(st.lists(st.floats(0.2, 2.0), min_size=12, max_size=12))
    bound = [v if s else np.inf for v, s in zip(value, some, strict=True)]
    frames = tuple(FrameLimits(-bound[i], bound[i], bound[i + 1], bound[i + 2]) for i in range(0, 12, 3))
    return Rig("partial", draw(st.sampled_from(list(Geometry))), frames)


@settings(max_examples=60)
@given(partial_rigs(), st.integers(0, 1000), st.integers(1, 40))
def test_only_limits_that_the_rig_has_are_named(rig, seed, n):
    rng = np.random.default_rng(seed)
    x = np.cumsum(rng.normal(0.0, 0.05, (n, 4)), axis=0) * (rig.axes >= 0)
    x = np.clip(x, rig.position_min, rig.position_max)
    C = payload_attitudes(rig, x + rng.normal(0.0, 0.3, (n, 4)))
    missed = rng.random(n) < 0.5
    codes = active_limits(TIME[:n], C, x, rig, missed)
    assert ((codes != EXACT) == missed).all()
    assert all(has(rig, code) for code in np.unique(codes[missed]))


PARTIAL = {
    "positions": (FrameLimits(-0.5, 0.5),) * 4,
    "one position": (FREE, FrameLimits(-0.2, 0.2), FrameLimits(-0.2, 0.2), FREE),
    "rates": (FrameLimits(max_rate=0.3),) * 4,
    "accelerations": (FrameLimits(max_acceleration=0.3),) * 4,
    "all": builtin_rigs()["vertical-limited"].frames,
}


@pytest.mark.parametrize("name", PARTIAL)
@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4, Geometry.VERTICAL_3])
def test_a_plan_names_only_limits_that_the_rig_has(name, geometry):
    rig = Rig(name, geometry, PARTIAL[name])
    t, q = random_flight(3, 0.3, 100.0, 700 * DEG)
    for options in (PlanOptions(), PlanOptions(best_effort=False)):
        made = plan(t, dcm_from_quaternion(q), rig, options=options)
        assert not made.verdict.feasible
        named = np.unique(made.solution.limited[made.solution.limited != EXACT])
        assert all(has(rig, code) for code in named)
        if options.best_effort:
            assert named.size


def test_the_marks_of_a_fast_flight_are_not_all_one():
    t = np.arange(0.0, 2.0, 0.005)
    rig = builtin_rigs()["vertical-limited"]
    made = plan(t, dcm_from_euler(4 * np.sin(4 * t), 0.7 * np.sin(3 * t), 3 * np.sin(5 * t)), rig)
    codes = np.unique(made.solution.limited[made.solution.limited != EXACT])
    named = [(FRAMES.index(frame), LIMITS.index(limit)) for frame, limit in map(limited_name, codes.tolist())]
    assert all(len(set(each)) > 1 for each in zip(*named, strict=True))
    # Every one of them is reached in the angles as written.
    limits = np.stack([rig.position_max, rig.max_rate, rig.max_acceleration, rig.max_jerk], 1)
    peaks = verify(t, made.solution.angles, rig).peaks / limits
    assert all(peaks[at] > 0.97 for at in named)


RIG = Rig("limits", Geometry.VERTICAL_4, (FrameLimits(-3, 3, 1.0, 5.0),) * 3 + (FrameLimits(-1, 1, 1.0, 5.0),))


@pytest.mark.parametrize("frame", range(4))
@pytest.mark.parametrize("limit", range(3))
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_limit_that_a_frame_is_on_is_named(frame, limit, side):
    t = TIME[:100]
    y = ((np.full_like(t, RIG.position_max[frame])), t - 0.5, 2.5 * (t - 0.5) ** 2 - 0.2)[limit]
    if limit == 2:
        y = np.where(np.abs(t - 0.5) < 0.15, y, 2.5 * 0.15**2 - 0.2 + 0.75 * (np.abs(t - 0.5) - 0.15))
    x = np.tile([0.0, 0.4, 0.3, 0.2], (len(t), 1))
    x[:, frame] = side * y
    short = x.copy()
    short[:, frame] += side * 0.1  # where the frame would have to be
    missed = np.zeros(len(t), np.bool_)
    missed[45:55] = True
    codes = active_limits(t, payload_attitudes(RIG, short), x, RIG, missed)
    assert (codes[45:55] == limited_code(frame, limit)).all()


def test_the_nearest_in_time_is_named_where_none_is_active():
    t = TIME[:200]
    x = np.zeros((200, 4))
    x[:80, 1] = np.clip(t[:80], 0.0, 0.2)  # on its rate until 0.2 s
    x[:80, 1] -= x[79, 1]
    x[:, 3] = np.clip(0.9 * (t - 0.5), 0.0, 1.0)  # on its stop from 1.61 s
    x[-38:, 3] = 1.0
    missed = np.zeros(200, np.bool_)
    missed[[60, 150]] = True
    rig = Rig("two", Geometry.VERTICAL_4, (FREE, FrameLimits(max_rate=1.0), FREE, FrameLimits(-1, 1)))
    C = payload_attitudes(rig, x + np.array([0.0, 0.1, 0.0, 0.1]))
    codes = active_limits(t, C, x, rig, missed)
    assert codes[60] == limited_code(1, 1)
    assert codes[150] == limited_code(3, 0)


def test_in_pieces_they_are_the_same(monkeypatch):
    t, q = random_flight(0, 2.0, 100.0, 100 * DEG)
    rig = builtin_rigs()["vertical-limited"]
    x = np.random.default_rng(0).normal(0.0, 0.02, (len(t), 4)).cumsum(axis=0).clip(-1, 1)
    missed = np.arange(len(t)) % 3 > 0
    whole = active_limits(t, dcm_from_quaternion(q), x, rig, missed)
    monkeypatch.setattr(import_module("fullpose.plan.active_limits"), "CHUNK", 17)
    assert np.array_equal(active_limits(t, dcm_from_quaternion(q), x, rig, missed), whole)


def test_a_frame_without_room_is_named_only_where_there_is_nothing_else():
    held = FrameLimits(0.3, 0.3, home=0.3)
    t = TIME[:10]
    x = np.tile([0.3, 0.1, 0.1, 0.1], (10, 1))
    missed = np.ones(10, np.bool_)
    C = payload_attitudes(RIG, x + np.array([0.2, 0.0, 0.0, 0.0]))
    alone = Rig("held", Geometry.VERTICAL_4, (held, FREE, FREE, FREE))
    assert (active_limits(t, C, x, alone, missed) == limited_code(0, 0)).all()
    other = Rig("held", Geometry.VERTICAL_4, (held, FREE, FREE, FrameLimits(-0.1, 0.1)))
    assert (active_limits(t, C, x, other, missed) == limited_code(3, 0)).all()
