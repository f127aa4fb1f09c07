"""The plan of a three-axis rig: Euler angles in the best turns, and a verdict."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler
from fullpose.plan import plan
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import verify

DEG = np.pi / 180.0
RIGS = builtin_rigs()
TIME = np.arange(0.0, 4.0, 0.005)


@pytest.mark.parametrize("name", ["vertical-3", "horizontal-3"])
def test_away_from_the_pole_it_flies_exactly(name):
    C = dcm_from_euler(2.0 * np.sin(TIME), 0.8 * np.sin(2 * TIME), 3.0 * np.sin(0.7 * TIME))
    if name == "horizontal-3":
        C = dcm_from_euler(0.8 * np.sin(TIME), 2.0 * np.sin(TIME), 3.0 * np.sin(0.7 * TIME))
    made = plan(TIME, C, RIGS[name])
    assert made.verdict.feasible
    found = verify(TIME, made.solution.angles, RIGS[name], C)
    assert found.violations == ()
    assert found.max_matrix_error < 5e-15
    assert (made.solution.angles[:, 0] == 0.0).all()


def test_the_pitch_frame_goes_over_the_top():
    C = dcm_from_euler(0.3, 2.0 * TIME, 0.2)  # a loop: through the pole, with nothing for the yaw to do
    rig = RIGS["vertical-3"]
    made = plan(TIME, C, rig)
    assert made.verdict.feasible
    assert np.ptp(made.solution.angles[:, 2]) == pytest.approx(2.0 * TIME[-1], abs=1e-9)
    assert made.solution.matrix_error.max() < 5e-15


def test_past_the_pole_it_is_refused_and_kept_inside():
    C = dcm_from_euler(1.5 * np.sin(TIME), 88 * DEG * np.sin(TIME), 0.5 * TIME)
    rig = RIGS["vertical-3"]
    C = C @ dcm_from_euler(0.0, 0.0, 0.05)[0]  # not through the pole but beside it: the yaw has to swing round
    made = plan(TIME, C, rig)
    assert not made.verdict.feasible
    assert made.verdict.decided_by == "three-axis"
    assert made.verdict.blocking.frame == "outer"
    assert verify(TIME, made.solution.angles, rig).violations == ()
    assert made.solution.limited_samples > 0


def test_turns_fit_a_range_that_is_not_about_zero():
    frames = (FrameLimits(), FrameLimits(180 * DEG, 540 * DEG, home=360 * DEG), FrameLimits(), FrameLimits())
    rig = Rig("shifted", Geometry.VERTICAL_3, frames)
    C = dcm_from_euler(100 * DEG * np.sin(TIME), 0.2, 0.1)
    made = plan(TIME, C, rig)
    assert made.verdict.feasible
    assert made.solution.angles[:, 1].min() == pytest.approx((360 + 100 * np.sin(TIME).min()) * DEG, abs=1e-9)
