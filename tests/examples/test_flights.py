"""The flights of examples/flights/: flown as their README says, and flown again to the same bytes."""

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_quaternion, quaternion_from_ned
from fullpose.plan import plan
from fullpose.registry import method_options, parse_variant
from fullpose.resample import resample
from fullpose.rig import builtin_rigs
from fullpose.solve import solve
from fullpose.verify import verify
from fullpose_server.cli import demo
from tests.support.repository import ROOT
from tools.fly_flights import DEMO, FLIGHTS, RATE_HZ, fly, table

# JSBSim hands its matrices over as numpy.matrix, which NumPy frowns on.
pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass:PendingDeprecationWarning")

FOLDER = ROOT / "examples" / "flights"


def read(name: str) -> tuple[NDArray[np.float64], Rotation]:
    """Time (n,) [s] and the active body-from-NED rotation, read with nothing of the project's."""
    path = FOLDER / f"{name}.csv"
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    header = path.read_text().splitlines()[0]
    if header == "time_s,qw,qx,qy,qz":
        return rows[:, 0], Rotation.from_quat(rows[:, 1:], scalar_first=True)
    return rows[:, 0], Rotation.from_euler("ZYX", rows[:, 1:], degrees=True)


def turned_deg(time: NDArray[np.float64], body: Rotation) -> NDArray[np.float64]:
    """The body rate p, q, r integrated over the flight (3,) [deg]."""
    return np.degrees((body[:-1].inv() * body[1:]).as_rotvec().sum(axis=0))


@pytest.mark.parametrize("name", FLIGHTS)
def test_files_are_uniform_gentle_and_small(name: str) -> None:
    time, body = read(name)
    assert (FOLDER / f"{name}.csv").stat().st_size < 1_500_000
    np.testing.assert_allclose(np.diff(time), 1.0 / RATE_HZ, atol=1e-9)
    assert 10.0 <= time[-1] <= 45.0
    rate = np.degrees((body[:-1].inv() * body[1:]).magnitude()) * RATE_HZ
    assert rate[0] < 0.01, "begins in trimmed flight, at rest"
    assert rate.max() < 90.0, "an aircraft's rates, and no jump between rows"


def test_loop_pitches_through_both_verticals_and_a_full_turn() -> None:
    time, body = read("loop")
    nose, wing, belly = (body.apply(axis) for axis in np.eye(3))
    p, q, r = turned_deg(time, body)
    assert q == pytest.approx(360.0, abs=5.0)
    assert abs(p) < 5.0
    assert abs(r) < 5.0
    up, over, down = np.argmin(nose[:, 2]), np.argmin(belly[:, 2]), np.argmax(nose[:, 2])
    assert nose[up, 2] < -0.998
    assert belly[over, 2] < -0.998
    assert nose[down, 2] > 0.998
    assert up < over < down
    assert np.abs(wing[:, 2]).max() < 0.06, "the wings stay near the horizon"
    assert nose[-1] @ nose[0] > 0.99


def test_slow_roll_banks_through_a_full_turn_on_one_heading() -> None:
    _, body = read("slow_roll")
    heading, pitch, bank = np.unwrap(body.as_euler("ZYX"), axis=0).T
    assert np.degrees(bank[-1] - bank[0]) == pytest.approx(-360.0, abs=2.0)
    assert np.degrees(pitch).max() < 15.0
    assert np.degrees(np.abs(heading - heading[0])).max() < 10.0


def test_split_s_goes_inverted_then_down_and_out_the_other_way() -> None:
    _, body = read("split_s")
    nose, _, belly = (body.apply(axis) for axis in np.eye(3))
    down = int(np.argmax(nose[:, 2]))
    assert belly[: down // 2, 2].min() < -0.98, "inverted before the pull"
    assert nose[down, 2] > 0.99
    assert belly[-1, 2] > 0.99
    assert nose[-1] @ nose[0] < -0.98


@pytest.mark.parametrize("name", FLIGHTS)
def test_flown_again_writes_the_same_bytes(name: str) -> None:
    flight = FLIGHTS[name]
    once = table(flight, *fly(flight, seconds=3.0))
    assert once == table(flight, *fly(flight, seconds=3.0))
    # The committed file may come from another processor, whose last digits differ; 3 s do not let that grow.
    with (FOLDER / f"{name}.csv").open() as file:
        committed = list(itertools.islice(file, 1 + 3 * RATE_HZ + 1))
    again = once.splitlines()
    assert again[0] == committed[0].strip()
    np.testing.assert_allclose(
        np.loadtxt(again[1:], delimiter=","), np.loadtxt(committed[1:], delimiter=","), rtol=0.0, atol=1e-6
    )


def demo_flight(rate_hz: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Time (n,) [s] and attitude (n, 3, 3), body from reference, of the demo's flight."""
    rows = np.loadtxt(FOLDER / f"{DEMO}.csv", delimiter=",", skiprows=1)
    flight = resample(rows[:, 0], quaternion_from_ned(rows[:, 1:]), rate_hz)
    return flight.time, dcm_from_quaternion(flight.q)


def test_demo_flight_is_flown_exactly_on_the_demo_rig_and_touches_a_limit() -> None:
    """`fullpose demo` plans it for vertical-limited at 1 kHz: exact at every sample and inside every limit."""
    time, attitude = demo_flight(1000.0)
    rig = builtin_rigs()[demo.RIG]
    solution = solve(time, attitude, rig, method=demo.METHOD)
    check = verify(time, solution.angles, rig, attitude)
    assert check.max_matrix_error < 1e-14
    assert solution.limited_samples == 0
    assert not check.violations
    # The inner frame comes to the end of its range, and stays inside it.
    nearest = np.min(rig.position_max - solution.angles, axis=0)
    assert 0.0 <= nearest[3] < np.radians(0.01)
    # No faster than half of what it may: an operator's first flight should look calm.
    assert (check.peaks[:, 1] < 0.5 * rig.max_rate).all()
    assert (check.peaks[:, 2] < 0.5 * rig.max_acceleration).all()


@pytest.mark.parametrize("name", ["vertical-3", "horizontal-3"])
def test_no_three_axis_table_flies_the_demo_flight(name: str) -> None:
    """Its nose goes by what each of them is singular at, faster than the outer frame can turn."""
    time, attitude = demo_flight(200.0)
    planned = plan(time, attitude, builtin_rigs()[name])
    assert not planned.verdict.feasible
    assert planned.verdict.statement.startswith("Infeasible")


def test_demo_flight_is_the_example() -> None:
    packaged = ROOT / "server/fullpose_server/demo_flights" / demo.FLIGHT
    assert packaged.read_bytes() == (FOLDER / f"{DEMO}.csv").read_bytes()


def feasible(method: str, rig_name: str, name: str) -> bool:
    """Whether a method flies a flight exactly and inside the limits."""
    time, body = read(name)
    rig, attitude = builtin_rigs()[rig_name], in_our_axes(body)
    asked = parse_variant(method)
    options = method_options(asked.method, asked.options)
    solution = solve(time, attitude, rig, asked.method, options)
    check = verify(time, solution.angles, rig, attitude)
    return solution.limited_samples == 0 and check.max_matrix_error < 1e-13 and not check.violations


@pytest.mark.parametrize("name", FLIGHTS)
@pytest.mark.parametrize("rig", ["vertical-4", "horizontal-4"])
@pytest.mark.parametrize("method", ["plan", "exact", "alm:mode=exact", "fixed_joint", "follow_up"])
def test_these_methods_fly_all_of_them(method: str, rig: str, name: str) -> None:
    """What the flights' README says; of preview too, which takes a minute a flight."""
    assert feasible(method, rig, name)


@pytest.mark.parametrize(
    ("method", "rig", "name"),
    [("dwln", "horizontal-4", "loop"), ("three_axis", "vertical-4", "loop"), ("clamped", "vertical-4", "split_s")],
)
def test_these_methods_do_not(method: str, rig: str, name: str) -> None:
    assert not feasible(method, rig, name)


def in_our_axes(body: Rotation) -> NDArray[np.float64]:
    """C (n, 3, 3), body from reference, of the active body-from-NED rotation."""
    change = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # ours from NED: north, up, east
    return np.asarray(change @ body.as_matrix().transpose(0, 2, 1) @ change.T)


@pytest.mark.parametrize("name", ["slow_roll", "split_s"])
def test_rolls_need_the_planner_where_the_inner_frame_is_limited(name: str) -> None:
    """What the flights' README says of vertical-limited."""
    time, body = read(name)
    time, body = time[::2], body[::2]  # 100 Hz shows it as well
    attitude = in_our_axes(body)
    rig = builtin_rigs()["vertical-limited"]
    assert solve(time, attitude, rig, method="exact").limited_samples > 0
    planned = solve(time, attitude, rig, method="plan")
    check = verify(time, planned.angles, rig, attitude)
    assert planned.limited_samples == 0
    assert check.max_matrix_error < 1e-14
    assert not check.violations
