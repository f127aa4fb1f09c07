"""The charts next to their folds: the attitude stays exact where one of the angles is not determined."""

import numpy as np
import pytest

from fullpose.charts import base_chart, inner_chart, project
from fullpose.kinematics import matrix_error, payload_attitude
from fullpose.rig import builtin_rigs


@pytest.mark.parametrize("distance", [1.0, 1e-4, 1e-8, 1e-12, 1e-16, 0.0])
@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4"])
def test_exact_next_to_the_singularity_of_the_rig(name: str, distance: float) -> None:
    rig = builtin_rigs()[name]
    horizontal = rig.geometry.horizontal
    random = np.random.default_rng(1)
    C, F, out = np.empty((3, 3)), np.empty((3, 3)), np.empty(4)
    worst = 0.0
    for _ in range(300):
        pole = np.array([0.0, random.choice([0.0, np.pi]), random.choice([-0.5, 0.5]) * np.pi, 0.0])
        d = pole + np.array([3.0, distance, distance, 3.0]) * random.uniform(-1.0, 1.0, 4)
        payload_attitude(rig.axes, d, C)
        branch = 1.0 if np.cos(d[2]) >= 0.0 else -1.0
        base_chart(horizontal, C, d[0], branch, out)
        payload_attitude(rig.axes, out, F)
        worst = max(worst, matrix_error(F, C))
        inner_chart(horizontal, C, d[3], branch, out)
        payload_attitude(rig.axes, out, F)
        worst = max(worst, matrix_error(F, C))
        project(horizontal, C, d, out)
        payload_attitude(rig.axes, out, F)
        worst = max(worst, matrix_error(F, C))
    assert worst < 3e-15
