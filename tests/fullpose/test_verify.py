"""The check: sees every kind of violation, at its time and with its value, and nothing where there is none."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_euler
from fullpose.errors import InputError
from fullpose.rig import builtin_rigs
from fullpose.verify import attitude_errors, payload_attitudes, verify

RIGS = builtin_rigs()
TIME = np.arange(0.0, 1.0, 1e-3)


def still() -> np.ndarray:
    return np.zeros((len(TIME), 4))


def test_nothing_to_report() -> None:
    result = verify(TIME, still(), RIGS["vertical-limited"], np.broadcast_to(np.eye(3), (len(TIME), 3, 3)))
    assert result.violations == ()
    assert result.max_error == 0.0
    assert result.max_matrix_error == 0.0
    assert np.all(result.peaks == 0.0)


def test_position() -> None:
    x = still()
    x[:, 3] = np.linspace(0.9, 1.1, len(TIME))
    (violation,) = verify(TIME, x, RIGS["vertical-limited"]).violations
    assert (violation.frame, violation.limit) == ("inner", "position")
    assert violation.value == pytest.approx(1.1)
    assert violation.time == TIME[-1]
    assert violation.samples == int(np.sum(x[:, 3] > np.pi / 3 + np.deg2rad(1e-9)))


@pytest.mark.parametrize(("beyond_deg", "found"), [(1.3e-7, 1), (1.0e-7, 0)])
def test_a_position_may_be_beyond_by_what_a_touch_of_the_end_is_met_to(beyond_deg: float, found: int) -> None:
    x = still()
    x[:, 3] = np.pi / 3 + np.deg2rad(beyond_deg)
    assert len(verify(TIME, x, RIGS["vertical-limited"]).violations) == found


def test_rate_and_acceleration_each_at_their_sample() -> None:
    x = still()
    x[500:, 1] = 0.01  # 10 rad/s for one interval, 1e4 rad/s^2 up and down
    found = {v.limit: v for v in verify(TIME, x, RIGS["vertical-4"]).violations}
    assert set(found) == {"rate", "acceleration"}
    assert found["rate"].value == pytest.approx(10.0)
    assert found["rate"].time == TIME[500]
    assert abs(found["acceleration"].value) == pytest.approx(1e4)
    assert found["acceleration"].samples == 2


def test_two_separate_runs_are_two_violations() -> None:
    x = still()
    x[100:200, 3] = 1.2
    x[300:310, 3] = -1.3
    positions = [v for v in verify(TIME, x, RIGS["vertical-limited"]).violations if v.limit == "position"]
    assert [v.samples for v in positions] == [100, 10]
    assert [v.value for v in positions] == [1.2, -1.3]


def test_errors_of_uneven_time_use_its_own_differences() -> None:
    time = np.array([0.0, 0.1, 0.4])
    x = np.zeros((3, 4))
    x[:, 0] = [0.0, 0.1, 0.7]
    result = verify(time, x, RIGS["vertical-4"])
    assert result.peaks[0, 1] == pytest.approx(2.0)
    assert result.peaks[0, 2] == pytest.approx((2.0 - 1.0) / 0.2)


def test_attitude_error_of_a_known_turn() -> None:
    rig = RIGS["vertical-4"]
    C = dcm_from_euler(TIME, 0.5 * TIME, 0.0 * TIME)
    turned = Rotation.from_rotvec([0.0, 0.0, 1e-7]).as_matrix() @ C
    angle, matrix = attitude_errors(turned, C)
    np.testing.assert_allclose(angle, 1e-7, rtol=1e-6)
    assert 0.5e-7 < matrix.max() <= 1e-7
    x = still()
    x[:, 3] = 1e-7
    assert verify(TIME, x, rig, payload_attitudes(rig, still())).max_error == pytest.approx(1e-7, rel=1e-6)


def test_a_half_turn_is_pi() -> None:
    angle, _ = attitude_errors(np.diag([1.0, -1.0, -1.0])[None], np.eye(3)[None])
    assert angle[0] == pytest.approx(np.pi)


@pytest.mark.parametrize("samples", [1, 2])
def test_short_flights(samples: int) -> None:
    result = verify(TIME[:samples], still()[:samples], RIGS["vertical-4"])
    assert result.violations == ()
    assert np.isnan(result.max_error)


def test_what_is_no_solution_is_refused() -> None:
    x = still()
    x[7, 2] = np.nan
    with pytest.raises(InputError, match="sample 7"):
        verify(TIME, x, RIGS["vertical-4"])
    with pytest.raises(InputError):
        verify(TIME, still()[:-1], RIGS["vertical-4"])
    with pytest.raises(InputError):
        verify(TIME, still(), RIGS["vertical-4"], np.eye(3)[None])
