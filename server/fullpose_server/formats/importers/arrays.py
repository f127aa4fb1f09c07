"""Named arrays of files of matrices (MATLAB, HDF5): those of one length are the columns of one table."""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fullpose_server.formats.importers.columns import Bounds, check_columns, check_rows
from fullpose_server.formats.importers.table import Table, table_of

_WIDEST = 64  # columns of a matrix: what is wider is an image, not a log


def columns_of(name: str, values: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """The columns of an array: itself where it is a vector, `name[k]` of a matrix, either way round; none of others."""
    if values.dtype.kind not in "iuf" or values.size < 1:
        return {}
    values = values.reshape([n for n in values.shape if n != 1] or [1])
    if values.ndim == 1:
        return {name: values}
    if values.ndim != 2 or min(values.shape) > _WIDEST:
        return {}
    tall = values if values.shape[0] >= values.shape[1] else values.T
    return {f"{name}[{k}]": np.ascontiguousarray(tall[:, k]) for k in range(tall.shape[1])}


def tables_of(
    file: str,
    kind: str,
    groups: Mapping[str, Mapping[str, NDArray[Any]]],
    bounds: Bounds,
    units: Mapping[str, str] | None = None,
) -> tuple[Table, ...]:
    """Tables of groups of columns; of a group whose columns are not of one length, one each length."""
    tables = []
    for group, columns in groups.items():
        by_length: dict[int, dict[str, NDArray[Any]]] = defaultdict(dict)
        for name, values in columns.items():
            by_length[len(values)][name] = values
        for rows, part in sorted(by_length.items(), reverse=True):
            if rows < 2 and len(by_length) > 1:  # settings beside the samples
                continue
            check_rows(rows, bounds, file)
            check_columns(len(part), bounds, file)
            name = group if len([n for n in by_length if n > 1]) < 2 else f"{group or 'variables'}, {rows} rows"
            plain: dict[str, NDArray[Any]] = {each: values.astype(_plain(values)) for each, values in part.items()}
            tables.append(table_of(file, kind, plain, name=name, units=units))
    return tuple(tables)


def _plain(values: NDArray[Any]) -> type:
    """Stamps in whole numbers stay so."""
    return np.int64 if values.dtype.kind in "iu" and values.dtype.itemsize == 8 else np.float64
