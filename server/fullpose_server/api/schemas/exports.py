"""The kinds of file that plans and runs go out as, on the wire."""

from pydantic import Field

from fullpose_server.api.schemas.base import Wire
from fullpose_server.formats.exporters.registry import ExportKind


class ExportKindOut(Wire):
    """A kind of file."""

    format: ExportKind = Field(description="What `export` is asked for, and the ending of the file")
    label: str = Field(description="What people call it")
    available: bool = Field(description="False: this server is without the library that it takes")
    install: str | None = Field(description="What to type on the server for that library; null: it needs none")
