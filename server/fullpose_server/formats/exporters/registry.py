"""Every kind of file that plans and runs are written to: one row each.

A new kind is a module `exporters/<kind>.py` with `write(table, target)`, and a row here. The module is imported when it
is asked for; where the extra that it needs is missing, the message says which.
"""

from dataclasses import dataclass
from enum import StrEnum
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from fullpose_server.errors import FileError
from fullpose_server.formats.exporters.table import ExportTable


class ExportKind(StrEnum):
    """The kinds, each by the ending of its files."""

    CSV = "csv"
    PARQUET = "parquet"
    MCAP = "mcap"
    MAT = "mat"
    TDMS = "tdms"
    MF4 = "mf4"
    PLAYBACK = "f64"


@dataclass(frozen=True)
class Exporter:
    """A row: a kind of file, what it is called and by what module it is written."""

    kind: ExportKind
    label: str  # for people
    media_type: str
    module: str  # has `write`
    extra: str | None = None  # `pip install 'fullpose[extra]'`, where it needs more than the base install
    library: str = ""  # what is imported of the extra

    @property
    def available(self) -> bool:
        """Whether what it needs is installed."""
        return self.extra is None or find_spec(self.library) is not None

    @property
    def install(self) -> str | None:
        """What to type where it is not."""
        return None if self.extra is None else f"pip install 'fullpose[{self.extra}]'"


_ROWS = (
    Exporter(ExportKind.CSV, "CSV", "text/csv", "csv"),
    Exporter(ExportKind.PARQUET, "Parquet", "application/vnd.apache.parquet", "parquet"),
    Exporter(ExportKind.MCAP, "MCAP", "application/octet-stream", "mcap"),
    Exporter(ExportKind.MAT, "MATLAB", "application/x-matlab-data", "matlab"),
    Exporter(ExportKind.TDMS, "TDMS", "application/x-tdms", "tdms", "tdms", "nptdms"),
    Exporter(ExportKind.MF4, "MDF4", "application/x-mdf4", "mdf", "mdf", "asammdf"),
    Exporter(ExportKind.PLAYBACK, "Playback", "application/octet-stream", "playback"),
)
EXPORTERS = {row.kind: row for row in _ROWS}
ENDINGS = ", ".join(f".{kind}" for kind in ExportKind)


def exporter_of(path: Path) -> Exporter | None:
    """The row of a file's ending; None where it has another."""
    ending = path.suffix.removeprefix(".")
    return EXPORTERS[ExportKind(ending)] if ending in frozenset(ExportKind) else None


def check_installed(kind: ExportKind, file: str) -> None:
    """Raise `FileError` where the extra of a kind is missing."""
    row = EXPORTERS[kind]
    if not row.available:
        raise FileError(file, f"the extra {row.extra} for {row.label}: {row.install}")


def write_table(table: ExportTable, target: Path, kind: ExportKind, file: str) -> None:
    """Write `target` as `kind`; `file` is its name in messages. Raises `FileError`."""
    check_installed(kind, file)
    import_module(f"fullpose_server.formats.exporters.{EXPORTERS[kind].module}").write(table, target)
