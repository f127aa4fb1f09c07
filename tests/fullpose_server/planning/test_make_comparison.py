"""A comparison's report and page."""

import html
import json
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fullpose.attitude import (
    dcm_from_quaternion,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    quaternion_product,
)
from fullpose.errors import InputError, MethodError
from fullpose.plan import plan
from fullpose.registry import variant
from fullpose.rig import FRAMES, builtin_rigs
from fullpose.scenarios import SCENARIOS, Scenario
from fullpose.solve import solve
from fullpose.verify import verify
from fullpose_server.formats.reason_text import reason_report
from fullpose_server.formats.report import exact_percent, exact_text
from fullpose_server.pages.compare_page import beyond_limits
from fullpose_server.planning import compare_length
from fullpose_server.planning.flown_within import Within, flown_within
from fullpose_server.planning.make_comparison import Comparison, make_comparison

RIGS = builtin_rigs()
METHODS = ["exact", "lagrange", "three_axis"]


def given(scenario: Scenario) -> Within:
    return flown_within(scenario.time, scenario.quaternion, None)


@pytest.fixture(scope="module")
def made() -> Comparison:
    scenario = replace(SCENARIOS["over_limit"], duration=1.5)
    return make_comparison("<flight>", given(scenario), RIGS["vertical-limited"], METHODS)


def page_data(page: str) -> dict[str, Any]:
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return dict(json.loads(found.group(1)))


def test_the_report_has_every_figure(made: Comparison) -> None:
    report = json.loads(json.dumps(made.report, allow_nan=False))
    assert report["schema"] == "fullpose.comparison/1"
    assert report["samples"] == 1501
    assert [method["method"] for method in report["methods"]] == METHODS
    exact, lagrange, three_axis = report["methods"]
    for method in report["methods"]:
        for key in ("max_error_deg", "rms_error_deg", "max_matrix_error", "iterations", "step_us", "exact_share"):
            assert method[key] is not None
        assert set(method["peak"]) == set(method["total_variation_deg"]) == set(FRAMES)
    assert exact["limit_violation_samples"] == 0
    assert exact["failures"][0]["reason"] == "position limit of the inner frame"
    assert lagrange["exact_share"] < 0.01
    assert three_axis["limit_violation_counts"]["inner"]["position"] > 0
    assert three_axis["limit_violation_samples"] == sum(
        n for kinds in three_axis["limit_violation_counts"].values() for n in kinds.values()
    )


def test_the_page_stands_alone(made: Comparison) -> None:
    assert not re.search(r'(src|href)\s*=\s*["\']', made.page)
    assert "http" not in made.page.replace("http://www.w3.org/2000/svg", "")
    assert "__" not in re.sub(r"<script.*?</script>", "", made.page, flags=re.DOTALL)
    assert "&lt;flight&gt; on vertical-limited" in made.page


def test_the_pages_curves_keep_the_peaks(made: Comparison) -> None:
    data = page_data(made.page)
    assert data["frames"] == list(FRAMES)
    assert data["limits"][3]["max"] == pytest.approx(60.0)
    assert data["limits"][0]["max"] is None
    for curves, method in zip(data["methods"], made.report["methods"], strict=True):
        assert len(curves["t"]) <= 1300
        for k, frame in enumerate(FRAMES):
            peak = method["peak"][frame]
            assert max(map(abs, curves["angle"][k])) == pytest.approx(peak["position_deg"], rel=1e-5)
            assert max(map(abs, curves["rate"][k])) == pytest.approx(peak["rate_deg_s"], rel=1e-5)
            assert max(map(abs, curves["acceleration"][k])) == pytest.approx(peak["acceleration_deg_s2"], rel=1e-5)
    assert data["methods"][0]["limited"]
    assert not data["methods"][0]["beyond"]
    assert data["methods"][2]["beyond"]


def test_beyond_limits_are_the_verified_violations() -> None:
    scenario = replace(SCENARIOS["both_beyond_90"], duration=4.0)
    C = dcm_from_quaternion(scenario.quaternion)
    solution = solve(scenario.time, C, RIGS["vertical-4"], "three_axis")
    where = beyond_limits(solution)
    violations = verify(scenario.time, solution.angles, solution.rig).violations
    assert violations
    assert where.sum() <= sum(v.samples for v in violations)
    for violation in violations:
        assert where[np.argmin(np.abs(scenario.time - violation.time))]


def test_brought_to_a_rate() -> None:
    scenario = replace(SCENARIOS["small_angles"], duration=1.0, rate=50.0)
    made = make_comparison("sparse", given(scenario), RIGS["vertical-4"], ["exact"], rate_hz=500.0)
    assert made.report["samples"] == 501
    assert "quaternion spline" in made.report["resampling"]
    assert "quaternion spline" in made.page


def test_a_method_that_does_not_apply_has_a_row() -> None:
    scenario = SCENARIOS["two_samples"]
    made = make_comparison("two", given(scenario), RIGS["vertical-3"], ["dwln", "three_axis"])
    assert "fourth axis" in made.report["methods"][0]["refusal"]
    assert "fourth axis" in made.page
    assert made.report["samples"] == 2
    assert [method["name"] for method in page_data(made.page)["methods"]] == ["three_axis"]


def test_where_no_method_applies_nothing_is_compared() -> None:
    scenario = SCENARIOS["two_samples"]
    with pytest.raises(MethodError, match=r"alm needs the fourth axis.*exact needs the fourth axis"):
        make_comparison("two", given(scenario), RIGS["vertical-3"], ["alm", "exact"])


def test_variants_have_rows_curves_and_colours_of_their_own() -> None:
    scenario = replace(SCENARIOS["small_angles"], duration=0.2)
    asked = ["alm:mode=open_loop", variant("alm", {"mode": "closed_loop"}, "<closed>"), "alm"]
    made = make_comparison("small", given(scenario), RIGS["vertical-4"], asked)
    labels = ["alm:mode=open_loop", "<closed>", "alm"]
    assert [row["label"] for row in made.report["methods"]] == labels
    assert [row["method"] for row in made.report["methods"]] == ["alm"] * 3
    assert [row["options"] for row in made.report["methods"]] == [{"mode": "open_loop"}, {"mode": "closed_loop"}, {}]
    curves = page_data(made.page)["methods"]
    assert [curve["name"] for curve in curves] == labels
    assert len({curve["colour"] for curve in curves}) == 3
    assert "&lt;closed&gt;</th>" in made.page or "&lt;closed&gt; <small" in made.page


def test_too_many_samples_are_refused_before_they_are_made(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = SCENARIOS["two_samples"]
    far = np.array([0.0, 200_000.0])
    flight = ("sparse", flown_within(far, scenario.quaternion, None), RIGS["vertical-4"])
    with pytest.raises(InputError, match=r"200000.*at most 12000 s at 1000 Hz.*12000000 samples$"):
        make_comparison(*flight, ["exact"], rate_hz=1000.0)
    with pytest.raises(InputError, match="at most 6 s at 1e"):
        make_comparison(*flight, ["exact", "alm"], rate_hz=1e6)
    with pytest.raises(InputError, match="rate_hz"):
        make_comparison(*flight, ["exact"], rate_hz=float("nan"))
    monkeypatch.setattr(compare_length, "MOST_SAMPLES", 3)
    with pytest.raises(InputError, match="at most 1 samples with 2 methods side by side"):
        make_comparison("two", given(scenario), RIGS["vertical-4"], ["exact", "alm"])


@pytest.mark.parametrize(
    ("exact", "samples", "text"),
    [
        (0, 7, "0 %"),
        (1, 20_000, "< 0.01 %"),
        (13, 4000, "0.32 %"),  # 0.325 %: a tie, which two languages round to either side
        (1, 800, "0.12 %"),
        (19_999, 20_000, "99.99 %"),
        (7, 7, "100 %"),
    ],
)
def test_a_share_is_rounded_once_and_down(exact: int, samples: int, text: str) -> None:
    percent = exact_percent(exact, samples)
    assert exact_text({"exact_samples": exact, "exact_percent": percent}) == text


def test_report_table_and_share_agree(made: Comparison) -> None:
    for method in made.report["methods"]:
        assert method["exact_samples"] == round(method["exact_share"] * method["samples"])
        assert exact_text(method).replace("<", "&lt;") in made.page


def test_unknown_methods_are_refused() -> None:
    scenario = SCENARIOS["two_samples"]
    with pytest.raises(MethodError, match="magic"):
        make_comparison("two", given(scenario), RIGS["vertical-4"], ["magic"])


def test_what_keeps_a_method_from_it_is_told_in_a_sentence() -> None:
    time = np.arange(0.0, 2.0, 0.02)
    rolled = quaternion_from_euler(0.2 * np.sin(time), 0.0 * time, np.radians(400.0) * time)
    made = make_comparison("roll", flown_within(time, rolled, None), RIGS["vertical-limited"], ["plan", "lagrange"])
    planned, stepped = made.report["methods"]
    alone = plan(time, dcm_from_quaternion(rolled), RIGS["vertical-limited"])
    assert not planned["feasible"]
    assert planned["why"] == reason_report(alone.verdict)["what_happens"]
    assert planned["how_sure"] == alone.verdict.how_sure
    assert " frame exceeds its " in stepped["why"]
    assert stepped["how_sure"] is None
    for method in (planned, stepped):
        assert html.escape(method["why"][1:]) in made.page
    assert html.escape(planned["how_sure"]) in made.page


def test_a_noisy_flight_that_no_method_can_fly_is_suggested_a_tolerance_and_flown_within_it() -> None:
    time = np.arange(0.0, 2.0, 0.002)
    clean = quaternion_from_euler(0.5 * np.sin(time), 0.3 * np.cos(time), 0.2 * time)
    noise = np.radians(0.02) * np.random.default_rng(0).normal(size=(len(time), 3))
    noisy = quaternion_product(clean, quaternion_from_rotation_vector(noise))
    refused = make_comparison("noisy", flown_within(time, noisy, None), RIGS["vertical-limited"], ["exact"]).report
    suggested = refused["suggested_tolerance_deg"]
    assert 0.06 < suggested < 0.12
    within = flown_within(time, noisy, suggested)
    flown = make_comparison("noisy", within, RIGS["vertical-limited"], ["exact"]).report
    assert flown["methods"][0]["feasible"]
    assert flown["methods"][0]["why"] is None
    assert flown["deviation_deg"]["max"] <= flown["tolerance_deg"] == suggested
