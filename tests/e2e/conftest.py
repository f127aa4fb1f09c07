"""A real server in a process of its own, and a real Chromium: nothing here stands in for anything."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, BrowserContext, Page, ViewportSize, expect, sync_playwright

from tests.support.repository import ROOT

FLIGHTS = ROOT / "examples" / "flights"
FLIGHT = FLIGHTS / "loop.csv"
FULLPOSE = (sys.executable, "-c", "from fullpose_server.cli import main; main()")
PATIENT_MS = 120_000  # a page, a click or a picture on a machine that does much else
expect.set_options(timeout=PATIENT_MS)
TROUBLED = "troubled"  # a rig that is left E-stopped: no other test's
DESK: ViewportSize = {"width": 1440, "height": 900}
TABLET: ViewportSize = {"width": 1024, "height": 768}
# Software rendering for WebGL alone: pages and 2D canvases are drawn many times faster by the processor itself.
CHROMIUM_ARGS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
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

    @property
    def gate(self) -> int:
        """The process of its stop gate."""
        children = Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text().split()
        return next(int(pid) for pid in children if "gate.process" in Path(f"/proc/{pid}/cmdline").read_text())


class Pages:
    """Browser windows of one test, each of a profile of its own, and what went wrong in them."""

    def __init__(self, browser: Browser, server: Server) -> None:
        self._browser = browser
        self._server = server
        self._contexts: list[BrowserContext] = []
        self.wrong: list[str] = []
        self.elsewhere: list[str] = []  # addresses that pages may go to beside the server's

    def open(self, *, viewport: ViewportSize = DESK, touch: bool = False, scene: bool = False) -> Page:
        """A page of a fresh profile. Scenes are drawn only where asked for: software rendering takes a core each."""
        context = self._browser.new_context(
            base_url=self._server.url, viewport=viewport, has_touch=touch, color_scheme="dark"
        )
        self._contexts.append(context)
        context.set_default_timeout(PATIENT_MS)
        page = context.new_page()
        if not scene:
            page.route("**/scene/*/", lambda route: route.fulfill(body="<!doctype html>", content_type="text/html"))
        page.on("pageerror", lambda error: self.wrong.append(f"script: {error}"))
        page.on("request", lambda sent: None if self._ours(sent.url) else self.wrong.append(f"request: {sent.url}"))
        return page

    def close(self) -> None:
        """Close them all."""
        for context in self._contexts:
            context.close()

    def _ours(self, url: str) -> bool:
        return url.startswith((f"{self._server.url}/", "data:", "blob:", *self.elsewhere))


@dataclass(frozen=True)
class Stock:
    """What is on the server before a test begins: a flight, a plan of it that is not feasible, a comparison."""

    flight: str
    plan: dict[str, Any]
    comparison: dict[str, Any]


@contextmanager
def serving(data: Path, **settings: str) -> Iterator[Server]:
    """`fullpose serve` on a free port with this data folder; its rigs are stopped at the end."""
    log = (data / "server.log").open("w")
    command = [*FULLPOSE, "serve", "--port", "0", "--data-dir", str(data)]
    # The machine of the tests may starve a live source: bridged longer than on a quiet one.
    patient = {"FULLPOSE_LIVE_DELAY_MS": "20", "FULLPOSE_LIVE_EXTRAPOLATE_MS": "1000"}
    patient["FULLPOSE_RIG_RATE_HZ"] = "250"  # each loop of 1 kHz takes a sixth of a core, and five come to be connected
    process = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=log, text=True, env={**os.environ, **patient, **settings}
    )
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
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server with an empty data folder, where nobody need sign in."""
    data = tmp_path_factory.mktemp("data")
    (data / "rigs").mkdir()
    (data / "rigs" / f"{TROUBLED}.toml").write_text(f'name = "{TROUBLED}"\ngeometry = "vertical-4"\n', encoding="utf-8")
    with serving(data) as running:
        yield running


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
def pages(browser: Browser, server: Server) -> Iterator[Pages]:
    """Opens pages that fail the test where a script fails or where anything is asked of another host."""
    opener = Pages(browser, server)
    yield opener
    opener.close()
    assert opener.wrong == []


@pytest.fixture
def page(pages: Pages) -> Page:
    """A page on a desk's screen, in the dark theme, without the scene."""
    return pages.open()


@pytest.fixture(scope="session")
def stocked(server: Server) -> Stock:
    """A flight on the server, planned in vain by `exact` for a rig too narrow for it, and compared there."""
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=60.0) as client:
        with (FLIGHTS / "slow_roll.csv").open("rb") as file:
            form = {"name": "Slow roll", "convention": "ned"}
            flight = client.post("/trajectories", data=form, files={"file": file}).raise_for_status().json()["sha256"]
        wanted = {"trajectory": flight, "rig": "vertical-limited"}
        plan = client.post("/plans", json={**wanted, "method": "exact"}).raise_for_status().json()
        methods = ["exact", "plan", "preview", "gradient_projection", "three_axis"]
        comparison = client.post("/compare", json={**wanted, "methods": methods}).raise_for_status().json()
        return Stock(flight, _done(client, f"/plans/{plan['id']}"), _done(client, f"/compare/{comparison['id']}"))


@pytest.fixture
def shots(tmp_path: Path) -> Path:
    """Where screenshots go: the folder named by SHOTS_FOLDER, to be looked at, else the test's own."""
    folder = Path(os.environ.get("SHOTS_FOLDER") or tmp_path)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _done(client: httpx.Client, path: str) -> dict[str, Any]:
    """A job's answer, once it has ended."""
    end = time.monotonic() + 300.0
    while (job := client.get(path).raise_for_status().json())["status"] in ("queued", "running"):
        assert time.monotonic() < end, f"{path} does not end"
        time.sleep(0.1)
    assert job["status"] == "done", job["error"]
    return dict(job)
