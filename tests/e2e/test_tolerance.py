"""The tolerance of a noisy recorded flight, moved by its slider on a real server, and planned within."""

from pathlib import Path

import httpx
from playwright.sync_api import Page, expect

from tests.e2e.conftest import Server
from tests.e2e.console import SLOW_MS, SOON_MS, Console
from tests.support.recorded import grid, noisy, quaternion, truth

SIGMA_DEG = 0.02


def noisy_flight(server: Server) -> str:
    """A flight with noise, on the server; its hash."""
    time = grid(500.0, 1.5)
    q = quaternion(noisy(truth("gentle", time), SIGMA_DEG))
    body = {"name": "A noisy flight", "time_s": time.tolist(), "q": q.tolist()}
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=300.0) as client:
        sha256: str = client.post("/trajectories", json=body).raise_for_status().json()["sha256"]
        client.get(f"/trajectories/{sha256}/tolerance").raise_for_status()  # compiled before the page's time runs
    return sha256


def test_the_slider_shows_what_a_tolerance_does_and_the_plan_is_within_it(
    server: Server, page: Page, shots: Path
) -> None:
    flight = noisy_flight(server)
    console = Console(page, "vertical-limited")
    console.open()
    page.get_by_role("combobox", name="Flight", exact=True).select_option(flight)
    page.get_by_label("Within a tolerance").check()
    slider = page.get_by_role("slider", name="Tolerance")
    expect(slider).to_be_visible(timeout=SLOW_MS)
    deviation = page.locator("dt", has_text="Deviation").locator("xpath=following-sibling::dd")
    suggested, before = slider.get_attribute("aria-valuetext"), deviation.inner_text()
    slider.focus()
    for _ in range(30):
        page.keyboard.press("ArrowLeft")
    assert slider.get_attribute("aria-valuetext") != suggested
    expect(deviation).not_to_have_text(before, timeout=SLOW_MS)
    expect(page.get_by_text("Too tight")).to_be_visible(timeout=SLOW_MS)
    page.screenshot(path=shots / "tolerance-slider.png")
    for _ in range(40):
        page.keyboard.press("ArrowRight")
    expect(page.get_by_text("Too tight")).to_have_count(0, timeout=SLOW_MS)
    tolerance = slider.get_attribute("aria-valuetext")
    assert tolerance is not None
    page.get_by_label("Method", exact=True).select_option("exact")
    page.get_by_role("button", name="Plan", exact=True).click()
    expect(console.plan).to_have_attribute("data-status", "done", timeout=SLOW_MS)
    expect(console.plan).to_have_attribute("data-flyable", "true", timeout=SOON_MS)
    console.plan.get_by_role("link", name="Open").click()
    expect(page.get_by_test_id("tolerance")).to_contain_text(tolerance, timeout=SOON_MS)


def test_methods_are_compared_within_a_tolerance(server: Server, page: Page) -> None:
    flight = noisy_flight(server)
    page.goto("/compare")
    form = page.get_by_role("form", name="New comparison")
    form.get_by_label("Flight").select_option(flight)
    form.get_by_label("Within a tolerance").check()
    expect(form.get_by_role("slider", name="Tolerance")).to_be_visible(timeout=SLOW_MS)
    form.get_by_role("button", name="None").or_(form.get_by_role("button", name="All")).click()
    with page.expect_request(lambda sent: sent.method == "POST" and sent.url.endswith("/compare")) as asked:
        form.get_by_role("button", name="Compare").click()
    assert asked.value.post_data_json["tolerance_deg"] > SIGMA_DEG
