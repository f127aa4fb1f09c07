"""MCAP: attitudes of ROS 1, ROS 2 and JSON messages, and the records of our own runs."""

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from mcap.reader import NonSeekingReader

from fullpose_server.errors import FileError
from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers import json_messages, ros_messages
from fullpose_server.formats.importers.columns import UNBOUNDED, Bounds
from fullpose_server.formats.importers.parsing import parsing
from fullpose_server.formats.importers.run_record import SCHEMA, RunSamples
from fullpose_server.formats.importers.table import Table
from fullpose_server.formats.importers.topics import Decoder, Topics

ABOUT = "MCAP file"
_CUT = Caution("truncated", "the file is damaged or was cut off: what could be read of it is taken")


def read_tables(path: Path, file: str, bounds: Bounds = UNBOUNDED) -> tuple[Table, ...]:
    """A table each topic that has an attitude, or numbers; of a run one each attitude of its samples.

    Raises `FileError`, `TooLargeError`.
    """
    topics, run, takes = Topics(file, "mcap", bounds), RunSamples(file, bounds), _Takes(file)
    cut: list[str] = []
    with path.open("rb") as stream, parsing(file, ABOUT):
        size = path.stat().st_size
        for count, (schema, channel, message) in enumerate(_messages(stream, cut)):
            decoder = takes.decoder(schema, channel, message.data)
            if decoder is run_samples:
                run.add(message.data)
            elif isinstance(decoder, Decoder):
                topics.add(channel.topic, decoder, message.log_time, message.data)
            if bounds.progress is not None and count % 4096 == 0:
                bounds.progress(stream.tell(), size)
    tables = run.tables(_metadata(path)) or topics.tables((_CUT,) if cut else ())
    if not tables:
        listed = ", ".join(takes.listed[:8]) or "no topics"
        raise FileError(file, f"a topic with an attitude among {listed}" + (f", cut off ({cut[0]})" if cut else ""))
    return tables


def run_samples(_data: bytes) -> None:
    """In the place of a decoder: the messages are those of a run."""


class _Takes:
    """Which channels are read, and how."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._decoders: dict[int, Decoder | Callable[[bytes], None] | None] = {}
        self.listed: list[str] = []

    def decoder(self, schema: Any, channel: Any, first: bytes) -> Decoder | Callable[[bytes], None] | None:
        """Of a channel, by its schema and the first of its messages; None: it is not read."""
        if channel.id not in self._decoders:
            kind = schema.name if schema is not None else channel.message_encoding
            self.listed.append(f"{channel.topic} ({kind})")
            self._decoders[channel.id] = self._found(kind, channel.message_encoding, first)
        return self._decoders[channel.id]

    def _found(self, kind: str, encoding: str, first: bytes) -> Decoder | Callable[[bytes], None] | None:
        if kind == SCHEMA:
            return run_samples
        if encoding == "json":
            return json_messages.decoder_of(first)
        return ros_messages.decoder_of(kind, encoding, self._file)


def _messages(stream: Any, cut: list[str]) -> Iterator[tuple[Any, Any, Any]]:
    """Every message up to where the file is damaged; why it ends there is added to `cut`."""
    messages = NonSeekingReader(stream, validate_crcs=True).iter_messages(log_time_order=False)
    while True:
        try:
            yield next(messages)
        except StopIteration:
            return
        except MemoryError:
            raise
        except Exception as error:  # noqa: BLE001 - the library ends by whatever damaged bytes lead it to
            cut.append(str(error) or type(error).__name__)
            return


def _metadata(path: Path) -> dict[str, str]:
    """What a run's record says of the run; nothing where it is damaged."""
    with path.open("rb") as stream, contextlib.suppress(Exception):
        for found in NonSeekingReader(stream).iter_metadata():
            if found.name == "run":
                return dict(found.metadata)
    return {}
