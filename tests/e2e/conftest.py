"""A real server in a process of its own, and a real Chromium: nothing here stands in for anything."""

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright

ROOT = Path(__file__).parents[2]
FLIGHT = ROOT / "examples" / "flights" / "loop.csv"
# Software rendering for WebGL; 2D canvases without it, where it is many times slower than the processor itself.
CHROMIUM_ARGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-accelerated-2d-canvas",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-dev-shm-usage",
]


@dataclass(frozen=True)
class Server:
    """A running `fullpose serve`."""

    url: str
    pid: int


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """`fullpose serve` on a free port with an empty data folder, and its rigs stopped at the end."""
    data = tmp_path_factory.mktemp("data")
    log = (data / "server.log").open("w")
    command = [
        sys.executable,
        "-c",
        "from server.cli import main; main()",
        "serve",
        "--port",
        "0",
        "--data-dir",
        str(data),
    ]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=log, text=True)
    try:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        assert url.startswith("http://127.0.0.1:"), (data / "server.log").read_text()
        yield Server(url, process.pid)
    finally:
        process.send_signal(signal.SIGCONT)
        process.terminate()
        process.wait(timeout=30)
        assert process.stdout is not None
        process.stdout.close()
        log.close()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium, headless; none is downloaded."""
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    assert path is not None, "these tests drive a Chromium: apt-get install chromium"
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=CHROMIUM_ARGS)
        yield chromium
        chromium.close()


@pytest.fixture
def context(browser: Browser, server: Server) -> Iterator[BrowserContext]:
    """A fresh browser profile, on a desk's screen, in the dark theme."""
    made = browser.new_context(base_url=server.url, viewport={"width": 1440, "height": 900}, color_scheme="dark")
    yield made
    made.close()


@pytest.fixture
def page(context: BrowserContext, server: Server) -> Iterator[Page]:
    """A page that fails the test where a script fails or where anything is asked of another host."""
    wrong: list[str] = []
    opened = context.new_page()
    opened.on("pageerror", lambda error: wrong.append(f"script: {error}"))
    opened.on("request", lambda sent: None if _ours(sent.url, server.url) else wrong.append(f"request: {sent.url}"))
    yield opened
    assert wrong == []


@pytest.fixture
def shots(tmp_path: Path) -> Path:
    """Where screenshots go: the folder named by FULLPOSE_SHOTS, to be looked at, else the test's own."""
    folder = Path(os.environ.get("FULLPOSE_SHOTS") or tmp_path)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _ours(url: str, server: str) -> bool:
    return url.startswith((f"{server}/", "data:", "blob:"))
