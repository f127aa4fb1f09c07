"""The log's two forms, as a process writes them."""

import json
import logging
import re
from collections.abc import Iterator
from datetime import datetime

import pytest
from asgi_correlation_id import correlation_id

from fullpose_server.logs import LogFormat, LogLevel, LogSettings, configure

ID = "0123456789abcdef0123456789abcdef"
log = logging.getLogger("fullpose_server.test")


@pytest.fixture(autouse=True)
def _restored() -> Iterator[None]:
    root = logging.getLogger()
    before, level = list(root.handlers), root.level
    correlation_id.set(None)
    yield
    root.handlers[:] = before
    root.setLevel(level)
    correlation_id.set(None)


def entry(capsys: pytest.CaptureFixture[str]) -> str:
    (line,) = capsys.readouterr().err.splitlines()
    return line


def test_text_has_time_with_zone_level_writer_and_request(capsys: pytest.CaptureFixture[str]) -> None:
    configure(LogSettings(LogFormat.TEXT, LogLevel.WARNING))
    log.info("nobody asked for this")
    correlation_id.set(ID)
    log.warning("the disk is %d %% full", 97)
    found = re.fullmatch(rf"(\S+) WARNING fullpose_server\.test \[{ID}\] (.*)", entry(capsys))
    assert found is not None
    assert datetime.fromisoformat(found[1]).utcoffset() is not None
    assert found[2] == "the disk is 97 % full"


def test_json_is_one_object_a_line_with_what_was_said_beside_it(capsys: pytest.CaptureFixture[str]) -> None:
    configure(LogSettings(LogFormat.JSON, LogLevel.INFO))
    log.info("answered\nin %d ms", 3, extra={"path": "/a\nb", "status": 200})
    told = json.loads(entry(capsys))
    assert datetime.fromisoformat(told.pop("time")).utcoffset() is not None
    assert told == {
        "level": "INFO",
        "logger": "fullpose_server.test",
        "message": "answered\nin 3 ms",
        "request_id": None,
        "path": "/a\nb",
        "status": 200,
    }


def test_an_error_has_its_traceback_in_both(capsys: pytest.CaptureFixture[str]) -> None:
    def fail() -> None:
        try:
            raise ValueError("of ours")
        except ValueError:
            log.exception("unexpected")

    configure(LogSettings(LogFormat.JSON))
    fail()
    assert "ValueError: of ours" in json.loads(entry(capsys))["exc_info"]
    configure(LogSettings(LogFormat.TEXT))
    fail()
    assert "ValueError: of ours" in capsys.readouterr().err
