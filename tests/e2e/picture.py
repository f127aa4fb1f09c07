"""What a screenshot holds, told in numbers."""

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image


def _pixels(png: bytes) -> NDArray[np.int64]:
    """One number a pixel, (h, w)."""
    rgb = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=np.int64)
    return rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2]


def colours(png: bytes) -> int:
    """How many different colours there are."""
    return len(np.unique(_pixels(png)))


def dominance(png: bytes) -> float:
    """Share of the picture that its commonest colour has; 1 for a blank one."""
    counts = np.unique(_pixels(png), return_counts=True)[1]
    return float(counts.max() / counts.sum())


def changed(before: bytes, after: bytes) -> float:
    """Share of the pixels that differ between two pictures of one size."""
    return float(np.mean(_pixels(before) != _pixels(after)))
