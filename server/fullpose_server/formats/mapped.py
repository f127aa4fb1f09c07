"""An array of a file of ours, mapped from disk and never trusted: whatever has become of the file is one error."""

from pathlib import Path

import numpy as np

from fullpose._typing import Array
from fullpose_server.errors import DamagedError


def map_doubles(path: Path, shape: tuple[int, ...]) -> Array:
    """The array in a .npy file, read-only. Raises `DamagedError` where it is not doubles of that shape; -1: any."""
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except Exception as cause:
        told = cause.strerror if isinstance(cause, OSError) and cause.strerror else cause  # without the path
        raise DamagedError(f"{path.name}: not a readable array ({told})") from cause
    wanted = len(array.shape) == len(shape) and all(b in (a, -1) for a, b in zip(array.shape, shape, strict=True))
    if not wanted or array.dtype != np.dtype("<f8"):
        raise DamagedError(f"{path.name}: {array.dtype} {array.shape}: expected float64 {shape}")
    return np.asarray(array)
