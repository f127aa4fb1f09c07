"""The last line of a text that has no line end: whoever wrote it may have been cut off there.

A line that lacks columns is left out, and said. One that has them all may end in half a number, 12 of 12.75: it is told
where the column's other numbers are longer and the last does not go on from them.
"""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fullpose_server.formats.caution import Caution
from fullpose_server.formats.importers.dialect import Dialect, is_comment, is_number, split
from fullpose_server.formats.importers.text_source import BLOCK, TextSource
from fullpose_server.formats.visible import visible

_TAIL_BYTES = 65536
_BEFORE = 20  # lines that the last one is compared with
_NUMBER = re.compile(r"[-+]?\d*[.,]?(?P<decimals>\d*)(?:[eE][-+]?(?P<exponent>\d*))?")
_HARMLESS = 4  # decimals from which on what is lost is below 1e-4
_GOES_ON = 1e-3  # as far as a number may be from a straight line through the two before it: 0.06 deg, in radians too


@dataclass(frozen=True)
class LastLine:
    """What is to be said of it, and whether it is left out."""

    line: int
    dropped: bool
    caution: Caution


def cut_off(source: TextSource, dialect: Dialect) -> LastLine | None:
    """What a text breaks off with; None where its last line ends, or is whole by all that can be told."""
    tail = _tail(source)
    if not tail or tail.endswith("\n"):
        return None
    *before, last = tail.split("\n")
    if not last.strip() or is_comment(last):
        return None
    width = len(dialect.names)
    cells, rows = split(last, dialect.delimiter), [split(line, dialect.delimiter) for line in before[-_BEFORE:]]
    rows = [row for row in rows if len(row) == width + dialect.trailing and is_number(row[width - 1], dialect.decimal)]
    if not rows:
        return None
    if len(cells) < width or not cells[-1].strip() > "" or cells[-1].strip() in ("-", "+"):
        line = _lines(source)
        found = f"{len(cells)} of {width} columns" if len(cells) < width else "an unfinished number"
        text = f"line {line}: {found} and no line end: the file is cut off there, and the line is left out"
        return LastLine(line, True, Caution("cut", text, None, line, visible(last[-40:])))
    if len(cells) > width or _complete([row[width - 1] for row in rows], cells[-1], dialect.decimal):
        return None
    line, name, value = _lines(source), dialect.names[-1], visible(cells[-1].strip()[:40])
    text = f"line {line}, column {name}: {value}: no line end after it: is the file cut off in the middle of a number?"
    return LastLine(line, False, Caution("cut", text, name, line, value))


def _complete(before: Sequence[str], last: str, decimal: str) -> bool:
    """Whether a number is as long as those before it, or goes on from them."""
    found, others = _NUMBER.fullmatch(last.strip()), [_NUMBER.fullmatch(cell.strip()) for cell in before]
    known = [other for other in others if other is not None]
    if found is None or not known:
        return True  # no number: refused with its line, or not read
    if any(other["exponent"] for other in known):
        if all(other["exponent"] is not None for other in known):
            same = {len(other["exponent"]) for other in known}
            return found["exponent"] is not None and len(found["exponent"]) in same
    elif len(found["decimals"]) >= _HARMLESS:
        return True
    numbers = np.array([float(cell.replace(decimal, ".")) for cell in before[-2:]])
    here = float(last.replace(decimal, "."))
    goes_on = numbers[-1] if len(numbers) < 2 else 2.0 * numbers[-1] - numbers[-2]
    if min(abs(here - goes_on), abs(here - numbers[-1])) <= _GOES_ON:
        return True
    longest = max(len(other["decimals"]) for other in known)
    if longest == 0:  # whole numbers: a digit that is lost makes a tenth
        return len(last.strip()) >= min(len(cell.strip()) for cell in before) and 10 * abs(here) > abs(numbers[-1])
    return len(found["decimals"]) >= longest


def _tail(source: TextSource) -> str:
    if source.packed:  # unpacked from its beginning: there is no other
        last = ""
        for block in source.blocks():
            last = last[-_TAIL_BYTES:] + block
        return last[-_TAIL_BYTES:]
    with source.path.open("rb") as stream:
        size = stream.seek(0, io.SEEK_END)
        begin = max(0, size - _TAIL_BYTES) // 4 * 4  # a character of UTF-16 or UTF-32 is not cut in two
        stream.seek(0)
        head = stream.read(4)
        stream.seek(begin)
        data = stream.read()
    encoding = source.encoding
    if begin and encoding in ("utf-16", "utf-32"):  # the mark that says the order of the bytes is at the beginning
        data = head[: 2 if encoding == "utf-16" else 4] + data
    text = data.decode(encoding, errors="replace")
    return text.partition("\n")[2] if begin else text


def _lines(source: TextSource) -> int:
    """How many lines there are."""
    if source.plain:
        with source.path.open("rb") as stream:
            return 1 + sum(block.count(b"\n") for block in iter(lambda: stream.read(BLOCK), b""))
    return 1 + sum(block.count("\n") for block in source.blocks())
