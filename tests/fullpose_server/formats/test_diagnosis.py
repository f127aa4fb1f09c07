"""The report of a diagnosis: its sentences carry its figures, and its values are JSON."""

import json

import numpy as np
import pytest

from fullpose import builtin_rigs
from fullpose.recorded import diagnose
from fullpose_server.formats.diagnosis import MOST_LISTED, diagnosis_plots, diagnosis_report
from fullpose_server.formats.diagnosis_sentences import figure
from tests.support.recorded import grid, noisy, quaternion, rounded_angles, truth

TIME = grid(1000.0, 2.0)
CLEAN = quaternion(truth("manoeuvre", TIME))


def sentences(report: dict) -> dict[str, str]:  # type: ignore[type-arg]
    json.dumps(report, allow_nan=False)
    return {each["code"]: f"{each['level']}: {each['sentence']}" for each in report["findings"]}


def test_a_clean_flight_has_remarks_alone() -> None:
    said = sentences(diagnosis_report(TIME, CLEAN))
    assert said.keys() == {"noise", "motion"}
    assert said["noise"] == "remark: No white noise: the attitude is as smooth as its samples can tell."


def test_noise_is_told_with_what_it_costs_body_and_frames() -> None:
    q = quaternion(noisy(truth("manoeuvre", TIME), 0.01))
    report = diagnosis_report(TIME, q, builtin_rigs()["vertical-4"])
    said = sentences(report)["noise"]
    assert said.startswith("warning: White noise of 0.0")
    assert f"costs {figure(max(report['noise_acceleration_deg_s2']))} deg/s^2 of body acceleration" in said
    for frame, cost in report["rig"]["frames"].items():
        assert f"{frame} {figure(cost['noise_acceleration_deg_s2']['median'])} of " in said
        assert 1e3 < cost["noise_acceleration_deg_s2"]["median"] <= cost["noise_acceleration_deg_s2"]["max"] < 1e5


def test_small_noise_on_a_strong_rig_is_a_remark() -> None:
    q = quaternion(noisy(truth("manoeuvre", TIME), 1e-6))
    assert sentences(diagnosis_report(TIME, q))["noise"].startswith("remark")
    assert sentences(diagnosis_report(TIME, q, builtin_rigs()["vertical-3"]))["noise"].startswith("remark")


@pytest.mark.parametrize(
    ("q", "told"),
    [
        (quaternion(rounded_angles(truth("manoeuvre", TIME), 2)), "Angles are rounded to 0.01 deg"),
        (np.round(CLEAN, 4), "Quaternions are rounded to 0.0001, 0.0115 deg of attitude"),
    ],
)
def test_rounding_is_told_once_and_not_as_noise(q: np.ndarray, told: str) -> None:
    said = sentences(diagnosis_report(TIME, q))
    assert said["quantum"].startswith(f"warning: {told}; followed exactly, at steps of 1 ms, that alone costs ")
    assert "noise" not in said


def test_holds_stamps_gaps_and_outliers_are_told() -> None:
    index = np.arange(TIME.size)
    assert (
        "Samples are held, 250 Hz written out at 1000 Hz: 1500 of 2001 samples repeat"
        in (sentences(diagnosis_report(TIME, CLEAN[index - index % 4]))["held"])
    )
    coarse = grid(400.0, 2.0)
    stamps = sentences(diagnosis_report(np.round(coarse, 3), quaternion(truth("manoeuvre", coarse))))["stamps"]
    assert "Stamps are rounded to 1 ms: they are" in stamps
    assert "a regular clock of 400 Hz, under which the attitude is smoother" in stamps
    kept = (index < 500) | (index > 1500)
    assert (
        "1 gap without samples: 0.499 s to 1.501 s (1002 median steps)"
        in (sentences(diagnosis_report(TIME[kept], CLEAN[kept]))["gaps"])
    )
    off = CLEAN.copy()
    off[700] = CLEAN[760]
    assert "warning: 1 outlier: the largest, at 0.7 s, is" in sentences(diagnosis_report(TIME, off))["outliers"]


def test_one_stamp_off_is_named() -> None:
    time = grid(100.0)
    time[50] = time[49] + 1e-6
    said = sentences(diagnosis_report(time, quaternion(truth("manoeuvre", grid(100.0)))))
    assert said["stamps"].startswith("warning: 1 stamp is up to 9.999 ms off a regular clock of 100 Hz")
    assert "at 0.490001 s" in said["stamps"]
    assert said["near-duplicates"].startswith("warning: 1 stamp all but repeats the one before: at 0.490001 s")


def test_lists_are_cut_and_their_numbers_are_not() -> None:
    time = grid(100.0, 100.0)
    kept = np.arange(time.size) % 40 > 2
    report = diagnosis_report(time[kept], quaternion(truth("manoeuvre", time))[kept])
    assert len(report["gaps"]) == MOST_LISTED < report["gap_count"] == 249


@pytest.mark.parametrize("samples", [1, 2, 3, 8, 20])
def test_a_flight_of_few_samples_has_a_report_and_plots(samples: int) -> None:
    report = diagnosis_report(TIME[:samples], CLEAN[:samples], builtin_rigs()["vertical-4"])
    assert report["samples"] == samples
    plots = diagnosis_plots(TIME[:samples], CLEAN[:samples], None)
    json.dumps([report, plots], allow_nan=False)
    assert sum(plots["steps"]["count"]) == samples - 1


def test_plots_are_thin_and_keep_what_is_large() -> None:
    q = quaternion(noisy(truth("manoeuvre", TIME), 0.01))
    q[1200] = q[1300]
    plots = diagnosis_plots(TIME, q, diagnose(TIME, q).stamps.regular_time_s)
    noise = plots["noise"]
    assert len(noise["time_s"]) == len(noise["x_deg"]) <= 1000
    size = np.abs([noise[f"{axis}_deg"] for axis in "xyz"]).max(axis=0)
    assert noise["time_s"][int(np.argmax(size))] == pytest.approx(1.2, abs=0.005)
    assert len(plots["steps"]["edge_s"]) == len(plots["steps"]["count"]) + 1


def test_figures_have_three_digits_and_no_powers() -> None:
    assert [figure(x) for x in (24296.1, 0.010248, 50.0, 1.0, 0.0, 999.6, 2.25e-6)] == [
        "24300", "0.0102", "50.0", "1.00", "0", "1000", "2.25e-06",
    ]  # fmt: skip


def test_even_steps_are_one_bar() -> None:
    """They differ in the last bit: at 1 kHz no two neighbouring stamps are quite as far apart as the next."""
    count = diagnosis_plots(TIME, CLEAN, None)["steps"]["count"]
    assert np.unique(np.diff(TIME)).size > 1
    assert [each for each in count if each] == [TIME.size - 1]
