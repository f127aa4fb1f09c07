"""HDF5, and MATLAB 7.3 that is HDF5 inside: the datasets of a group are the columns of its table."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.arrays import columns_of, tables_of
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, TooLargeError
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Table

ABOUT = "HDF5 file"
_MOST = 10_000  # datasets: what has more is no log
_UNITS = ("unit", "units", "Units", "Unit")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each group, and each compound dataset. Raises `FileError`, `TooLargeError`."""
    groups: dict[str, dict[str, NDArray[Any]]] = {}
    units: dict[str, str] = {}
    seen: list[str] = []
    with parsing(file, ABOUT), h5py.File(path, "r") as opened:

        def visit(name: str, item: Any) -> None:
            if not isinstance(item, h5py.Dataset):
                return
            seen.append(name)
            if len(seen) > _MOST:
                raise TooLargeError(file, f"at most {_MOST} datasets")
            _check(item, bounds, file)
            group, _, own = name.rpartition("/")
            if own.startswith("#") or group.startswith("#"):  # MATLAB's own
                return
            if item.dtype.names:
                values = item[()]
                groups[name] = {
                    each: values[each].ravel() for each in item.dtype.names if values[each].dtype.kind in "iuf"
                }
                return
            found = columns_of(own, np.asarray(item[()])) if item.dtype.kind in "iuf" else {}
            groups.setdefault(group, {}).update(found)
            if said := next((_text(item.attrs[key]) for key in _UNITS if key in item.attrs), ""):
                units.update(dict.fromkeys(found, said))

        opened.visititems(visit)
    tables = tables_of(file, "hdf5", {name: columns for name, columns in groups.items() if columns}, bounds, units)
    if not tables:
        raise FileError(file, f"datasets of numbers among {', '.join(seen[:8]) or 'no datasets'}")
    return tables


def _check(item: Any, bounds: Bounds, file: str) -> None:
    """Raise `TooLargeError` before a dataset is unpacked: what it says of its shape is what it takes."""
    most = min(bounds.rows * min(bounds.columns, 64), bounds.bytes // 8)
    if item.size is not None and item.size > most:
        raise TooLargeError(file, f"at most {most} numbers", column=item.name, value=f"{item.size} numbers")


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
