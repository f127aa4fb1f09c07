"""Attitudes of a log of topics, message by message, in columns that take eight bytes a number."""

from array import array
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.columns import Bounds, check_rows
from fullpose_server.formats.importers.table import Columns, Table, table_of


class Reading(NamedTuple):
    """What a decoder makes of one message."""

    stamp: int | None  # [ns] its own; None: it has none
    values: tuple[float, ...]  # one a column


class Decoder(NamedTuple):
    """How the messages of a topic are read."""

    columns: tuple[str, ...]
    read: Callable[[bytes], Reading | None]  # None: this message has no attitude
    profile: str | None  # that these columns have
    stamp: str = "header.stamp"  # what a message's own stamp is called


class Topics:
    """Fills a table a topic."""

    def __init__(self, file: str, kind: str, bounds: Bounds) -> None:
        self._file, self._kind, self._bounds = file, kind, bounds
        self._decoders: dict[str, Decoder] = {}
        self._stamps: dict[str, tuple[array[int], array[int]]] = {}
        self._values: dict[str, array[float]] = {}

    def add(self, topic: str, decoder: Decoder, log_ns: int, data: bytes) -> None:
        """One message of a topic. Raises `TooLargeError`, and what the decoder raises on a damaged one."""
        reading = decoder.read(data)
        if reading is None:
            return
        if topic not in self._decoders:
            self._decoders[topic] = decoder
            self._stamps[topic], self._values[topic] = (array("q"), array("q")), array("d")
        logged, own = self._stamps[topic]
        logged.append(log_ns)
        own.append(reading.stamp or 0)  # zero: a publisher that does not fill it in
        self._values[topic].extend(reading.values)
        check_rows(len(logged), self._bounds, self._file)

    def tables(self, cautions: tuple[Caution, ...] = ()) -> tuple[Table, ...]:
        """A table each topic, in the order of their names."""
        return tuple(self._table(topic, cautions) for topic in sorted(self._decoders))

    def _table(self, topic: str, cautions: tuple[Caution, ...]) -> Table:
        decoder = self._decoders[topic]
        logged, own = (np.array(stamps, np.int64) for stamps in self._stamps[topic])
        stamped = bool((own > 0).all())
        if not stamped:
            text = f"{topic}: its messages have no {decoder.stamp}: when they were logged is taken"
            cautions = (*cautions, Caution("log-time", text))
        values = np.array(self._values[topic]).reshape(len(logged), len(decoder.columns))
        columns: Columns = {
            (decoder.stamp if stamped else "log_time"): own if stamped else logged,
            **{name: np.ascontiguousarray(values[:, k]) for k, name in enumerate(decoder.columns)},
        }
        return table_of(
            self._file,
            self._kind,
            columns,
            name=topic,
            units={decoder.stamp: "ns", "log_time": "ns"},
            row_word="message",
            profile=decoder.profile,
            cautions=cautions,
        )
