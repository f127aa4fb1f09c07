"""Every way in which a flight's file can be wrong has one message that says where; good files give the attitude."""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.spatial.transform import Rotation

from fullpose.attitude import dcm_from_quaternion
from fullpose_server.errors import FileError
from fullpose_server.formats.trajectory import Convention, Trajectory, euler_deg
from fullpose_server.formats.trajectory_file import read_trajectory

HEADER = "time_s,yaw_deg,pitch_deg,roll_deg\n"


def read(folder: Path, text: str | bytes, convention: str = "nue") -> Trajectory:
    path = folder / "flight.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_trajectory(path, Convention(convention), "flight.csv")


def refused(folder: Path, text: str | bytes, convention: str = "nue") -> FileError:
    with pytest.raises(FileError) as caught:
        read(folder, text, convention)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("flight.csv")
    return caught.value


def test_euler_columns_are_the_attitude(tmp_path: Path) -> None:
    flight = read(tmp_path, HEADER + "0,30,40,50\n0.5,31,41,51\n")
    expected = Rotation.from_euler("YZX", [[30, 40, 50], [31, 41, 51]], degrees=True).as_matrix().swapaxes(1, 2)
    np.testing.assert_allclose(dcm_from_quaternion(flight.q), expected, atol=1e-15)
    np.testing.assert_array_equal(flight.time, [0.0, 0.5])
    assert not flight.warnings


def test_ned_euler_is_the_same_flight_in_our_axes(tmp_path: Path) -> None:
    ours = read(tmp_path, HEADER + "0,-30,40,50\n1,-31,41,51\n")
    ned = read(tmp_path, "time_s,heading_deg,pitch_deg,bank_deg\n0,30,40,50\n1,31,41,51\n", "ned")
    np.testing.assert_allclose(ned.q, ours.q, atol=1e-15)


def test_ned_quaternion_agrees_with_ned_euler(tmp_path: Path) -> None:
    angles = [[30.0, 40.0, 50.0], [-100.0, -80.0, 170.0]]
    q = Rotation.from_euler("ZYX", angles, degrees=True).as_quat(scalar_first=True)
    rows = "".join(f"{k},{','.join(map(repr, row.tolist()))}\n" for k, row in enumerate(q))
    by_q = read(tmp_path, "time_s,qw,qx,qy,qz\n" + rows, "ned")
    euler = "".join(f"{k},{','.join(map(str, row))}\n" for k, row in enumerate(angles))
    by_euler = read(tmp_path, "time_s,heading_deg,pitch_deg,bank_deg\n" + euler, "ned")
    np.testing.assert_allclose(dcm_from_quaternion(by_q.q), dcm_from_quaternion(by_euler.q), atol=1e-12)


def test_parquet_is_told_by_content_and_is_the_same_flight(tmp_path: Path) -> None:
    columns = {"time_s": [0.0, 1.0], "yaw_deg": [30.0, 31.0], "pitch_deg": [40.0, 41.0], "roll_deg": [50, 51]}
    path = tmp_path / "flight.bin"
    pq.write_table(pa.table(columns), path)
    csv = read(tmp_path, HEADER + "0,30,40,50\n1,31,41,51\n")
    assert read_trajectory(path, Convention.NUE).sha256 == csv.sha256


def test_signs_of_quaternions_are_made_continuous(tmp_path: Path) -> None:
    flight = read(tmp_path, "time_s,qw,qx,qy,qz\n0,1,0,0,0\n1,-1,0,0,0\n2,-1,0,0,0\n3,1,0,0,0\n")
    np.testing.assert_array_equal(flight.q, [[1, 0, 0, 0]] * 4)


def test_more_columns_comments_empty_lines_and_a_byte_order_mark_are_no_obstacle(tmp_path: Path) -> None:
    text = "\ufeff# flown in July\n\n time_s , note,yaw_deg,pitch_deg,roll_deg\n0,a,1,2,3\n\n1,b,20,3,4\n"
    assert read(tmp_path, text).time.tolist() == [0.0, 1.0]


@pytest.mark.parametrize("text", ["", "\n\n", "   \n", "# only a comment\n"])
def test_an_empty_file(tmp_path: Path, text: str) -> None:
    assert "empty" in str(refused(tmp_path, text))


def test_a_header_without_rows(tmp_path: Path) -> None:
    assert "at least one row" in str(refused(tmp_path, HEADER))


@pytest.mark.parametrize(
    ("header", "column"),
    [
        ("yaw_deg,pitch_deg,roll_deg", "time_s"),
        ("time_s,yaw_deg,pitch_deg", "roll_deg"),
        ("time_s,qw,qx,qy", "qz"),
        ("time_s,altitude", "yaw_deg"),
    ],
)
def test_a_missing_column_is_named_with_what_is_there(tmp_path: Path, header: str, column: str) -> None:
    error = refused(tmp_path, header + "\n1,2,3,4\n")
    assert (error.line, error.column) == (1, column)
    assert header.split(",")[-1] in str(error)


def test_both_attitudes_at_once(tmp_path: Path) -> None:
    error = refused(tmp_path, "time_s,yaw_deg,pitch_deg,roll_deg,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n")
    assert "one attitude" in str(error)


def test_columns_of_the_other_convention_say_which_to_ask_for(tmp_path: Path) -> None:
    error = refused(tmp_path, "time_s,heading_deg,pitch_deg,bank_deg\n0,1,2,3\n")
    assert "convention ned" in str(error)


def test_a_column_that_is_there_twice(tmp_path: Path) -> None:
    error = refused(tmp_path, "time_s,yaw_deg,yaw_deg,pitch_deg,roll_deg\n0,1,1,2,3\n")
    assert error.column == "yaw_deg"


@pytest.mark.parametrize("value", ["nan", "NaN", "inf", "-inf"])
def test_a_value_that_is_not_finite(tmp_path: Path, value: str) -> None:
    error = refused(tmp_path, HEADER + f"0,1,2,3\n\n1,1,{value},3\n2,1,2,3\n")
    assert (error.line, error.column) == (4, "pitch_deg")
    assert "finite" in str(error)


@pytest.mark.parametrize("value", ["", "abc", "1 2", "1_0", "0x10"])
def test_a_value_that_is_no_number(tmp_path: Path, value: str) -> None:
    error = refused(tmp_path, HEADER + f"0,1,2,3\n1,1,2,{value}\n")
    assert (error.line, error.column, error.value) == (3, "roll_deg", repr(value))


def test_a_row_of_another_length(tmp_path: Path) -> None:
    error = refused(tmp_path, HEADER + "0,1,2,3\n1,1,2\n")
    assert error.line == 3
    assert "4 columns" in str(error)


def test_a_row_cut_off_at_the_end_of_the_file_is_left_out_and_said(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    path.write_text(HEADER + "0,1,2,3\n1,1,2,3\n2,1,2,")
    flight = read_trajectory(path)
    assert flight.time.tolist() == [0.0, 1.0]
    assert any("4" in caution.message for caution in flight.warnings)


def test_time_that_goes_backward(tmp_path: Path) -> None:
    error = refused(tmp_path, HEADER + "0,1,2,3\n2,1,2,3\n1,1,2,3\n")
    assert (error.line, error.column, error.value) == (4, "time_s", "1")
    assert "backward" in str(error)


def test_time_that_is_there_twice(tmp_path: Path) -> None:
    error = refused(tmp_path, HEADER + "0,1,2,3\n0.1,1,2,3\n0.1,1,2,3\n")
    assert (error.line, error.column) == (4, "time_s")
    assert "twice" in str(error)


def test_a_zero_quaternion(tmp_path: Path) -> None:
    error = refused(tmp_path, "time_s,qw,qx,qy,qz\n0,1,0,0,0\n1,0,0,0,0\n")
    assert error.line == 3
    assert "zero" in str(error)


def test_quaternions_a_little_off_are_normalised_and_told(tmp_path: Path) -> None:
    flight = read(tmp_path, "time_s,qw,qx,qy,qz\n0,1.01,0,0,0\n")
    np.testing.assert_array_equal(flight.q, [[1, 0, 0, 0]])
    assert [caution.code for caution in flight.warnings] == ["norm"]


def test_radians_in_degree_columns_are_pointed_out(tmp_path: Path) -> None:
    flight = read(tmp_path, HEADER + "0,3.1,1.5,-3.1\n1,3.0,1.4,-3.0\n")
    assert any(caution.code == "angle-unit" and "radians" in caution.message for caution in flight.warnings)


def test_degrees_are_not_taken_for_radians(tmp_path: Path) -> None:
    assert not read(tmp_path, HEADER + "0,3.1,1.5,-3.1\n0.5,3.0,14,-3.0\n").warnings


def test_time_in_milliseconds_is_pointed_out(tmp_path: Path) -> None:
    flight = read(tmp_path, HEADER + "0,90,2,3\n10,90,2,3\n20,90,2,3\n")
    assert [caution.code for caution in flight.warnings] == ["time-unit"]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"\x89PNG\r\n\x1a\n" + bytes(range(256)), "a PNG image"),
        (b"\x00" * 100, "another binary file"),
        (b"\x00\x01\x00\x02\x00\x03", "another binary file"),
        (bytes(range(128, 256)) * 20, "another binary file"),
        (b"\x1f\x8b\x08abc", "a gzip file"),
        (b"PK\x03\x04\x00\x00", "a ZIP archive"),
        (b"%PDF-1.7\n\x00", "a PDF document"),
    ],
)
def test_another_file_is_named_for_what_it_is(tmp_path: Path, content: bytes, told: str) -> None:
    assert told in str(refused(tmp_path, content))


def test_parquet_that_is_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "flight.parquet"
    pq.write_table(pa.table({"time_s": [0.0, 1.0]}), path)
    assert "whole Parquet" in str(refused(tmp_path, path.read_bytes()[:-9]))


def test_parquet_with_text_where_numbers_should_be_and_with_nulls(tmp_path: Path) -> None:
    for column, expected in ((["1", "2"], "numbers"), ([1.0, None], "row 2, column yaw_deg")):
        path = tmp_path / "flight.parquet"
        pq.write_table(
            pa.table({"time_s": [0.0, 1.0], "yaw_deg": column, "pitch_deg": [0.0, 0.0], "roll_deg": [0.0, 0.0]}), path
        )
        assert expected in str(refused(tmp_path, path.read_bytes()))


def test_a_missing_header(tmp_path: Path) -> None:
    assert "header" in str(refused(tmp_path, "0,1,2,3\n1,1,2,3\n"))


def test_the_address_is_of_the_flight_not_of_its_spelling(tmp_path: Path) -> None:
    one = read(tmp_path, HEADER + "0,10,20,30\n1,11,21,31\n")
    same = read(tmp_path, "roll_deg,pitch_deg,yaw_deg,time_s\r\n30.0,20.00,1e1,0\r\n31,21,11,1\r\n")
    other = read(tmp_path, HEADER + "0,10,20,30\n1,11,21,31.0000001\n")
    assert one.sha256 == same.sha256 != other.sha256


def test_arrays_are_read_only(tmp_path: Path) -> None:
    flight = read(tmp_path, HEADER + "0,10,20,30\n")
    with pytest.raises(ValueError, match="read-only"):
        flight.q[0, 0] = 2.0
    assert json.dumps([c.message for c in flight.warnings]) == "[]"


def test_lines_that_end_in_cr_alone_are_said_to(tmp_path: Path) -> None:
    for text in (HEADER + "0,1,2,3\n1,1,2,3\n", "# a comment\n" + HEADER + "0,1,2,3\n"):
        error = refused(tmp_path, text.replace("\n", "\r"))
        assert "CR alone" in str(error)
        assert error.line == 1


def test_cells_too_long_to_be_any(tmp_path: Path) -> None:
    long = "1" * 140_000
    assert refused(tmp_path, HEADER.strip() + f",{long}\n0,1,2,3,4\n").line == 1
    assert refused(tmp_path, HEADER + f"0,1,2,3\n1,1,2,{long}x\n").line == 3
    note = "time_s,yaw_deg,pitch_deg,roll_deg,note\n"
    assert refused(tmp_path, note + f"0,1,2,3,{long}\n0,1,2,3,4\n").line == 2


@pytest.mark.parametrize(
    ("first", "second", "line", "value", "told"),
    [
        ("0", "1e-300", 3, "1e-300", "at least"),
        ("-1e308", "1.5e308", 2, "-1e+308", "between"),
        ("0.1", "0.05", 3, "0.05", "after 0.1,"),
    ],
)
def test_times_beyond_reason_and_the_digits_of_the_file(
    tmp_path: Path, first: str, second: str, line: int, value: str, told: str
) -> None:
    error = refused(tmp_path, HEADER + f"{first},1,2,3\n{second},1,2,3\n")
    assert (error.line, error.column, error.value) == (line, "time_s", value)
    assert told in error.expected


def test_parquet_with_whole_numbers_that_no_double_has(tmp_path: Path) -> None:
    path = tmp_path / "flight.parquet"
    columns = {"time_s": [0, 10**18 + 1], "yaw_deg": [0, 2**53 + 1], "pitch_deg": [0, 0], "roll_deg": [0, 0]}
    pq.write_table(pa.table(columns), path)
    error = refused(tmp_path, path.read_bytes())
    assert "row 2, column time_s: 1e+18" in str(error)
    pq.write_table(pa.table(columns | {"time_s": [0, 1]}), path)
    assert read_trajectory(path, Convention.NUE).time.size == 2


def test_a_broken_parquet_file_is_one_clear_error_wherever_it_is_broken(tmp_path: Path) -> None:
    path = tmp_path / "flight.parquet"
    pq.write_table(pa.table({name: np.arange(5.0) for name in HEADER.strip().split(",")}), path)
    whole, random = path.read_bytes(), np.random.default_rng(1)
    refusals: list[str] = []
    for place in range(4, len(whole)):
        path.write_bytes(whole[:place] + bytes([int(random.integers(256)) | 0x80]) + whole[place + 1 :])
        try:
            read_trajectory(path, Convention.NUE, "flight.csv")
        except FileError as error:  # and no other
            refusals.append(str(error))
    assert all("flight.csv" in said for said in refusals)
    assert len(refusals) > len(whole) // 2  # what is not read, statistics and padding, may be anything


def test_turns_are_counted_through_every_sample() -> None:
    roll = np.linspace(0.0, 7200.0, 100_001)
    q = Rotation.from_euler("YZX", np.column_stack([0 * roll, 0 * roll, roll]), degrees=True).as_quat(scalar_first=True)
    np.testing.assert_allclose(euler_deg(q), np.column_stack([0 * roll, 0 * roll, roll]), atol=1e-9)
