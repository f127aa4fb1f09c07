"""The log of a server's processes, on stderr: text for people or JSON for collectors, one line an entry.

Every entry has its time with the zone, its level and who wrote it; what was written while a request was answered has
that request's id, which the answer has in X-Request-ID.
"""

import logging
import sys
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum

from asgi_correlation_id import CorrelationIdFilter
from pythonjsonlogger.json import JsonFormatter


class LogFormat(StrEnum):
    """What an entry looks like."""

    TEXT = "text"
    JSON = "json"


class LogLevel(StrEnum):
    """What is written: at `info` a line for every request, too."""

    DEBUG = "debug"
    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class LogSettings:
    """How a process logs."""

    form: LogFormat = LogFormat.TEXT
    level: LogLevel = LogLevel.WARNING

    def arguments(self) -> list[str]:
        """As a process of the server's is told."""
        return ["--log-format", self.form.value, "--log-level", self.level.value]


def stamp(record: logging.LogRecord) -> str:
    """The time of an entry: ISO 8601 with milliseconds and the zone's offset."""
    return datetime.fromtimestamp(record.created).astimezone().isoformat(timespec="milliseconds")


class _Text(logging.Formatter):
    def formatTime(self, record: logging.LogRecord, datefmt: str | None = None) -> str:  # noqa: N802, ARG002
        return stamp(record)


class _Json(JsonFormatter):
    def formatTime(self, record: logging.LogRecord, datefmt: str | None = None) -> str:  # noqa: N802, ARG002
        return stamp(record)


def configure(settings: LogSettings) -> None:
    """Have this process log to stderr."""
    handler = logging.StreamHandler(sys.stderr)
    none = None if settings.form is LogFormat.JSON else "-"
    handler.addFilter(CorrelationIdFilter(uuid_length=32, default_value=none))
    if settings.form is LogFormat.JSON:
        fields = {"asctime": "time", "levelname": "level", "name": "logger", "correlation_id": "request_id"}
        handler.setFormatter(
            _Json("{asctime}{levelname}{name}{message}{correlation_id}", style="{", rename_fields=fields)
        )
    else:
        handler.setFormatter(_Text("%(asctime)s %(levelname)s %(name)s [%(correlation_id)s] %(message)s"))
    root = logging.getLogger()
    for other in list(root.handlers):
        root.removeHandler(other)
    root.addHandler(handler)
    root.setLevel(settings.level.value.upper())
    # What a client sends as an id may be none: it gets a new one, which is no news. Nor are requests of our own.
    logging.getLogger("asgi_correlation_id").setLevel(logging.ERROR)
    logging.getLogger("httpx").setLevel(logging.WARNING)
