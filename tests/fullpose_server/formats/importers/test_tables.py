"""MATLAB, HDF5, TDMS, MDF4 and Excel: columns in, the same attitude out as SciPy has it."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from nptdms import ChannelObject, TdmsWriter

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import Bounds, TooLargeError
from fullpose_server.formats.read_options import ReadOptions
from fullpose_server.formats.trajectory import Convention
from fullpose_server.formats.trajectory_file import read_trajectory
from tests.support import logs, tables
from tests.support.attitudes import attitude_error_deg
from tests.support.reading import flight_or_error

Writer = Callable[[Path, dict[str, dict[str, np.ndarray]]], Path]
WRITERS: dict[str, Writer] = {
    "matlab": tables.matlab,
    "hdf5": tables.hdf5,
    "matlab 7.3": lambda path, groups: tables.hdf5(path, groups, matlab_73=True),
    "tdms": tables.tdms,
    "mdf": tables.mdf,
    "excel": tables.excel,
}
NED = ReadOptions(convention=Convention.NED)


@pytest.mark.parametrize("kind", WRITERS)
@pytest.mark.parametrize("columns", [tables.COLUMNS, tables.QUATERNION], ids=["euler", "quaternion"])
def test_a_table_of_columns(tmp_path: Path, kind: str, columns: dict[str, np.ndarray]) -> None:
    flight = read_trajectory(WRITERS[kind](tmp_path / "file", {"flight": columns}), options=NED)
    assert flight.taken.format == ("hdf5" if kind == "matlab 7.3" else kind)
    assert flight.taken.table == "flight"
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9
    np.testing.assert_allclose(flight.time, tables.TIME_S, rtol=4e-16)  # a workbook has 16 digits


@pytest.mark.parametrize("kind", WRITERS)
def test_two_attitudes_are_for_a_person_to_choose(tmp_path: Path, kind: str) -> None:
    groups = {"first": tables.COLUMNS, "second": tables.QUATERNION}
    path = WRITERS[kind](tmp_path / "file", groups)
    with pytest.raises(FileError, match=r"2 attitudes: expected one .*source takes one of: first, second$"):
        read_trajectory(path, options=NED)
    flight = read_trajectory(path, options=ReadOptions(convention=Convention.NED, source="second"))
    assert flight.taken.table == "second"
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9


@pytest.mark.parametrize("kind", ["matlab", "hdf5", "matlab 7.3"])
def test_variables_of_the_top_level_and_others_beside_them(tmp_path: Path, kind: str) -> None:
    settings = {"rate_hz": np.array([50.0]), "image": np.zeros((70, 80))}
    path = WRITERS[kind](tmp_path / "file", {"": {**tables.COLUMNS, **settings}})
    flight = read_trajectory(path)
    assert (flight.taken.table, flight.taken.profile) == ("", "fullpose-ned")
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9


def test_a_structure_in_a_structure_and_a_matrix(tmp_path: Path) -> None:
    log = {"clock": {"t": tables.TIME_S}, "q": logs.NED.as_quat(scalar_first=True)}
    path = tables.matlab(tmp_path / "file", {"log": log})  # type: ignore[dict-item]
    profile = tmp_path / "mine.toml"
    profile.write_text(
        'axes = "ned"\n[time]\ncolumn = "clock.t"\n[quaternion]\ncolumns = ["q[0]", "q[1]", "q[2]", "q[3]"]\n'
    )
    flight = read_trajectory(path, options=ReadOptions(profile=str(profile)))
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9


def test_a_compound_dataset(tmp_path: Path) -> None:
    rows = np.zeros(logs.SAMPLES, [(name, "f8") for name in tables.COLUMNS])
    for name, values in tables.COLUMNS.items():
        rows[name] = values
    with h5py.File(tmp_path / "file", "w") as file:
        file["log/attitude"] = rows
    flight = read_trajectory(tmp_path / "file")
    assert flight.taken.table == "log/attitude"
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9


def test_a_waveform_of_tdms_has_its_time(tmp_path: Path) -> None:
    with TdmsWriter(str(tmp_path / "file")) as writer:
        waveform = {"wf_increment": 0.02, "wf_start_offset": 0.0, "unit_string": "deg"}
        angles = [(n, v) for n, v in tables.COLUMNS.items() if n != "time_s"]
        writer.write_segment([ChannelObject("g", n, v, properties=waveform) for n, v in angles])
    flight = read_trajectory(tmp_path / "file")
    assert attitude_error_deg(flight, logs.NED, "ned") < 1e-9
    np.testing.assert_allclose(flight.time, tables.TIME_S, atol=1e-12)


def test_a_sheet_with_units_and_its_rows_in_messages(tmp_path: Path) -> None:
    path = tables.excel(tmp_path / "file", {"flight": tables.COLUMNS}, units=True)
    assert attitude_error_deg(read_trajectory(path), logs.NED, "ned") < 1e-9
    gone = {**tables.COLUMNS, "pitch_deg": np.where(np.arange(logs.SAMPLES) == 7, np.nan, tables.COLUMNS["pitch_deg"])}
    path = tables.excel(tmp_path / "file", {"flight": gone}, units=True)
    with pytest.raises(FileError, match=r"row 12, column pitch_deg: .*expected a finite number"):
        read_trajectory(path)


@pytest.mark.parametrize("kind", WRITERS)
@pytest.mark.parametrize("share", [0.05, 0.5, 0.98])
def test_a_file_that_is_cut_off_is_one_clear_error_or_what_was_read(tmp_path: Path, kind: str, share: float) -> None:
    path = WRITERS[kind](tmp_path / "file", {"flight": tables.COLUMNS})
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    flight, told = flight_or_error(path)
    if flight is None:
        assert "expected a" in told
    else:
        assert flight.time.size < logs.SAMPLES
        assert flight.warnings


@pytest.mark.parametrize("kind", WRITERS)
def test_a_file_beyond_the_bounds_is_refused(tmp_path: Path, kind: str) -> None:
    path = WRITERS[kind](tmp_path / "file", {"flight": tables.COLUMNS})
    with pytest.raises(TooLargeError, match="at most"):
        read_trajectory(path, bounds=Bounds(rows=20, columns=10))


def test_what_unpacks_to_more_than_it_may_is_refused_before_it_is_kept(tmp_path: Path) -> None:
    bounds = Bounds(rows=10**9, columns=100, bytes=1_000_000)
    zeros = tables.matlab(tmp_path / "zeros", {"": {"x": np.zeros(10_000_000)}})
    assert zeros.stat().st_size < 200_000
    with pytest.raises(TooLargeError, match="at most 1000000 bytes unpacked"):
        read_trajectory(zeros, bounds=bounds)
    with h5py.File(tmp_path / "h5", "w") as file:
        file.create_dataset("x", shape=(10**12,), dtype="f8", chunks=(1000,), compression="gzip")
    with pytest.raises(TooLargeError, match="1000000000000 numbers"):
        read_trajectory(tmp_path / "h5", bounds=bounds)
    with zipfile.ZipFile(tmp_path / "bomb", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("xl/worksheets/sheet1.xml", bytes(5_000_000))
    with pytest.raises(TooLargeError, match="at most 1000000 bytes unpacked"):
        read_trajectory(tmp_path / "bomb", bounds=bounds)


def test_noise_in_a_file_is_one_clear_error(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    for kind, write in WRITERS.items():
        data = bytearray(write(tmp_path / "file", {"flight": tables.COLUMNS}).read_bytes())
        for at in rng.integers(8, len(data), 12):
            data[at] ^= 0xFF
        (tmp_path / "file").write_bytes(bytes(data))
        flight, told = flight_or_error(tmp_path / "file")
        assert flight is not None or "expected a" in told, kind


def test_a_missing_extra_is_named_with_what_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tables.hdf5(tmp_path / "file", {"flight": tables.COLUMNS})

    def missing(_name: str) -> None:
        raise ModuleNotFoundError("No module named 'h5py'", name="h5py")

    monkeypatch.setattr("fullpose_server.formats.importers.registry.import_module", missing)
    with pytest.raises(FileError, match=r"expected the extra hdf5 for HDF5: pip install 'fullpose\[hdf5\]'"):
        read_trajectory(path)
