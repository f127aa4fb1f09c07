"""The flight of `tests.support.logs` as files of columns, by each format's own writer."""

from pathlib import Path

import h5py
import numpy as np
from asammdf import MDF, Signal
from nptdms import ChannelObject, GroupObject, TdmsWriter
from openpyxl import Workbook
from scipy.io import savemat

from tests.support import logs

TIME_S = (logs.TIME_US - logs.TIME_US[0]) * 1e-6
COLUMNS = {"time_s": TIME_S, **dict(zip(("heading_deg", "pitch_deg", "bank_deg"), logs.YPR.T, strict=True))}
QUATERNION = {
    "time_s": TIME_S,
    **dict(zip(("qw", "qx", "qy", "qz"), logs.NED.as_quat(scalar_first=True).T, strict=True)),
}


def matlab(path: Path, groups: dict[str, dict[str, np.ndarray]]) -> Path:
    """By SciPy, compressed: "" is the top level, another name a structure."""
    variables = {name: values for name, values in groups.items() if name} | groups.get("", {})
    savemat(str(path), variables, appendmat=False, do_compression=True)
    return path


def hdf5(path: Path, groups: dict[str, dict[str, np.ndarray]], *, matlab_73: bool = False) -> Path:
    """By h5py; as MATLAB 7.3 has it with its 512 bytes of text before, and vectors as rows of one column."""
    with h5py.File(path, "w", userblock_size=512 if matlab_73 else 0) as file:
        for group, columns in groups.items():
            for name, values in columns.items():
                data = values[None, :] if matlab_73 else values
                made = file.create_dataset(f"{group}/{name}" if group else name, data=data, compression="gzip")
                made.attrs["MATLAB_class"] = np.bytes_("double")
    if matlab_73:
        with path.open("r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return path


def tdms(path: Path, groups: dict[str, dict[str, np.ndarray]]) -> Path:
    """By npTDMS."""
    with TdmsWriter(str(path)) as writer:
        for group, columns in groups.items():
            writer.write_segment([GroupObject(group), *(ChannelObject(group, n, v) for n, v in columns.items())])
    return path


def mdf(path: Path, groups: dict[str, dict[str, np.ndarray]]) -> Path:
    """By asammdf, 4.10."""
    with MDF(version="4.10") as file:
        for group, columns in groups.items():
            at = columns["time_s"]
            signals = [
                Signal(v, at, name=n, unit="deg", master_metadata=("time_s", 1))
                for n, v in columns.items()
                if n != "time_s"
            ]
            file.append(signals, acq_name=group, common_timebase=True)
        written = file.save(path.with_suffix(".mf4"), overwrite=True)
    Path(written).rename(path)
    return path


def excel(path: Path, groups: dict[str, dict[str, np.ndarray]], *, units: bool = False) -> Path:
    """By openpyxl: a title, the names, a row of units where asked for, numbers."""
    book = Workbook()
    book.remove(book.active)
    for group, columns in groups.items():
        sheet = book.create_sheet(group)
        sheet.append(["Flight 7"])
        sheet.append([])
        sheet.append(list(columns))
        if units:
            sheet.append(["s", *("deg" for _ in list(columns)[1:])])
        for row in zip(*columns.values(), strict=True):
            sheet.append([float(cell) for cell in row])
    book.save(path)
    return path
