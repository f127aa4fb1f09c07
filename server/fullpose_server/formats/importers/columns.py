"""Columns as every importer hands them over."""

from typing import Any

import numpy as np
import pyarrow as pa

from fullpose._typing import Array


def float_array(column: "pa.ChunkedArray[Any]") -> Array:
    """A column of Arrow as doubles (n,), in one piece."""
    return np.ascontiguousarray(column.to_numpy(), dtype=np.float64)
