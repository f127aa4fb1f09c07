"""A column map is one model in TOML and JSON; what it says of a table is what is flown."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fullpose_server.errors import FileError
from fullpose_server.formats.column_map import ColumnMap, Epoch, EulerMap, QuaternionMap, Sense, TimeMap
from fullpose_server.formats.importers.table import table_of, unit_in_name
from fullpose_server.formats.profile import find_profile, shipped
from fullpose_server.formats.table_flight import flight_of, stamps
from fullpose_server.formats.trajectory import Convention
from tests.support.attitudes import OURS_FROM, attitude_error_deg

ANGLES = np.random.default_rng(7).uniform([-170, -80, -170], [170, 80, 170], (40, 3))  # [deg]
TIME = 0.01 * np.arange(40)


@pytest.mark.parametrize("axes", list(Convention))
@pytest.mark.parametrize("order", ["ZYX", "YZX", "XYZ", "ZXY"])
@pytest.mark.parametrize(("unit", "scale"), [("deg", 1.0), ("rad", np.pi / 180.0), ("centideg", 100.0)])
def test_euler_angles(axes: Convention, order: str, unit: str, scale: float) -> None:
    table = table_of("f", "csv", {"t": TIME, **dict(zip("abc", scale * ANGLES.T, strict=True))})
    euler = EulerMap.model_validate({"columns": ("a", "b", "c"), "order": order, "unit": unit})
    flight = flight_of(table, ColumnMap(axes=axes, time=TimeMap(column="t"), euler=euler))
    truth = Rotation.from_euler(order, ANGLES, degrees=True)
    assert attitude_error_deg(flight, truth, axes) < 1e-9
    assert unit in flight.taken.statement


@pytest.mark.parametrize("axes", list(OURS_FROM))
@pytest.mark.parametrize("sense", list(Sense))
def test_quaternions(axes: Convention, sense: Sense) -> None:
    truth = Rotation.from_euler("ZYX", ANGLES, degrees=True)
    given = truth if sense is Sense.BODY_TO_REFERENCE else truth.inv()
    x, y, z, w = given.as_quat().T
    table = table_of("f", "csv", {"t": TIME, "x": x, "y": y, "z": z, "w": w})
    how = QuaternionMap(columns=("w", "x", "y", "z"), sense=sense)
    flight = flight_of(table, ColumnMap(axes=axes, time=TimeMap(column="t"), quaternion=how))
    assert attitude_error_deg(flight, truth, axes) < 1e-9


@pytest.mark.parametrize(("unit", "count"), [("s", 1), ("ms", 10**3), ("us", 10**6), ("ns", 10**9)])
def test_whole_stamps_since_1970_keep_their_steps(unit: str, count: int) -> None:
    given = 1_700_000_000 * count + np.arange(5, dtype=np.int64)
    how = TimeMap.model_validate({"column": "t", "unit": unit, "epoch": Epoch.FIRST})
    np.testing.assert_array_equal(stamps(given, how), np.arange(5) / count)


def test_a_map_of_a_persons_own_is_toml(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('axes = "enu"\n[time]\ncolumn = "t"\nunit = "ms"\n[quaternion]\ncolumns = ["w", "x", "y", "z"]\n')
    found = find_profile(str(path)).bind(table_of("f", "csv", dict.fromkeys("twxyz", TIME)))
    assert found is not None
    assert (found.axes, found.time.unit, found.columns) == ("enu", "ms", ("t", "w", "x", "y", "z"))
    assert ColumnMap.model_validate_json(found.model_dump_json()) == found


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("axes = 1", "key axes"),
        ('axes = "ned"\n[time]\ncolumn = "t"', "one attitude"),
        ("axes =", "TOML"),
        ('axes = "ned"\ncolour = 1\n[time]\ncolumn = "t"', "key"),
    ],
)
def test_what_is_no_profile_is_told_by_its_key(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(FileError, match=told):
        find_profile(str(path))


def test_a_profile_that_is_not_there_lists_those_that_are() -> None:
    with pytest.raises(FileError, match="fullpose-ned"):
        find_profile("nothing")


def test_every_shipped_profile_says_what_it_is_for() -> None:
    assert {"fullpose", "fullpose-ned", "fullpose-quaternion"} <= shipped().keys()
    assert all(each.about for each in shipped().values())


@pytest.mark.parametrize(
    ("name", "plain", "unit"),
    [("heading [deg]", "heading", "deg"), ("Yaw (°)", "Yaw", "°"), ("q[0]", "q[0]", None), ("t", "t", None)],
)
def test_units_in_brackets(name: str, plain: str, unit: str | None) -> None:
    assert unit_in_name(name) == (plain, unit)
