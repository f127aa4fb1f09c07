"""Reading a flight from a file of any known format; what is wrong is named by file, line and column."""

import io
from pathlib import Path

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.csv import read_csv
from fullpose_server.formats.trajectory import Convention, Trajectory

PARQUET_MAGIC = b"PAR1"


def read_trajectory(
    path: Path, convention: Convention, name: str | None = None, bounds: Bounds = UNBOUNDED
) -> Trajectory:
    """The flight in a CSV or Parquet file, told apart by content; `name` replaces the path in messages.

    Raises `TooLargeError` beyond the bounds, `FileError` for everything else a person can put right, `OSError` where
    the file cannot be read at all.
    """
    file = str(path) if name is None else name
    with path.open("rb") as stream:
        head = stream.read(65536)
    if not head.strip():
        raise FileError(file, "a header line and samples, the file is empty")
    if head.startswith(PARQUET_MAGIC):
        from fullpose_server.formats.importers.parquet import read_parquet  # 80 ms that CSV need not pay

        return read_parquet(path, convention, file, bounds)
    if b"\0" in head or not _is_text(head):
        raise FileError(file, "CSV text or Parquet, this is another binary file")
    return read_csv(path, convention, file, bounds)


def source_format(path: Path) -> str:
    """`parquet` or `csv`, by content."""
    with path.open("rb") as stream:
        return "parquet" if stream.read(4) == PARQUET_MAGIC else "csv"


def _is_text(head: bytes) -> bool:
    """Whether the bytes are UTF-8 but for a character cut off at the end; Latin-1 letters in a comment are text too."""
    try:
        io.TextIOWrapper(io.BytesIO(head), encoding="utf-8").read()
    except UnicodeDecodeError as error:
        if error.start >= len(head) - 4:
            return True
        control = sum(byte < 9 or 13 < byte < 32 for byte in head)
        return control == 0 and sum(byte > 127 for byte in head) < len(head) // 20
    return True
