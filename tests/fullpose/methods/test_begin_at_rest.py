"""A method that claims the limits takes over a rig that stands, and starts inside its limits from rest."""

import numpy as np
import pytest

from fullpose.kinematics import payload_attitude
from fullpose.methods import METHODS
from fullpose.methods.base import LiveStepper
from fullpose.rig import builtin_rigs

LIVE = sorted(name for name, method in METHODS.items() if method.claims_limits)
DT = 1e-3


@pytest.mark.parametrize("name", LIVE)
def test_from_rest_toward_an_attitude_far_away(name: str) -> None:
    rig = builtin_rigs()["vertical-limited"]
    method = METHODS[name]
    pose = np.radians([5.0, -10.0, 20.0, 30.0])
    here, there = np.empty((3, 3)), np.empty((1, 3, 3))
    payload_attitude(rig.axes, pose, here)
    payload_attitude(rig.axes, np.radians([5.0, 10.0, 10.0, 50.0]), there[0])
    stepper = method.stepper(rig, method.options(), pose, here)
    assert isinstance(stepper, LiveStepper)
    stepper.begin_at_rest(DT)
    angles = [pose]
    angles.extend(stepper.block(np.array([tick * DT]), there).angles[0] for tick in range(1, 400))
    rate = np.diff(angles, axis=0, prepend=[pose]) / DT
    assert (np.abs(rate) <= rig.max_rate * (1 + 1e-6)).all()
    acceleration = np.diff(rate, axis=0) / DT
    assert (np.abs(acceleration) <= rig.max_acceleration * (1 + 1e-6) + 1e-6).all()
    assert np.abs(rate).max() > 0.01  # it has set off
