"""Every kind of file that a flight is read from: one row each, told by its first bytes. The first that fits reads it.

A new format is a module `importers/<format>.py` with `read_tables(path, file, bounds) -> tuple[Table, ...]`, and a row
here. The module is imported when a file is its: a library that it needs costs nobody else anything, and where an extra
is missing the message says which.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path

import fullpose_server.formats.importers.log_signatures as logs
from fullpose_server.errors import FileError
from fullpose_server.formats.importers import signatures, text_source
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.table import Table

HEAD_BYTES = 65536


@dataclass(frozen=True)
class Head:
    """What a format is told by: the first bytes of a file, and what it is called."""

    data: bytes
    path: Path

    @cached_property
    def text(self) -> bytes:
        """The first bytes, unpacked where they are packed by gzip."""
        return text_source.unpacked_head(self.data, HEAD_BYTES)

    @property
    def suffix(self) -> str:
        """The last part of the name, `.csv`, in small letters."""
        return self.path.suffix.lower()


@dataclass(frozen=True)
class Importer:
    """A row: a format, by what it is told, and the module that reads it."""

    name: str  # `input.format`
    about: str  # what a person calls it
    recognise: Callable[[Head], bool]
    module: str  # has read_tables
    extra: str | None = None  # `pip install 'fullpose[extra]'`, where it needs more than the base install


IMPORTERS: tuple[Importer, ...] = (
    Importer("parquet", "Parquet", lambda head: head.data.startswith(signatures.PARQUET), "parquet"),
    Importer("ulog", "PX4 ULog", lambda head: head.data.startswith(logs.ULOG), "ulog", "px4"),
    Importer("dataflash", "ArduPilot log", lambda head: head.data.startswith(logs.DATAFLASH), "dataflash", "ardupilot"),
    Importer("mcap", "MCAP", lambda head: head.data.startswith(logs.MCAP), "mcap"),
    Importer("rosbag1", "ROS 1 bag", lambda head: head.data.startswith(logs.ROSBAG), "rosbag1", "ros"),
    Importer("rosbag2", "ROS 2 bag", lambda head: head.data.startswith(logs.SQLITE), "rosbag2", "ros"),
    Importer("matlab", "MATLAB 5", lambda head: head.data.startswith(logs.MATLAB_5), "matlab"),
    Importer("hdf5", "HDF5", lambda head: logs.is_hdf5(head.data), "hdf5", "hdf5"),
    Importer("tdms", "TDMS", lambda head: head.data.startswith(logs.TDMS), "tdms", "tdms"),
    Importer("mdf", "MDF", lambda head: head.data.startswith(logs.MDF), "mdf", "mdf"),
    Importer("excel", "Excel", lambda head: logs.is_workbook(head.data), "excel", "excel"),
    Importer("tlog", "MAVLink tlog", lambda head: logs.is_tlog(head.data), "tlog", "ardupilot"),
    # Further binary formats go here, before text.
    Importer("aem", "CCSDS AEM", lambda head: b"CCSDS_AEM_VERS" in head.text[:4096], "aem"),
    Importer("stk", "STK .a", lambda head: head.text.lstrip().lower().startswith(b"stk.v."), "stk"),
    Importer("novatel", "NovAtel", lambda head: text_source.is_novatel(head.text), "novatel"),
    Importer("csv", "CSV text", lambda head: text_source.encoding_of(head.text) is not None, "csv"),
)


def importer_of(path: Path, file: str, suffix_of: str = "") -> Importer:
    """The row that reads a file; `file`: its name in messages, `suffix_of`: the name that its sender gave it.

    Raises `FileError` where there is none, naming what the file is instead.
    """
    with path.open("rb") as stream:
        data = stream.read(HEAD_BYTES)
    if not data.strip():
        raise FileError(file, "a header line and samples, the file is empty")
    head = Head(data, Path(suffix_of) if suffix_of else path)
    for row in IMPORTERS:
        if row.recognise(head):
            return row
    known = ", ".join(row.about for row in IMPORTERS)
    raise FileError(file, f"a flight ({known}), this is {signatures.name_of(data)}")


def read_tables(
    path: Path, file: str, bounds: Bounds = UNBOUNDED, importer: Importer | None = None
) -> tuple[Table, ...]:
    """The tables of a file, at least one. Raises `FileError`, `TooLargeError`, `OSError`."""
    row = importer_of(path, file) if importer is None else importer
    try:
        module = import_module(f"fullpose_server.formats.importers.{row.module}")
    except ModuleNotFoundError as error:
        if row.extra is None or (error.name or "").startswith("fullpose"):
            raise
        expected = f"the extra {row.extra} for {row.about}: pip install 'fullpose[{row.extra}]'"
        raise FileError(file, expected) from None
    tables: tuple[Table, ...] = module.read_tables(path, file, bounds)
    return tables
