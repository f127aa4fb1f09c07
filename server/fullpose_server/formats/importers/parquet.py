"""A flight from a Parquet file."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import float_array
from fullpose_server.formats.trajectory import Convention, Trajectory, column_names, from_columns


def read_parquet(path: Path, convention: Convention, file: str) -> Trajectory:
    """The flight; `file` is its name in messages. Raises `FileError`."""
    try:
        with pq.ParquetFile(path) as parquet:
            present = list(parquet.schema_arrow.names)
            wanted = column_names(present, convention, file)
            for name in wanted:
                kind = parquet.schema_arrow.field(name).type
                if not (pa.types.is_floating(kind) or pa.types.is_integer(kind)):
                    raise FileError(file, "a column of numbers", column=name, value=str(kind))
            table = parquet.read(columns=list(wanted))
    except (pa.ArrowException, UnicodeDecodeError, OSError) as error:  # a broken column name is not even text
        raise FileError(file, f"a whole Parquet file ({str(error).splitlines()[0][:200]})") from None
    columns = {}
    for name in wanted:
        column = table.column(name)
        if column.null_count:
            row = int(np.argmax(column.is_null().to_numpy()))
            raise FileError(file, "a number", line=row + 1, column=name, value="null", unit="row")
        # Not safe: an integer that no double has is rounded, as the same digits in CSV are.
        columns[name] = float_array(column.cast(pa.float64(), safe=False))
    return from_columns(columns, convention, file, lambda row: row + 1, unit="row")
