"""What noise costs the frames, against accelerations that are drawn and shared out by SciPy's least squares."""

import numpy as np
import pytest
from scipy.linalg import lstsq

from fullpose import builtin_rigs
from fullpose.recorded.frame_noise import frame_noise_acceleration
from fullpose.verify import payload_attitudes


@pytest.mark.parametrize("name", ["vertical-4", "horizontal-4", "vertical-3", "horizontal-3"])
def test_it_is_the_spread_of_what_drawn_accelerations_ask_of_the_frames(name: str) -> None:
    rig, random = builtin_rigs()[name], np.random.default_rng(0)
    body = np.array([3.0, 1.0, 0.5])
    angles = random.uniform(-0.8, 0.8, (4, 4)) + np.array([0.0, 0.9, 0.0, 0.0])
    angles[:, [i for i in range(4) if i not in rig.geometry.frames]] = 0.0
    found = frame_noise_acceleration(rig, angles, body)
    for pose, row in zip(angles, found, strict=True):
        moved = np.stack([payload_attitudes(rig, pose + 1e-6 * unit[None, :]) for unit in np.eye(4)])[:, 0]
        W = (moved - payload_attitudes(rig, pose[None, :])) @ payload_attitudes(rig, pose[None, :])[0].T / 1e-6
        J = np.stack([W[:, 1, 2], W[:, 2, 0], W[:, 0, 1]])  # C' C^T = -[w]x
        frames = lstsq(J, body[:, None] * random.normal(size=(3, 20_000)))[0]
        np.testing.assert_allclose(row, frames.std(axis=1), rtol=0.05, atol=1e-3)


def test_body_noise_of_zero_costs_nothing() -> None:
    cost = frame_noise_acceleration(builtin_rigs()["vertical-4"], np.zeros((3, 4)), np.zeros(3))
    np.testing.assert_array_equal(cost, 0.0)
