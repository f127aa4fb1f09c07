"""The rows of a text as a stream of plain CSV for Arrow: decoded, without remarks, blanks made delimiters."""

import re
from collections.abc import Iterator

from fullpose_server.formats.importers.dialect import WHITE, Dialect
from fullpose_server.formats.importers.text_source import TextSource
from fullpose_server.formats.visible import without_invisible

_COMMENT = re.compile(r"^[ \t]*(?:#|%|//)[^\n]*\n?", re.MULTILINE)
_EDGES = re.compile(r"^[ \t]+|[ \t]+(?=\r?$)", re.MULTILINE)
_BLANKS = re.compile(r"[ \t]+")
_PLUS = re.compile(r"(?<![\w.])\+(?=[\d.])")
_BLANK_LINES = re.compile(r"^\r?\n", re.MULTILINE)


class RowStream:
    """A file to read from, as Arrow wants one: the rows of `source` after the header; `to_end`: to its very end, else
    without a last line that does not end."""

    closed = False

    def __init__(self, source: TextSource, dialect: Dialect, *, to_end: bool = True) -> None:
        self._blocks = _blocks(source, dialect, to_end)
        self._ready = b""

    def read(self, size: int = -1) -> bytes:
        """At most `size` bytes; none at the end."""
        while not self._ready:
            block = next(self._blocks, None)
            if block is None:
                return b""
            self._ready = block
        if size < 0 or size >= len(self._ready):
            given, self._ready = self._ready, b""
        else:
            given, self._ready = self._ready[:size], self._ready[size:]
        return given

    def close(self) -> None:
        """Nothing is read any more."""
        self._blocks = iter(())

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return False

    def seekable(self) -> bool:
        return False


def _blocks(source: TextSource, dialect: Dialect, to_end: bool) -> Iterator[bytes]:
    left = dialect.skip
    for text in source.blocks():
        if not to_end and not text.endswith("\n"):
            return
        while left and text:
            _, newline, text = text.partition("\n")
            left -= 1 if newline else left
        yield cleaned(text, dialect).encode("utf-8")


def cleaned(text: str, dialect: Dialect) -> str:
    """Whole lines as Arrow reads them, with the dialect's delimiter, a comma in the place of blanks."""
    if not text.isascii():
        text = without_invisible(text)
    if "#" in text or "%" in text or "//" in text:
        text = _COMMENT.sub("", text)
    if "+" in text:
        text = _PLUS.sub("", text)
    if dialect.delimiter == WHITE:
        text = _BLANKS.sub(",", _EDGES.sub("", text))
    return _BLANK_LINES.sub("", text)
