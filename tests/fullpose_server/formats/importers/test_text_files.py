"""Text files as people and tools write them: each is the flight, or says what it is. The truth is SciPy's rotations."""

import gzip
from pathlib import Path

import numpy as np
import pytest

from fullpose_server.errors import FileError
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory import Convention, Trajectory
from fullpose_server.formats.trajectory_file import read_trajectory
from tests.support.attitudes import attitude_error_deg
from tests.support.flight_texts import (
    EULER,
    FILES,
    MILLISECONDS,
    PLAIN,
    RAD,
    SEMICOLON,
    TIME,
    TRUTH,
    B,
    H,
    P,
    W,
    X,
    Y,
    Z,
    rows_of,
    text,
)

RESOLUTION_DEG = 1e-9


def read(folder: Path, content: str | bytes, convention: str | None = None, **said: object) -> Trajectory:
    path = folder / "flight.txt"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    options = ReadOptions(None if convention is None else Convention(convention), **said)  # type: ignore[arg-type]
    return read_trajectory(path, name="flight.txt", options=options)


@pytest.mark.parametrize("kind", list(FILES))
def test_it_is_the_flight(tmp_path: Path, kind: str) -> None:
    content, profile, convention = FILES[kind]
    flight = read(tmp_path, content, convention)
    assert flight.taken.profile == profile
    ours = flight.convention
    assert ours is (Convention.ENU if kind.startswith("ROS") else Convention.NED)
    assert attitude_error_deg(flight, TRUTH, ours) < RESOLUTION_DEG
    np.testing.assert_allclose(flight.time - flight.time[0], TIME, atol=1e-7)
    assert f"axes {ours}" in flight.taken.statement


def test_a_profile_that_is_asked_for(tmp_path: Path) -> None:
    content = "timestamp,Rig/Yaw,Rig/Pitch,Rig/Roll\n" + rows_of(MILLISECONDS, H, P, B)
    flight = read(tmp_path, content, "ned", profile="veristand")
    assert attitude_error_deg(flight, TRUTH, "ned") < RESOLUTION_DEG
    np.testing.assert_allclose(flight.time, TIME, atol=1e-12)


def test_assumed_axes_are_a_warning_and_said_ones_are_none(tmp_path: Path) -> None:
    content, _, _ = FILES["TUM"]
    assert [caution.code for caution in read(tmp_path, content).warnings] == ["axes"]
    assert not read(tmp_path, content, "enu").warnings


def test_what_was_taken_is_said(tmp_path: Path) -> None:
    content = text("time_s,qw,qx,qy,qz", [TIME, W, X, Y, Z])
    assert "no convention was given, nue is taken" in read(tmp_path, content).taken.statement
    content = text("time_s,yaw_deg,pitch_deg,roll_deg", EULER)
    assert "opposite to a heading" in read(tmp_path, content).taken.statement


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("#INSPVAA,0.0,0.0,0.0,40.0\n", "';'"),
        (PLAIN.replace(",", "，"), "\\uff0c"),
        ("stk.v.11.0\nBEGIN Attitude\nAttitudeTimeECFVector\n0 1 2 3\n", "AttitudeTimeECFVector"),
        ("CCSDS_AEM_VERS = 1.0\nMETA_START\nATTITUDE_TYPE = SPIN\nMETA_STOP\nDATA_START\nDATA_STOP\n", "SPIN"),
        (gzip.compress(PLAIN.encode())[:-30], "gzip"),
        (text("time,heading,pitch,bank\ns,deg,rad,rad", EULER), "one unit"),
    ],
)
def test_what_is_no_flight_is_named(tmp_path: Path, content: str | bytes, told: str) -> None:
    with pytest.raises(FileError) as caught:
        read(tmp_path, content)
    assert told in str(caught.value)
    assert str(caught.value).isprintable()


def test_lines_of_messages_are_the_files(tmp_path: Path) -> None:
    content = "\ufeff# remark\n" + SEMICOLON.replace("\n0,2;", "\n# half-way\n0,2;").replace("0,4;", "0,4x;")
    with pytest.raises(FileError) as caught:
        read(tmp_path, content.encode("utf-16"))
    assert (caught.value.line, caught.value.column) == (24, "time_s")


def test_a_column_map_of_a_persons_own(tmp_path: Path) -> None:
    content = text("a,b,c,d", [1e3 * TIME, *RAD])
    columns = (
        '{"axes":"ned","time":{"column":"a","unit":"ms"},"euler":{"columns":["b","c","d"],"order":"ZYX","unit":"rad"}}'
    )
    flight = read(tmp_path, content, columns=columns)
    assert attitude_error_deg(flight, TRUTH, "ned") < RESOLUTION_DEG
    with pytest.raises(FileError, match="a column b among"):
        read(tmp_path, PLAIN, columns=columns.replace('"a"', '"time_s"'))
