"""A test engineer asks whether a rig can fly a flight, why not, and which method would."""

import math
import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import Pages, Stock
from tests.e2e.console import SLOW_MS, SOON_MS, Console
from tests.e2e.picture import changed, colours

pytestmark = pytest.mark.browser


def test_a_plan_is_scrubbed_and_says_what_closes_its_way(pages: Pages, stocked: Stock, shots: Path) -> None:
    page = pages.open(scene=True)
    page.goto(f"/plans/{stocked.plan['id']}")
    console = Console(page, "vertical-limited")
    at, scene = page.get_by_test_id("at"), page.locator("iframe")

    def now() -> float:
        return float(at.get_attribute("data-value") or "nan")

    # The sentence names what the report does, and the playhead stands there.
    block = stocked.plan["report"]["blocking"]
    sentence = page.get_by_test_id("blocking")
    expect(sentence).to_contain_text(f"At {block['time_s']:.3f} s the {block['frame']} frame", timeout=SOON_MS)
    expect(sentence).to_contain_text(f"{block['limit']} limit of ±60 deg")
    expect(at).to_be_visible(timeout=SOON_MS)
    assert now() == pytest.approx(block["time_s"])
    shown = page.get_by_test_id(f"at-{block['frame']}")
    expect(shown).to_contain_text(re.compile(r"\d"), timeout=SOON_MS)

    # Through time by key and by slider: the scene's ghost and the figures follow the plan.
    console.until(lambda: colours(scene.screenshot()) > 100)
    before, blocked = scene.screenshot(), shown.inner_text()
    page.keyboard.press("End")
    assert now() > block["time_s"]
    expect(shown).not_to_have_text(blocked)
    console.until(lambda: changed(before, scene.screenshot()) > 0.002)
    page.screenshot(path=shots / "plan-end.png")
    console.put_scene_away()
    page.get_by_label("Time", exact=True).fill("2")
    assert now() == 2.0
    page.keyboard.press("Shift+ArrowRight")
    assert now() == 3.0
    page.get_by_role("button", name="Play").click()
    console.until(lambda: now() > 3.3)
    page.get_by_role("button", name="Pause").click()

    # A margin leads to its moment, and to the plots of its quantity.
    margin = stocked.plan["margins"]["inner"]["rate_deg_s"]
    page.locator("[data-margin='inner rate']").click()
    assert now() == pytest.approx(margin["time_s"])
    expect(page.get_by_role("img", name="inner Rate")).to_be_visible()


def test_methods_stand_side_by_side(page: Page, stocked: Stock, shots: Path) -> None:
    page.goto("/compare")
    form = page.get_by_role("form", name="New comparison")
    form.get_by_label("Flight").select_option(stocked.flight, timeout=SOON_MS)
    form.get_by_label("Rig").select_option("vertical-limited")
    form.get_by_role("button", name="All").click()
    form.get_by_role("button", name="None").click()
    expect(form.get_by_role("button", name="Compare")).to_be_disabled()
    for name in ("plan", "exact", "lagrange"):
        form.get_by_role("checkbox", name=name, exact=True).check()
    form.get_by_role("button", name="Compare").click()
    comparison = page.get_by_test_id("comparison")
    expect(page).to_have_url(re.compile(r"/compare/\w+$"), timeout=SOON_MS)
    expect(comparison).to_have_attribute("data-status", "done", timeout=SLOW_MS)

    # What cannot be flown is told from what can, and figures are those of the API.
    row = {name: page.locator(f"[data-method={name}]") for name in ("plan", "exact", "lagrange")}
    expect(row["plan"]).to_have_attribute("data-standing", "Exact, inside limits")
    expect(row["exact"]).to_have_attribute("data-standing", "Not feasible")
    expect(row["plan"].locator("[data-column=exact]")).to_contain_text("100 %")
    expect(page.get_by_text("plan flies it exactly within the limits.")).to_be_visible()
    page.screenshot(path=shots / "compare-done.png")
    address = page.get_by_role("link", name="plots").get_attribute("href")
    assert address is not None
    answer = page.request.get(address)
    assert answer.ok
    assert "<svg" in answer.text()

    # One that is under way can be cancelled; it stays in the list, and goes when it is removed.
    form.get_by_role("button", name="All").click()
    form.get_by_role("button", name="Compare").click()
    page.get_by_role("button", name="Cancel").click(timeout=SOON_MS)
    expect(comparison).to_have_attribute("data-status", "cancelled", timeout=SOON_MS)
    listed = page.get_by_role("navigation", name="Comparisons").get_by_role("listitem")
    count = listed.count()
    page.get_by_role("button", name="Remove this comparison").click()
    expect(listed).to_have_count(count - 1)


def test_a_flight_that_does_not_fit_is_flown_slower(page: Page, shots: Path) -> None:
    rows = [
        f"{t},{150 * math.sin(2.6 * t)},{60 * math.sin(3.1 * t)},{140 * math.sin(3.9 * t)}"
        for t in (k / 100 for k in range(150))
    ]
    table = "\n".join(["time_s,yaw_deg,pitch_deg,roll_deg", *rows]).encode()
    file = {"name": "too-fast.csv", "mimeType": "text/csv", "buffer": table}
    sent = page.request.post("/api/v1/trajectories", multipart={"file": file, "name": "Too fast", "convention": "nue"})
    wanted = {"trajectory": sent.json()["sha256"], "rig": "vertical-limited", "method": "plan"}
    plan = page.request.post("/api/v1/plans", data=wanted).json()["id"]
    page.goto(f"/plans/{plan}")
    remedies = page.get_by_role("region", name="Remedies")
    expect(remedies).to_be_visible(timeout=SLOW_MS)
    expect(page.get_by_role("button", name="Operate", exact=True)).to_be_disabled()
    remedies.get_by_role("button", name="Fly it slower").click()
    row = page.locator("[data-remedy=slow_down]")
    expect(row).to_have_attribute("data-status", re.compile("queued|running"), timeout=SOON_MS)
    expect(row).to_have_attribute("data-status", "done", timeout=SLOW_MS)
    expect(row).to_contain_text("times as slow")
    expect(row).to_have_attribute("data-flyable", "true")
    page.screenshot(path=shots / "plan-remedies.png")

    # The remedy is a plan that says what was changed, also where the operator is offered it.
    row.get_by_role("link", name="Open the plan").click()
    expect(page.get_by_test_id("remedy")).to_contain_text("times as slow", timeout=SOON_MS)
    slowed = page.request.get(f"/api/v1/plans/{page.url.rsplit('/', 1)[1]}").json()
    assert slowed["flyable"]
    assert slowed["remedy"]["of"] == plan
    assert slowed["remedy"]["change"]["value"] > 1.0
    assert slowed["duration_s"] == pytest.approx(1.49 * slowed["remedy"]["change"]["value"], rel=1e-2)
    page.get_by_role("button", name="Operate", exact=True).click()
    expect(page.get_by_test_id("plan")).to_contain_text("times as slow", timeout=SOON_MS)
