"""The array types that signatures name. Shapes and units stand in the docstrings."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.uint8]
Codes = NDArray[np.int16]  # `bounds.limited_code` of each sample
Counts = NDArray[np.int32]

Progress = Callable[[int, int], None]  # done, total; may raise `errors.CancelledError`
Clock = Callable[[], float]  # [s]
