"""A flight from a Parquet file.

What a file says of itself is checked before anything of it is unpacked: 40 kB of it may be gigabytes of rows. What it
then unpacks to is read batch by batch; a file whose pages are not what its metadata says is met by the memory that the
reading process has.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fullpose._typing import Array
from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import (
    UNBOUNDED,
    Bounds,
    Filling,
    TooLargeError,
    check_columns,
    check_rows,
)
from fullpose_server.formats.importers.table import Columns, Table

_BATCH = 65_536
_FOOTER_BYTES = 4 * 1024 * 1024  # of metadata: thousands of row groups
# A number takes eight bytes, and at worst as many again for its place in a dictionary; a column of few rows has a page.
_NUMBER_BYTES = 32
_PAGE_BYTES = 1024 * 1024


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """The one table; `file` is its name in messages. Raises `FileError`, `TooLargeError`, `MemoryError`."""
    with _told(path, file) as parquet:
        check_columns(parquet.metadata.num_columns, bounds, file)
        check_rows(parquet.metadata.num_rows, bounds, file)
        names = tuple(parquet.schema_arrow.names)
    return (Table(file, "parquet", names, partial(_load, path, file)),)


@contextmanager
def _told(path: Path, file: str) -> Iterator[pq.ParquetFile]:
    """The open file; what Arrow says of it is said as a `FileError`."""
    try:
        _check_footer(path, file)
        with pq.ParquetFile(path) as parquet:
            yield parquet
    except MemoryError:  # Arrow's own is one of its exceptions, too
        raise
    except (pa.ArrowException, UnicodeDecodeError, OSError) as error:  # a broken column name is not even text
        said = str(error).splitlines() or [type(error).__name__]
        raise FileError(file, f"a whole Parquet file ({said[0][:200]})") from None


def _load(path: Path, file: str, wanted: Sequence[str]) -> Columns:
    with _told(path, file) as parquet:
        for name in wanted:
            kind = parquet.schema_arrow.field(name).type
            if not (pa.types.is_floating(kind) or pa.types.is_integer(kind)):
                raise FileError(file, "a column of numbers", column=name, value=str(kind))
        _check_unpacked(parquet.metadata, wanted, file)
        return _columns(parquet, tuple(wanted), file)


def _check_footer(path: Path, file: str) -> None:
    """Raise `TooLargeError` where the metadata alone is too much to be read."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        stream.seek(max(0, size - 8))
        length, magic = int.from_bytes(stream.read(4), "little"), stream.read(4)
    if magic == b"PAR1" and _FOOTER_BYTES < length < size:  # what is no footer is told so by Arrow
        raise TooLargeError(file, f"metadata of at most {_FOOTER_BYTES} bytes", value=f"{length} bytes")


def _check_unpacked(metadata: Any, wanted: Sequence[str], file: str) -> None:
    """Raise `TooLargeError` where a column says that it unpacks to more than its rows can be."""
    for group in range(metadata.num_row_groups):
        for index in range(metadata.num_columns):
            chunk = metadata.row_group(group).column(index)
            if chunk.path_in_schema not in wanted:
                continue
            most = _NUMBER_BYTES * max(chunk.num_values, 0) + _PAGE_BYTES
            if not 0 <= chunk.total_uncompressed_size <= most:
                value = f"{chunk.total_uncompressed_size} bytes"
                raise TooLargeError(
                    file, f"at most {most} bytes for {chunk.num_values} rows", column=chunk.path_in_schema, value=value
                )


def _columns(parquet: pq.ParquetFile, wanted: tuple[str, ...], file: str) -> dict[str, Array]:
    """The wanted columns (n,), without a row more than the metadata says."""
    filling = Filling(wanted, max(0, parquet.metadata.num_rows))
    for batch in parquet.iter_batches(_BATCH, columns=list(wanted), use_threads=False):
        if filling.rows + batch.num_rows > parquet.metadata.num_rows:
            raise FileError(file, f"a whole Parquet file ({parquet.metadata.num_rows} rows, as it says)")
        rows = {}
        for name in wanted:
            column = batch.column(name)
            if column.null_count:
                row = filling.rows + int(np.argmax(column.is_null().to_numpy(zero_copy_only=False)))
                raise FileError(file, "a number", line=row + 1, column=name, value="null", unit="row")
            # Not safe: an integer that no double has is rounded, as the same digits in CSV are.
            rows[name] = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
        filling.add(rows)
    return filling.columns()
