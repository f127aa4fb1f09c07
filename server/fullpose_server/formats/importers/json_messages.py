"""JSON messages: every number in them is a column, named by where it is: `pose.orientation.w`, `q[0]`."""

import math
from collections.abc import Iterator
from typing import Any

import msgspec

from fullpose_server.formats.importers.topics import Decoder, Reading

_MOST = 200  # numbers of a message: what has more is no attitude but an image or a map
_DECODE = msgspec.json.Decoder(dict[str, Any]).decode


def decoder_of(first: bytes) -> Decoder | None:
    """Of the messages of a topic that begins with this one; None: it has no numbers, or too many."""
    columns = tuple(name for name, _ in _leaves(_DECODE(first)))
    if not columns or len(columns) > _MOST:
        return None

    def read(data: bytes) -> Reading:
        values = dict(_leaves(_DECODE(data)))
        return Reading(None, tuple(values.get(name, math.nan) for name in columns))

    return Decoder(columns, read, None)


def _leaves(value: Any, name: str = "") -> Iterator[tuple[str, float]]:
    if isinstance(value, dict):
        for key, each in value.items():
            yield from _leaves(each, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list):
        for index, each in enumerate(value[: _MOST + 1]):
            yield from _leaves(each, f"{name}[{index}]")
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield name, float(value)
