"""What every method owes: finite angles on every scenario, errors told by the angles, limits kept where claimed."""

import math
from dataclasses import fields

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion
from fullpose.errors import MethodError
from fullpose.methods import METHODS
from fullpose.methods.alm import AlmOptions
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.scenarios import SCENARIOS, random_flight
from fullpose.verify import attitude_errors, payload_attitudes, verify

RIGS = builtin_rigs()
EXACT = ("exact", "dwln", "fixed_joint", "follow_up", "three_axis")
CLAIMING = [name for name, method in METHODS.items() if method.claims_limits]
ORDER = "exact alm dwln lagrange weighted gradient_projection fixed_joint clamped follow_up three_axis"


def test_the_registry() -> None:
    assert list(METHODS) == ORDER.split()
    assert CLAIMING == ["exact", "alm", "clamped"]
    for method in METHODS.values():
        assert method.source
        assert all(isinstance(field.default, (bool, int, float, str)) for field in fields(method.options))


def base_rig(geometry: Geometry, base: FrameLimits) -> Rig:
    return Rig("base", geometry, (base, FrameLimits(), FrameLimits(), FrameLimits()))


SLOW_BASE = FrameLimits(max_rate=math.radians(10.0), max_acceleration=math.radians(20.0))
ODD_RIGS = {
    "horizontal": RIGS["horizontal-4"],
    "slow base": base_rig(Geometry.VERTICAL_4, SLOW_BASE),
    "slow base, horizontal": base_rig(Geometry.HORIZONTAL_4, SLOW_BASE),
    "locked base": base_rig(Geometry.VERTICAL_4, FrameLimits(0.0, 0.0)),
}


@pytest.mark.parametrize("kind", ["its own", *ODD_RIGS])
@pytest.mark.parametrize("name", SCENARIOS)
def test_no_scenario_breaks_a_method(name: str, kind: str) -> None:
    scenario = SCENARIOS[name]
    rig = ODD_RIGS.get(kind, RIGS[scenario.rig])
    time, C = scenario.time, dcm_from_quaternion(scenario.quaternion)
    start = None if scenario.start is None else np.clip(scenario.start, rig.position_min, rig.position_max)
    for key, method in METHODS.items():
        block = method.stepper(rig, method.options(), start, C[0]).block(time, C)
        assert np.isfinite(block.angles).all(), key
        assert np.abs(block.angles).max() < 1e3, key
        assert block.limited.shape == block.iterations.shape == time.shape
        assert block.limited.min() >= 0
        assert block.limited.max() <= 12
        result = verify(time, block.angles, rig, C)
        if method.claims_limits:
            assert not result.violations, key
            # A sample that misses the attitude is marked. Only alm's step may miss it unmarked: where it settled, by
            # its linearisation, no more than half the square of the frames' ways; at its cap, by what was left.
            error, _ = attitude_errors(payload_attitudes(rig, block.angles), C)
            steps = np.abs(np.diff(block.angles, axis=0, prepend=block.angles[:1])).sum(axis=1)
            left = 0.5 * steps**2 if key == "alm" else 0.0 * steps
            claimed = (block.limited == 0) & ((key != "alm") | (block.iterations < AlmOptions().max_iterations))
            assert (error[claimed] <= left[claimed] + math.radians(1e-9)).all(), key
        elif key in EXACT:
            assert result.max_matrix_error < 5e-14, key


def narrow_rig(geometry: Geometry) -> Rig:
    """Tight positions, rates and accelerations on every frame but the base."""
    degree = math.pi / 180.0
    return Rig(
        "narrow",
        geometry,
        (
            FrameLimits(max_rate=120 * degree, max_acceleration=300 * degree),
            FrameLimits(-100 * degree, 100 * degree, 150 * degree, 500 * degree),
            FrameLimits(-80 * degree, 70 * degree, 150 * degree, 700 * degree),
            FrameLimits(-60 * degree, 60 * degree, 300 * degree, 2000 * degree),
        ),
    )


@pytest.mark.parametrize("name", CLAIMING)
@pytest.mark.parametrize("geometry", [Geometry.VERTICAL_4, Geometry.HORIZONTAL_4])
@pytest.mark.parametrize("body_rate_deg_s", [30.0, 120.0, 400.0])
def test_limits_that_are_claimed_are_kept(name: str, geometry: Geometry, body_rate_deg_s: float) -> None:
    rig = narrow_rig(geometry)
    method = METHODS[name]
    for seed in range(4):
        time, q = random_flight(seed, 3.0, 500.0, math.radians(body_rate_deg_s))
        C = dcm_from_quaternion(q)
        angles = method.stepper(rig, method.options(), None, C[0]).block(time, C).angles
        over = np.maximum(rig.position_min - angles, angles - rig.position_max).max()
        assert over <= math.radians(1e-9)
        assert not verify(time, angles, rig).violations


@pytest.mark.parametrize("name", METHODS)
def test_blocks_do_not_matter(name: str) -> None:
    time, q = random_flight(5, 0.3, 1000.0, 2.0)
    C = dcm_from_quaternion(q)
    method = METHODS[name]
    whole = method.stepper(RIGS["vertical-4"], method.options(), None, C[0]).block(time, C)
    stepper = method.stepper(RIGS["vertical-4"], method.options(), None, C[0])
    parts = [stepper.block(time[k : k + 7], C[k : k + 7]) for k in range(0, time.size, 7)]
    np.testing.assert_array_equal(np.concatenate([part.angles for part in parts]), whole.angles)
    np.testing.assert_array_equal(np.concatenate([part.iterations for part in parts]), whole.iterations)


@pytest.mark.parametrize("name", [name for name in METHODS if name != "three_axis"])
def test_three_axis_rigs_are_refused_with_advice(name: str) -> None:
    method = METHODS[name]
    with pytest.raises(MethodError, match="three_axis"):
        method.stepper(RIGS["vertical-3"], method.options(), None, np.eye(3))


@pytest.mark.parametrize(
    ("name", "option", "value"),
    [
        ("dwln", "max_iterations", 0),
        ("dwln", "tolerance", math.nan),
        ("weighted", "near", 0.0),
        ("gradient_projection", "limits", -1.0),
        ("fixed_joint", "max_rate", math.inf),
        ("clamped", "recovery", 0.0),
        ("follow_up", "back_beyond", 0.1),
        ("follow_up", "bandwidth", 0.0),
    ],
)
def test_options_out_of_range_are_refused(name: str, option: str, value: float) -> None:
    with pytest.raises(MethodError, match=option):
        METHODS[name].options(**{option: value})
