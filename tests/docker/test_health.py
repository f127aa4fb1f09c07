"""The container's health check: a server that does not answer fails it; tests/containers has what else does."""

import runpy

import pytest

from tests.support.repository import ROOT

PATH = ROOT / "docker" / "health.py"


def test_a_server_that_is_not_there(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("FULLPOSE_PORT", "1")
    assert runpy.run_path(str(PATH))["main"]() == 1
    assert capsys.readouterr().out.startswith("the server does not answer: ")


def test_it_needs_nothing_that_is_installed() -> None:
    text = PATH.read_text()
    assert "import httpx" not in text
    assert "import fullpose" not in text
