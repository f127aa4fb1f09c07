"""The equality-constrained step, open loop."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_quaternion
from fullpose.kinematics import jacobian, matrix_error, payload_attitude
from fullpose.methods.lagrange import METHOD, LagrangeOptions
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.verify import verify

RIGS = builtin_rigs()


@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
def test_a_step_satisfies_the_kkt_system(geometry: Geometry) -> None:
    weights = (2.0, 0.5, 1.0, 3.0)
    base, outer, middle, inner = (FrameLimits(weight=w) for w in weights)
    rig = Rig("weighted", geometry, (base, outer, middle, inner))
    time, q = random_flight(1, 0.2, 100.0, 3.0)
    C = dcm_from_quaternion(q)
    angles = METHOD.stepper(rig, LagrangeOptions(), None, C[0]).block(time, C).angles
    r = Rotation.from_quat(q, scalar_first=True)
    increments = (r[:-1].inv() * r[1:]).as_rotvec()
    J = np.empty((3, 4))
    for d, x, e in zip(angles[:-1], angles[1:], increments, strict=True):
        jacobian(rig.axes, d, J)
        kkt = np.block([[np.diag(weights), J.T], [J, np.zeros((3, 3))]])
        expected = np.linalg.solve(kkt, np.concatenate([np.zeros(4), e]))[:4]
        np.testing.assert_allclose(x - d, expected, atol=1e-12)


@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
def test_small_angles_within_the_published_order(rig: str) -> None:
    """Published (Zhao 2025): 1e-4 to 1e-5 at small angles; the drift is of first order in the step."""
    scenario = SCENARIOS["small_angles"]
    time, C = scenario.time, dcm_from_quaternion(scenario.quaternion)

    def error(every: int) -> float:
        stepper = METHOD.stepper(RIGS[rig], LagrangeOptions(), None, C[0])
        angles = stepper.block(time[::every], C[::every]).angles
        return verify(time[::every], angles, RIGS[rig], C[::every]).max_matrix_error

    assert 1e-7 < error(1) < 1e-4
    assert error(4) == pytest.approx(4.0 * error(1), rel=0.1)


def test_starts_exact() -> None:
    _, q = random_flight(2, 0.1, 100.0, 1.0)
    C = dcm_from_quaternion(q)
    first = METHOD.stepper(RIGS["vertical-4"], LagrangeOptions(), None, C[0]).block(np.zeros(1), C[:1]).angles[0]
    F = np.empty((3, 3))
    payload_attitude(RIGS["vertical-4"].axes, first, F)
    assert matrix_error(F, C[0]) < 1e-14
