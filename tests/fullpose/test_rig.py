"""Rigs say what they are, and refuse to be what cannot be."""

import math

import numpy as np
import pytest

from fullpose.errors import RigError
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs


def rig_with(frame: FrameLimits) -> Rig:
    return Rig("test", Geometry.VERTICAL_4, (frame, FrameLimits(), FrameLimits(), FrameLimits()))


@pytest.mark.parametrize(
    ("frame", "field"),
    [
        (FrameLimits(min=1.0, max=-1.0), "frames.base"),
        (FrameLimits(min=math.nan, max=1.0), "frames.base"),
        (FrameLimits(min=-1.0), "frames.base"),
        (FrameLimits(min=-1.0, max=1.0, home=2.0), "frames.base.home"),
        (FrameLimits(max_rate=0.0), "frames.base.max_rate"),
        (FrameLimits(max_rate=math.nan), "frames.base.max_rate"),
        (FrameLimits(max_acceleration=-1.0), "frames.base.max_acceleration"),
        (FrameLimits(max_jerk=0.0), "frames.base.max_jerk"),
        (FrameLimits(max_jerk=-1.0), "frames.base.max_jerk"),
        (FrameLimits(weight=math.inf), "frames.base.weight"),
    ],
)
def test_impossible_frames_are_refused(frame: FrameLimits, field: str) -> None:
    with pytest.raises(RigError) as caught:
        rig_with(frame)
    assert caught.value.field == field


def test_columns_of_a_three_axis_rig() -> None:
    rig = builtin_rigs()["vertical-3"]
    assert rig.position_min[0] == rig.position_max[0] == 0.0
    assert not rig.geometry.redundant
    assert rig.geometry.frames == (1, 2, 3)
    assert rig.axes.tolist() == [-1, 1, 2, 0]


def test_builtin_rigs() -> None:
    rigs = builtin_rigs()
    assert set(rigs) == {"vertical-4", "horizontal-4", "vertical-3", "horizontal-3", "vertical-limited"}
    np.testing.assert_allclose(np.degrees(rigs["vertical-limited"].position_max[3]), 60.0)
    assert rigs["vertical-4"].frames[3].continuous
    with pytest.raises(ValueError, match="read-only"):
        rigs["vertical-4"].weight[0] = 2.0
