"""The console when the server does not answer, and when others work on the same server."""

import os
import signal

import pytest
from playwright.sync_api import Page, Route, expect

from tests.e2e.conftest import FLIGHT, Server, Stock
from tests.e2e.console import SLOW_MS, SOON_MS, Console

pytestmark = pytest.mark.browser

DROP = """(selector) => {
    const data = new DataTransfer();
    data.items.add(new File(["x"], "beside.csv", { type: "text/csv" }));
    const drag = (type) => new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true });
    // True where the browser keeps its hands off the file.
    return ["dragover", "drop"].map((type) => !document.querySelector(selector).dispatchEvent(drag(type)));
}"""


def test_a_stop_that_nobody_answered_is_never_taken_for_one(page: Page, server: Server) -> None:
    console = Console(page, "horizontal-3")
    console.open()
    alerts, unconfirmed = page.get_by_role("alert"), page.get_by_test_id("unconfirmed")
    lost = alerts.filter(has_text="Connection lost")
    page.get_by_role("navigation", name="Pages").get_by_role("link", name="Rigs").click()
    channel = page.get_by_test_id("stop-round-trip")
    expect(channel).to_contain_text("ms", timeout=SOON_MS)
    os.kill(server.pid, signal.SIGSTOP)
    try:
        # The stop gate is a process of its own: with the server alone stopped, stops still go.
        expect(lost).to_contain_text("by their own channel, which is open", timeout=SOON_MS)
        expect(channel).to_contain_text("ms")
        os.kill(server.gate, signal.SIGSTOP)
        page.keyboard.press("Escape")
        expect(unconfirmed).to_contain_text("Stop not confirmed: The server did not answer within 2 s", timeout=SOON_MS)
        # On every page, and in plain words.
        expect(lost).to_contain_text("Stop and E-stop cannot reach the rig", timeout=SOON_MS)
        expect(lost).to_contain_text("use the hardware E-stop")
        expect(page.get_by_text("still work")).to_have_count(0)
        expect(page.get_by_role("banner")).to_contain_text("last known")
        page.get_by_role("button", name="E-stop").click()
        expect(unconfirmed).to_contain_text("E-stop not confirmed", timeout=SOON_MS)
        page.get_by_role("button", name="Try again").click()
        page.wait_for_timeout(2500)
        expect(unconfirmed).to_be_visible()
    finally:
        os.kill(server.gate, signal.SIGCONT)
        os.kill(server.pid, signal.SIGCONT)
    # A rig without a drive has nothing left to stop.
    expect(lost).to_be_hidden(timeout=SOON_MS)
    expect(unconfirmed).to_be_hidden(timeout=SOON_MS)


def test_a_console_that_knows_no_rig_says_so_and_keeps_asking(page: Page) -> None:
    page.route("**/api/v1/rigs", lambda route: route.abort())
    page.goto("/operate/horizontal-3")
    expect(page.get_by_role("alert").filter(has_text="No rig is known yet")).to_be_visible(timeout=SOON_MS)
    page.keyboard.press("Escape")
    unconfirmed = page.get_by_test_id("unconfirmed")
    expect(unconfirmed).to_contain_text("this console knows no rig yet")
    page.unroute("**/api/v1/rigs")
    Console(page, "horizontal-3").expect_state("disconnected")
    expect(unconfirmed).to_be_hidden(timeout=SOON_MS)


def test_a_plan_outlives_a_network_that_fails(page: Page) -> None:
    console = Console(page, "horizontal-3")
    console.open()
    console.upload(FLIGHT, "ned")
    expect(page.get_by_label("Flight", exact=True).locator("option:checked")).to_contain_text("loop", timeout=SOON_MS)
    failing = True

    def answer(route: Route) -> None:
        if failing:
            route.abort()
        else:
            route.continue_()

    page.route("**/api/v1/plans/*", answer)
    page.get_by_role("button", name="Plan", exact=True).click()
    problem = page.get_by_role("alert").filter(has_text="Not up to date")
    expect(problem).to_be_visible(timeout=SOON_MS)
    failing = False
    expect(console.plan).to_have_attribute("data-status", "done", timeout=SLOW_MS)
    expect(problem).to_be_hidden(timeout=SOON_MS)


def test_what_others_made_is_seen_on_the_next_page(page: Page, stocked: Stock) -> None:
    page.goto("/plans")
    plans = page.get_by_role("main").get_by_role("listitem")
    expect(plans.first).to_be_visible(timeout=SOON_MS)
    before = plans.count()
    pages = page.get_by_role("navigation", name="Pages")
    wanted = {"trajectory": stocked.flight, "rig": "horizontal-3", "method": "three_axis"}
    assert page.request.post("/api/v1/plans", data=wanted).ok
    pages.get_by_role("link", name="Rigs").click()
    pages.get_by_role("link", name="Plans").click()
    expect(plans).to_have_count(before + 1, timeout=SOON_MS)


def test_a_file_that_falls_beside_does_not_take_the_console_away(page: Page) -> None:
    stored = page.request.get("/api/v1/trajectories").json()
    page.goto("/runs")
    expect(page.get_by_role("heading", name="Runs")).to_be_visible(timeout=SOON_MS)
    # What is said goes when a rig is chosen, and the first one is chosen once the server has told which there are.
    expect(page.get_by_role("combobox", name="Rig")).not_to_have_value("")
    assert page.evaluate(DROP, "h1") == [True, True]
    expect(page.get_by_role("alert").filter(has_text="Nothing was taken")).to_be_visible()
    # A page that takes flights takes it wherever it falls: this one is no flight, and is refused in words.
    page.goto("/trajectories")
    expect(page.get_by_role("heading", name="Flights")).to_be_visible(timeout=SOON_MS)
    assert page.evaluate(DROP, "h1") == [True, True]
    expect(page.get_by_role("main").get_by_role("alert")).to_be_visible(timeout=SOON_MS)
    assert page.request.get("/api/v1/trajectories").json() == stored
