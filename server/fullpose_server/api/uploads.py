"""A multipart upload, streamed to a file with a limit on its size; nothing of it is held in memory."""

import hashlib
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from python_multipart.exceptions import FormParserError
from python_multipart.multipart import MultipartParser, parse_options_header
from starlette.requests import ClientDisconnect, Request

from fullpose_server.api.body_limit import too_large
from fullpose_server.api.problems import ApiError

if TYPE_CHECKING:
    from python_multipart.multipart import MultipartCallbacks

FORM = "multipart/form-data"  # the body of a route that takes a file
FIELD_LIMIT = 4096  # bytes of a form field that is not the file
FIELDS = (
    "name",
    "convention",
    "profile",
    "columns",
    "source",
    "strict",
    "bridge_gaps",
    "drop_duplicates",
)  # that a form may have beside its file
LONGEST_NAME = 200  # characters of a file's name
ENVELOPE = 65536  # what a form may have around its file


@dataclass
class Upload:
    """What came: the file's own name, its bytes' hash and size, and the other fields of the form."""

    filename: str | None = None
    sha256: str = ""
    size: int = 0
    fields: dict[str, str] = field(default_factory=dict)


async def receive_form(request: Request, target: Path, limit: int) -> Upload:
    """Read the form of `request`; the part named `file` goes to `target`.

    Raises `ApiError`: 413 past `limit`; 400 for a broken form; 422 where it has no file, or a field that is none.
    """
    _, options = parse_options_header(request.headers.get("content-type", ""))
    boundary = options.get(b"boundary")
    if not boundary:
        raise ApiError(400, "malformed-form", "multipart/form-data without a boundary")
    with target.open("wb") as stream:
        form = _Form(stream, limit)
        try:
            parser = MultipartParser(boundary, form.callbacks())
            async for chunk in _chunks(request):
                parser.write(chunk)  # one chunk is at most 64 kB: the disk's cache takes it without delay
            parser.finalize()
        except FormParserError as error:
            raise ApiError(400, "malformed-form", f"broken multipart/form-data: {error}") from None
    if not form.found:
        raise ApiError(422, "validation", "file: the form has no part named file with a file in it")
    form.upload.sha256 = form.digest.hexdigest()
    return form.upload


async def receive_body(request: Request, target: Path, limit: int) -> Upload:
    """Read the whole body of `request` to `target`. Raises `ApiError` 413 past `limit`, at once if announced."""
    announced = request.headers.get("content-length", "")
    if announced.isdecimal() and (len(announced) > 18 or int(announced) > limit):
        raise too_large(limit)
    upload, digest = Upload(), hashlib.sha256()
    with target.open("wb") as stream:
        async for chunk in _chunks(request):
            upload.size += len(chunk)
            if upload.size > limit:
                raise too_large(limit)
            digest.update(chunk)
            stream.write(chunk)
    upload.sha256 = digest.hexdigest()
    return upload


async def _chunks(request: Request) -> AsyncIterator[bytes]:
    try:
        async for chunk in request.stream():
            yield chunk
    except ClientDisconnect:
        raise ApiError(400, "disconnected", "the upload was broken off") from None


class _Form:
    """The parser's callbacks: headers of a part, then its data, then its end."""

    def __init__(self, stream: BinaryIO, limit: int) -> None:
        self.upload = Upload()
        self.digest = hashlib.sha256()
        self.found = False
        self._stream = stream
        self._limit = limit
        self._header = bytearray()
        self._value = bytearray()
        self._headers: dict[bytes, bytes] = {}
        self._name = ""
        self._is_file = False
        self._text = bytearray()

    def callbacks(self) -> "MultipartCallbacks":
        return {
            "on_part_begin": self._part_begin,
            "on_header_field": lambda data, start, end: self._header.extend(data[start:end]),
            "on_header_value": lambda data, start, end: self._value.extend(data[start:end]),
            "on_header_end": self._header_end,
            "on_headers_finished": self._headers_finished,
            "on_part_data": self._part_data,
            "on_part_end": self._part_end,
        }

    def _part_begin(self) -> None:
        self._headers = {}
        self._text = bytearray()

    def _header_end(self) -> None:
        self._headers[bytes(self._header).lower()] = bytes(self._value)
        self._header, self._value = bytearray(), bytearray()

    def _headers_finished(self) -> None:
        _, options = parse_options_header(self._headers.get(b"content-disposition", b""))
        self._name = options.get(b"name", b"").decode("utf-8", "replace")
        filename = options.get(b"filename")
        self._is_file = self._name == "file" and filename is not None
        if self._is_file:
            if self.found:
                raise ApiError(422, "validation", "file: one file an upload")
            self.found = True
            self.upload.filename = Path((filename or b"").decode("utf-8", "replace")).name[-LONGEST_NAME:]
        elif self._name not in FIELDS:
            known = ", ".join(("file", *FIELDS))
            raise ApiError(422, "validation", f"{self._name[:80]!r}: no field of this form; expected {known}")
        elif self._name in self.upload.fields:
            raise ApiError(422, "validation", f"{self._name}: given twice")

    def _part_data(self, data: bytes, start: int, end: int) -> None:
        piece = data[start:end]
        if not self._is_file:
            self._text += piece
            if len(self._text) > FIELD_LIMIT:
                raise ApiError(422, "validation", f"{self._name}: longer than {FIELD_LIMIT} bytes")
            return
        self.upload.size += len(piece)
        if self.upload.size > self._limit:
            raise too_large(self._limit)
        self.digest.update(piece)
        self._stream.write(piece)

    def _part_end(self) -> None:
        if not self._is_file:
            self.upload.fields[self._name] = self._text.decode("utf-8", "replace")


def announced(request: Request) -> int:
    """Bytes that are to come; they are stored twice, as they are and as arrays, of about the same size."""
    length = request.headers.get("content-length", "")
    return 2 * int(length) if length.isdecimal() and len(length) < 16 else 0
