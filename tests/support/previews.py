"""Flights for the preview's tests, and what every one of them must keep to."""

from dataclasses import replace
from typing import Any

from numpy.typing import NDArray

from fullpose._typing import Array
from fullpose.attitude import dcm_from_quaternion
from fullpose.bounds import EXACT
from fullpose.preview.options import PreviewOptions
from fullpose.rig import Rig, builtin_rigs
from fullpose.scenarios import DEG, random_flight
from fullpose.verify import attitude_errors, payload_attitudes, verify

RIGS = builtin_rigs()
LIMITED = RIGS["vertical-limited"]
HORIZONTAL = replace(RIGS["horizontal-4"], frames=LIMITED.frames)
EXACT_WITHIN = 1e-12  # [rad]


def flight(seed: int, seconds: float, rate_deg: float, hz: float = 100.0) -> tuple[Array, Array]:
    """(time (n,) [s], attitude (n, 3, 3))."""
    time, q = random_flight(seed, seconds, hz, rate_deg * DEG)
    return time, dcm_from_quaternion(q)


def fast(**changes: Any) -> PreviewOptions:
    """Options whose search is narrow."""
    return PreviewOptions(**{"beam": 32, **changes})


def check(rig: Rig, time: Array, attitude: Array, angles: Array, limited: NDArray[Any]) -> None:
    """No limit is exceeded, and what is not marked is exact."""
    found = verify(time, angles, rig)
    assert not found.violations, found.violations[:3]
    error, _ = attitude_errors(payload_attitudes(rig, angles), attitude)
    assert (error[limited == EXACT] < EXACT_WITHIN).all()
