"""The seal of a stored plan: a digest of each thing that it says, and one digest of all of them, the plan's hash.

A digest of each, so that what was changed can be named; one of all, so that plan and server agree on one number.
"""

import hashlib
import json
from collections.abc import Mapping

import numpy as np

from fullpose._typing import Array


def facts_sealed(facts: Mapping[str, str | float | bool]) -> dict[str, str]:
    """sha-256 of each fact, by its name."""
    return {name: hashlib.sha256(json.dumps(value).encode()).hexdigest() for name, value in facts.items()}


def arrays_sealed(arrays: Mapping[str, Array]) -> dict[str, str]:
    """sha-256 of each array's shape and little-endian values, by its name."""
    return {name: _array_digest(array) for name, array in arrays.items()}


def seal_hash(sealed: Mapping[str, str]) -> str:
    """sha-256 of all digests."""
    return hashlib.sha256(json.dumps(sealed, sort_keys=True).encode()).hexdigest()


def unlike(found: Mapping[str, str], sealed: Mapping[str, str]) -> list[str]:
    """The names of what is not as it was sealed, or is in one of both alone."""
    return sorted(name for name in found.keys() | sealed.keys() if found.get(name) != sealed.get(name))


def _array_digest(array: Array) -> str:
    digest = hashlib.sha256(repr(array.shape).encode())
    digest.update(np.ascontiguousarray(array, dtype="<f8").data)
    return digest.hexdigest()
