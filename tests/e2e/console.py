"""The console as a test speaks of it: what an operator does and sees."""

import re
import time
from collections.abc import Callable
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

FRAMES = ("base", "outer", "middle", "inner")
SOON_MS = 120_000  # what a quiet machine does at once: a slow one makes a test slow, not red
SLOW_MS = 120_000  # a plan that is solved, kernels compiled on the way


class Console:
    """The operate page of one rig."""

    def __init__(self, page: Page, rig: str) -> None:
        self.page = page
        self.rig = rig
        self.state = page.get_by_test_id("state")
        self.plan = page.get_by_test_id("plan")

    def open(self) -> None:
        """Go to the rig's page and wait until the server has said what state it is in."""
        self.page.goto(f"/operate/{self.rig}")
        expect(self.state).to_have_attribute("data-state", re.compile(r"\w+"), timeout=SOON_MS)

    def button(self, command: str) -> Locator:
        """A command's button."""
        return self.page.locator(f"[data-command={command}]")

    def give(self, command: str, then: str, within_ms: int = SOON_MS) -> None:
        """Press a command's button and wait for the state it leads to."""
        self.button(command).click(timeout=SOON_MS)
        self.expect_state(then, within_ms)

    def expect_state(self, state: str, within_ms: int = SOON_MS) -> None:
        """Wait for a session state."""
        expect(self.state).to_have_attribute("data-state", state, timeout=within_ms)

    def take_control(self) -> None:
        """Take the lease."""
        self.page.get_by_role("button", name="Take control").click(timeout=SOON_MS)
        expect(self.page.get_by_test_id("lease")).to_have_attribute("data-held", "true", timeout=SLOW_MS)

    def upload(self, file: Path, convention: str) -> None:
        """Give a flight to the file field."""
        self.page.get_by_label("Convention of the file").select_option(convention)
        self.page.get_by_label("Flight file").set_input_files(file)

    def chosen(self, flight: str) -> None:
        """Wait until it is this flight that would be planned: an upload takes a moment."""
        checked = self.page.get_by_label("Flight", exact=True).locator("option:checked")
        expect(checked).to_contain_text(flight, timeout=SOON_MS)

    def solve(self, method: str) -> None:
        """Plan the chosen flight and wait until it can be flown."""
        self.page.get_by_label("Method", exact=True).select_option(method)
        self.page.get_by_role("button", name="Plan", exact=True).click()
        expect(self.plan).to_have_attribute("data-status", "done", timeout=SLOW_MS)
        expect(self.plan).to_have_attribute("data-flyable", "true")

    def fly(self, file: Path, convention: str = "ned", method: str = "exact") -> None:
        """From a disconnected rig to a running flight, the first sample of it past."""
        self.take_control()
        self.give("connect", "idle")
        self.upload(file, convention)
        self.chosen(file.stem)
        self.solve(method)
        self.give("load", "ready")
        self.give("arm", "armed")
        self.button("start").click()
        self.expect_state("running")
        self.until(lambda: self.path_time() > 0.0)

    def path_time(self) -> float:
        """Time in the flight that the page shows [s]; negative in the lead-in."""
        minutes, seconds = self.page.get_by_test_id("path-time").inner_text().replace("−", "-").split(":")
        sign = -1.0 if minutes.startswith("-") else 1.0
        return 60.0 * float(minutes) + sign * float(seconds)

    def angles(self) -> list[float]:
        """The four measured angles that the page shows [deg]."""
        shown = [self.page.get_by_test_id(f"angle-{name}").inner_text() for name in FRAMES]
        return [float(text.replace("−", "-")) for text in shown]

    def error(self, kind: str) -> float:
        """The solve or tracking error as the page got it [deg]."""
        return float(self.page.get_by_test_id(f"{kind}-error").get_attribute("data-value") or "nan")

    def rates(self) -> list[float]:
        """The four measured rates that the page shows [deg/s]."""
        shown = [self.page.get_by_test_id(f"rate-{name}").inner_text() for name in FRAMES]
        return [float(text.replace("−", "-")) for text in shown]

    def put_scene_away(self) -> None:
        """Software rendering takes a core: what was looked at is put away."""
        self.page.get_by_role("button", name="Show the scene").click()
        expect(self.page.locator("iframe")).to_be_hidden()

    def at_rest(self) -> None:
        """Wait until no frame turns."""
        self.until(lambda: max(map(abs, self.rates())) < 0.05)

    def until(self, condition: Callable[[], bool], within_s: float = SLOW_MS / 1000.0) -> None:
        """Wait for something the page shows."""
        end = time.monotonic() + within_s
        while not condition():
            assert time.monotonic() < end, "the page did not come to show it"
            self.page.wait_for_timeout(50)
