"""A text file as lines of characters, whatever it is encoded in and whether it is packed: never more than a block of it
in memory."""

import codecs
import gzip
import io
import re
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, cast

from fullpose_server.errors import FileError
from fullpose_server.formats.importers.columns import Bounds, TooLargeError

GZIP = b"\x1f\x8b"
_NOVATEL = re.compile(rb"^[#%](?:INSPVA|INSATT)[A-Z]*,", re.MULTILINE)
BLOCK = 4 * 1024 * 1024  # characters read at once
LONGEST_LINE = 1_000_000  # characters: what has more is no line
_SIGNATURES = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


@dataclass(frozen=True)
class TextSource:
    """Where the text is and how it is read."""

    path: Path
    file: str  # its name in messages
    encoding: str
    packed: bool  # by gzip
    most_bytes: int  # that it may unpack to

    def blocks(self) -> Iterator[str]:
        """The text in pieces of whole lines. Raises `FileError`, `TooLargeError`."""
        rest = ""
        try:
            with _opened(self.path, self.packed) as stream:
                text = io.TextIOWrapper(stream, encoding=self.encoding, errors="replace", newline="")
                size = 0
                while piece := text.read(BLOCK):
                    size += len(piece)
                    if self.packed and size > self.most_bytes:
                        raise TooLargeError(self.file, f"a text that unpacks to at most {self.most_bytes} bytes")
                    kept, newline, rest = (rest + piece).rpartition("\n")
                    if newline:
                        yield kept + newline
                    elif len(rest) > LONGEST_LINE:
                        raise FileError(
                            self.file, f"lines of at most {LONGEST_LINE} characters that end in LF or CR LF"
                        )
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise FileError(self.file, f"a whole gzip file ({error})") from None
        if rest:
            yield rest

    def lines(self) -> Iterator[str]:
        """Each line, without its end."""
        for block in self.blocks():
            for line in io.StringIO(block, newline="\n"):
                yield line.rstrip("\r\n")

    @property
    def plain(self) -> bool:
        """Whether others can read the file as it is: UTF-8, not packed."""
        return not self.packed and self.encoding in ("utf-8", "utf-8-sig")


def text_source(path: Path, file: str, bounds: Bounds, head_bytes: int = 65536) -> TextSource:
    """How to read the text in a file. Raises `FileError` where it is none."""
    head = head_of(path, head_bytes)
    encoding = encoding_of(head)
    if encoding is None:
        raise FileError(file, "a text")
    with path.open("rb") as stream:
        packed = stream.read(2) == GZIP
    return TextSource(path, file, encoding, packed, bounds.bytes)


def head_of(path: Path, size: int) -> bytes:
    """The first bytes of a file, unpacked where it is packed; as many as there are where it is cut off."""
    with path.open("rb") as stream:
        data = stream.read(size)
    return unpacked_head(data, size)


def unpacked_head(data: bytes, size: int) -> bytes:
    """What the first bytes of a gzip file unpack to, at most `size`; other bytes as they are."""
    if not data.startswith(GZIP):
        return data
    try:
        return zlib.decompressobj(wbits=31).decompress(data, size)
    except zlib.error:
        return data


def encoding_of(head: bytes) -> str | None:
    """The encoding of a text by its first bytes: by its mark, else the first that fits; None: it is no text."""
    for signature, name in _SIGNATURES:
        if head.startswith(signature):
            return name if _decodes(head, name) else None
    if b"\0" in head:
        return _unmarked_utf_16(head)
    if _has_controls(head):
        return None
    if _decodes(head, "utf-8"):
        return "utf-8"
    if _decodes(head, "gb18030") and _is_chinese(head):
        return "gb18030"
    return "cp1252" if sum(byte > 127 for byte in head) < max(len(head) // 20, 4) else None


def _opened(path: Path, packed: bool) -> BinaryIO:
    return cast(BinaryIO, gzip.open(path, "rb")) if packed else path.open("rb")


def _decodes(head: bytes, encoding: str) -> bool:
    """Whether the bytes are of that encoding, but for a character cut off at the end."""
    try:
        codecs.getincrementaldecoder(encoding)("strict").decode(head)
    except UnicodeDecodeError:
        return False
    return True


def _unmarked_utf_16(head: bytes) -> str | None:
    pairs = len(head) // 2
    for name, parity in (("utf-16-le", 1), ("utf-16-be", 0)):
        zeros = head[parity::2].count(0)
        others = head[1 - parity :: 2].count(0)
        if zeros > 0.7 * pairs and not others and _decodes(head, name):
            text = codecs.getincrementaldecoder(name)("strict").decode(head)
            return None if _has_controls(map(ord, text)) else name
    return None


def _has_controls(codes: Iterable[int]) -> bool:
    """Whether a character is a control that no text has: neither white space nor escape."""
    return any(code < 9 or (13 < code < 32 and code != 27) for code in codes)


def _is_chinese(head: bytes) -> bool:
    text = codecs.getincrementaldecoder("gb18030")("strict").decode(head)
    foreign = [sign for sign in text if ord(sign) > 127]
    han = sum("\u4e00" <= sign <= "\u9fff" or "\u3000" <= sign <= "\u303f" or sign in "°，（）：" for sign in foreign)
    return 2 * han > len(foreign)


def is_novatel(head: bytes) -> bool:
    """Whether a text is of records that begin like `#INSPVAA,` (`importers.novatel`)."""
    return _NOVATEL.search(head) is not None
