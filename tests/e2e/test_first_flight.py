"""A person who has never seen it flies within seven interactions, by the labels that are in sight."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, expect

from tests.e2e.conftest import FLIGHT, FLIGHTS, Pages, Server, serving
from tests.e2e.console import SLOW_MS, Console

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server that has nothing yet."""
    with serving(tmp_path_factory.mktemp("empty")) as running:
        yield running


@pytest.fixture
def pages(browser: Browser, empty: Server) -> Iterator[Pages]:
    """Pages of that server."""
    opener = Pages(browser, empty)
    yield opener
    opener.close()
    assert opener.wrong == []


class Hand:
    """Presses and chooses, and counts: each is one interaction."""

    def __init__(self) -> None:
        self.count = 0

    def press(self, what: Locator) -> None:
        self.count += 1
        what.click()

    def choose(self, what: Locator, value: str) -> None:
        self.count += 1
        what.select_option(value)

    def give(self, what: Locator, file: Path) -> None:
        self.count += 1
        what.set_input_files(file)


def test_an_empty_server_leads_to_a_first_flight(pages: Pages, shots: Path) -> None:
    page = pages.open()
    hand, console = Hand(), Console(page, "vertical-4")
    page.goto("/")
    guide = page.get_by_role("region", name="Your first flight")
    step = guide.locator("[aria-current=step]")
    expect(step).to_have_text("Take control", timeout=SLOW_MS)
    page.screenshot(path=shots / "first-flight.png")
    hand.press(page.get_by_role("button", name="Take control"))
    expect(step).to_have_text("Connect", timeout=SLOW_MS)
    hand.press(page.get_by_role("button", name="Connect"))
    expect(step).to_have_text("Drop a flight", timeout=SLOW_MS)
    hand.choose(page.get_by_label("Convention of the file"), "ned")
    hand.give(page.get_by_label("Flight file"), FLIGHT)
    expect(step).to_have_text("Plan", timeout=SLOW_MS)
    hand.press(page.get_by_role("button", name="Plan", exact=True))
    expect(console.plan).to_have_attribute("data-flyable", "true", timeout=SLOW_MS)
    expect(step).to_have_text("Load and arm")
    page.screenshot(path=shots / "first-flight-planned.png")
    hand.press(page.get_by_role("button", name="Load and arm"))
    start = page.get_by_role("button", name=re.compile("^Start loop"))
    expect(start).to_be_enabled(timeout=SLOW_MS)
    expect(page.get_by_test_id("loaded")).to_have_text(re.compile("Start flies loop"))
    hand.press(start)
    console.expect_state("running")
    assert hand.count <= 7
    page.keyboard.press("Escape")
    console.expect_state("armed")
    page.screenshot(path=shots / "first-flight-flown.png")


def test_what_is_not_feasible_is_remedied_and_flown(pages: Pages, shots: Path) -> None:
    page = pages.open()
    console = Console(page, "vertical-limited")
    console.open()
    console.take_control()
    console.give("connect", "idle")
    console.upload(FLIGHTS / "slow_roll.csv", "ned")
    console.chosen("slow_roll")
    page.get_by_label("Method", exact=True).select_option("exact")
    page.get_by_role("button", name="Plan", exact=True).click()
    expect(console.plan).to_have_attribute("data-status", "done", timeout=SLOW_MS)
    expect(console.plan).to_have_attribute("data-flyable", "false")
    hand = Hand()
    hand.press(page.get_by_role("button", name="Plan the whole flight"))
    expect(console.plan).to_have_attribute("data-flyable", "true", timeout=SLOW_MS)
    page.screenshot(path=shots / "remedied.png")
    hand.press(page.get_by_role("button", name="Load and arm"))
    start = page.get_by_role("button", name=re.compile("^Start slow_roll"))
    expect(start).to_be_enabled(timeout=SLOW_MS)
    hand.press(start)
    console.expect_state("running")
    assert hand.count <= 4
    page.keyboard.press("Escape")
    console.expect_state("armed")

    # Another is chosen: Start is off, and says so; one step, once asked, loads and arms it instead.
    plans = page.get_by_label("Plan", exact=True)
    plans.select_option(index=1)
    expect(page.get_by_test_id("loaded")).to_have_attribute("data-differs", "true")
    expect(console.button("start")).to_be_disabled()
    page.screenshot(path=shots / "another-chosen.png")
    plans.select_option(index=0)
    expect(page.get_by_test_id("loaded")).to_have_attribute("data-differs", "false")
    expect(console.button("start")).to_be_enabled()


def test_keys_and_palette(pages: Pages) -> None:
    page = pages.open()
    console = Console(page, "horizontal-4")
    console.open()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog", name="Keys")).to_contain_text("Ctrl K")
    page.keyboard.press("Control+k")
    palette = page.get_by_role("dialog", name="Pages and commands")
    expect(palette).to_be_visible()
    page.keyboard.type("resume")
    expect(palette.get_by_role("option")).to_contain_text("Not allowed while disconnected")
    page.keyboard.press("Control+k")
    expect(palette).to_be_hidden()
    page.keyboard.press("Control+k")
    page.keyboard.type("plans")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="Plans", exact=True)).to_be_visible()


def test_the_lease_ends_with_its_tab(pages: Pages) -> None:
    one, other = Console(pages.open(), "horizontal-3"), Console(pages.open(), "horizontal-3")
    one.open()
    other.open()
    one.take_control()
    expect(other.page.get_by_role("button", name="Ask for control")).to_be_visible()
    one.page.reload()
    expect(one.page.get_by_test_id("lease")).to_have_attribute("data-held", "true", timeout=SLOW_MS)
    one.page.close(run_before_unload=True)
    expect(other.page.get_by_role("button", name="Take control")).to_be_visible(timeout=SLOW_MS)
