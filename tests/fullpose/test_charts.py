"""The two charts: exact everywhere, on every branch, at their folds and at the rig's singularity."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fullpose.attitude import dcm_from_euler
from fullpose.charts import base_chart, inner_chart, nearest, project
from fullpose.rig import builtin_rigs
from fullpose.verify import payload_attitudes

RIGS = builtin_rigs()
FOUR = ("vertical-4", "horizontal-4")
CHARTS = {"base": base_chart, "inner": inner_chart}
ANGLE = st.one_of(
    st.floats(-7.0, 7.0), st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, -np.pi, 1e-9, np.pi / 2 + 1e-12])
)
EULER = st.tuples(ANGLE, ANGLE, ANGLE)
POSE = st.tuples(ANGLE, ANGLE, ANGLE, ANGLE).map(np.array)


def matrix_error(name: str, d: NDArray[np.float64], C: NDArray[np.float64]) -> float:
    return float(np.abs(payload_attitudes(RIGS[name], d[None])[0] - C).max())


@pytest.mark.parametrize("name", FOUR)
@pytest.mark.parametrize("chart", CHARTS)
@pytest.mark.parametrize("branch", [1.0, -1.0])
@given(euler=EULER, kept=ANGLE)
def test_every_point_of_a_chart_is_exact(
    name: str, chart: str, branch: float, euler: tuple[float, float, float], kept: float
) -> None:
    C = dcm_from_euler(*euler)[0]
    d = np.empty(4)
    CHARTS[chart](RIGS[name].geometry.horizontal, C, kept, branch, d)
    assert d[0 if chart == "base" else 3] == kept
    assert matrix_error(name, d, C) <= 3e-15
    # The branch: sign of cos d3 in the base chart, of sin d2 (the vertical rig's) in the inner chart.
    sign = np.cos(d[2]) if chart == "base" else (-1.0 if name.startswith("horizontal") else 1.0) * np.sin(d[1])
    assert branch * sign >= -1e-15


@pytest.mark.parametrize("name", FOUR)
@given(d=POSE)
def test_projection_of_a_solution_is_itself(name: str, d: NDArray[np.float64]) -> None:
    """Any pose solves its own attitude, so it stays where it is: branches and turns are kept."""
    C = payload_attitudes(RIGS[name], d[None])[0]
    out = np.empty(4)
    project(RIGS[name].geometry.horizontal, C, d, out)
    assert matrix_error(name, out, C) <= 4e-15
    measure = np.sin(d[1]) ** 2 + np.cos(d[2]) ** 2
    if measure > 1e-6:
        np.testing.assert_allclose(out, d, atol=1e-15 / measure + 4e-15)


@pytest.mark.parametrize("name", FOUR)
@given(d=POSE, off=st.lists(st.floats(-1e-3, 1e-3), min_size=4, max_size=4).map(np.array))
def test_projection_makes_a_near_solution_exact_and_stays_near(
    name: str, d: NDArray[np.float64], off: NDArray[np.float64]
) -> None:
    C = payload_attitudes(RIGS[name], d[None])[0]
    out = d + off
    project(RIGS[name].geometry.horizontal, C, out, out)  # in place
    assert matrix_error(name, out, C) <= 4e-15
    if np.sin(d[1]) ** 2 + np.cos(d[2]) ** 2 > 0.1:
        assert np.abs(out - d).max() < 0.02


@pytest.mark.parametrize("name", FOUR)
def test_projection_at_the_singularity_is_exact(name: str) -> None:
    for outer in (0.0, np.pi):
        for middle in (np.pi / 2, -np.pi / 2):
            d = np.array([0.4, outer, middle, 0.2])
            C = payload_attitudes(RIGS[name], d[None])[0]
            out = np.empty(4)
            project(RIGS[name].geometry.horizontal, C, d, out)
            assert matrix_error(name, out, C) <= 1e-15


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_nearest_turn(angle: float, reference: float) -> None:
    out = nearest(angle, reference)
    assert abs(out - reference) <= np.pi + 1e-9
    turns = (out - angle) / (2.0 * np.pi)
    assert abs(turns - round(turns)) < 1e-9
