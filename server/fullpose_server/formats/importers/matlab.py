"""MATLAB files of version 4 and 5 to 7.2: vectors and matrices of the top level, and structures of them."""

import zlib
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat, whosmat

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.arrays import columns_of, tables_of
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds, TooLargeError
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.table import Table

ABOUT = "MATLAB 5 file"
_COMPRESSED = 15  # the type of an element that is zlib
_HEADER = 128
_BLOCK = 1 << 20
_DEEPEST = 6  # structures in structures


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table of the variables of the top level, and one each structure. Raises `FileError`, `TooLargeError`."""
    with parsing(file, ABOUT):
        _check_unpacked(path, file, bounds)
        present = [
            f"{name} {'x'.join(map(str, shape))} {kind}" for name, shape, kind in whosmat(str(path), appendmat=False)
        ]
        variables = loadmat(str(path), appendmat=False, struct_as_record=True)
    groups: dict[str, dict[str, NDArray[Any]]] = {"": {}}
    for name, value in variables.items():
        if name.startswith("__") or not isinstance(value, np.ndarray):
            continue
        if value.dtype.names and value.size == 1:
            groups[name] = _fields(value, "", 0)
        else:
            groups[""] |= columns_of(name, value)
    tables = tables_of(file, "matlab", groups, bounds)
    if not tables:
        raise FileError(file, f"vectors or structures of numbers among {', '.join(present[:8]) or 'no variables'}")
    return tables


def _fields(value: NDArray[Any], prefix: str, depth: int) -> dict[str, NDArray[Any]]:
    """The columns of a structure, `signals.values[0]`."""
    found: dict[str, NDArray[Any]] = {}
    for name in value.dtype.names or ():
        inner = value[name].flat[0]
        if not isinstance(inner, np.ndarray):
            continue
        if inner.dtype.names and inner.size == 1 and depth < _DEEPEST:
            found |= _fields(inner, f"{prefix}{name}.", depth + 1)
        else:
            found |= columns_of(prefix + name, inner)
    return found


def _check_unpacked(path: Path, file: str, bounds: Bounds) -> None:
    """Raise `TooLargeError` where the compressed variables unpack to more than they may, before anything is kept."""
    unpacked = 0
    with path.open("rb") as stream:
        order: Literal["little", "big"] = "little" if stream.read(_HEADER)[126:128] == b"IM" else "big"
        while len(tag := stream.read(8)) == 8:
            kind, length = (int.from_bytes(tag[k : k + 4], order) for k in (0, 4))
            if kind != _COMPRESSED:
                stream.seek(length, 1)
                continue
            unpacker, left = zlib.decompressobj(), length
            while left > 0 and (data := stream.read(min(left, _BLOCK))):
                left -= len(data)
                while data:
                    unpacked += len(unpacker.decompress(data, _BLOCK))
                    data = unpacker.unconsumed_tail
                    if unpacked > bounds.bytes:
                        raise TooLargeError(
                            file, f"at most {bounds.bytes} bytes unpacked", value=f"{unpacked} bytes or more"
                        )
