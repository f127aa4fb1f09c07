"""The guarantee of `preview` (mathematics, sections 4 and 9): no limit is ever exceeded, whatever limits a rig has."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT, limited_name
from fullpose.preview.options import PreviewOptions
from fullpose.rig import FrameLimits, Geometry, Rig
from fullpose.scenarios import random_flight
from fullpose.solve import solve
from fullpose.verify import verify

DEG = np.pi / 180.0


@st.composite
def frames(draw):
    """A frame with some of the limits only, from ranges of a degree to several turns."""
    value = {}
    if draw(st.booleans()):
        span = draw(st.sampled_from([1.0, 30.0, 90.0, 400.0, 1000.0])) * DEG
        low = draw(st.floats(-1.0, 0.0)) * span
        value |= {"min": low, "max": low + span, "home": low + draw(st.floats(0.0, 1.0)) * span}
    if draw(st.booleans()):
        value["max_rate"] = draw(st.floats(1.0, 600.0)) * DEG
    if draw(st.booleans()):
        value["max_acceleration"] = draw(st.floats(5.0, 4000.0)) * DEG
    return FrameLimits(**value)


def rigs(geometries):
    return st.builds(Rig, st.just("some limits"), st.sampled_from(geometries), st.tuples(*[frames()] * 4))


@settings(max_examples=30)
@given(
    rigs([Geometry.VERTICAL_4, Geometry.HORIZONTAL_4]),
    st.integers(0, 1000),
    st.sampled_from([20.0, 100.0, 400.0]),
    st.sampled_from([(0.0, 0.0), (0.5, 0.1)]),
    st.booleans(),
)
def test_no_limit_is_exceeded_on_any_rig(rig, seed, rate, previewed, uneven):
    t, q = random_flight(seed, 1.0, 100.0, rate * DEG)
    if uneven:
        t = t + np.random.default_rng(seed).uniform(-0.004, 0.004, len(t))
    options = PreviewOptions(preview_s=previewed[0], delay_s=previewed[1], beam=16, replan_s=0.2)
    C = dcm_from_quaternion(q)
    made = solve(t, C, rig, "preview", options=options)
    assert verify(t, made.angles, rig).violations == ()
    assert made.error[made.limited == EXACT].max(initial=0.0) < 1e-12
    for code in np.unique(made.limited[made.limited != EXACT]):
        frame, limit = limited_name(int(code))
        limits = rig.frames[("base", "outer", "middle", "inner").index(frame)]
        assert np.isfinite(
            {"position": limits.max, "rate": limits.max_rate, "acceleration": limits.max_acceleration}[limit]
        )


@pytest.mark.parametrize(
    "limits", [FrameLimits(-0.3, 0.3), FrameLimits(max_rate=0.2), FrameLimits(max_acceleration=0.2)]
)
@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
def test_one_kind_of_limit_is_kept(limits, geometry):
    t, q = random_flight(4, 2.0, 100.0, 200 * DEG)
    rig = Rig("one kind", geometry, (limits,) * 4)
    made = solve(t, dcm_from_quaternion(q), rig, "preview", options=PreviewOptions(preview_s=0.5, beam=16))
    assert verify(t, made.angles, rig).violations == ()
    assert made.limited_samples
