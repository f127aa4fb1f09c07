"""The page of a bundle: what the run was and came to, drawn, and with the hashes by which it is found again (PDF)."""

import json
import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

import typst

from fullpose.rig import FRAMES, Frame, FrameLimits
from fullpose_server.evidence.outcome import FramePeaks, Outcome
from fullpose_server.evidence.plots import Mark, run_plots
from fullpose_server.evidence.sources import Sources
from fullpose_server.version import VERSION

MOST_ALARMS = 6  # on the page; all are in alarms.json
_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
_LONGEST = 78  # characters of one thing that somebody else called so
_PEAKS = (
    "frame",
    "min deg (limit)",
    "max deg (limit)",
    "rate deg/s (limit)",
    "acceleration deg/s² (limit)",
    "measured min",
    "measured max",
)
_FOOT = (
    "The record, plan, flight, rig, alarms and audit are beside this page in the bundle. `fullpose evidence verify "
    "FILE` compares each with the signed manifest. Evidence of what was recorded, not a proof of safety."
)


@dataclass(frozen=True)
class Hashes:
    """What the page names, by which the rest is found again."""

    record: str
    signer: str


def report(found: Sources, outcome: Outcome, hashes: Hashes) -> bytes:
    """The page. The same for the same run: no date is in it but the run's own."""
    alarm_times = _alarm_times(found)
    plots = run_plots(found.rows, found.rig, alarm_times)
    return _typeset(_facts(found, outcome, hashes, alarm_times), plots)


def _typeset(facts: Mapping[str, Any], plots: str) -> bytes:
    template = files(__package__).joinpath("report.typ").read_bytes()
    with tempfile.TemporaryDirectory(prefix="fullpose-report-") as made:
        folder = Path(made)
        (folder / "report.typ").write_bytes(template)
        (folder / "facts.json").write_text(json.dumps(facts), "utf-8")
        (folder / "plots.svg").write_text(plots, "utf-8")
        page: bytes = typst.compile(
            folder / "report.typ",
            root=folder,
            ignore_system_fonts=True,  # the same page on every machine
            timestamp=datetime.fromtimestamp(0, UTC),
        )
    return page


def _facts(found: Sources, outcome: Outcome, hashes: Hashes, alarm_times: Sequence[Mark]) -> dict[str, Any]:
    run = found.run
    tones = {True: "kept", False: "exceeded", None: "unknown"}
    good = run.end == "completed" and not run.lost_samples and run.complete
    tone = tones[outcome.limits_kept] if good or outcome.limits_kept is False else "unknown"
    return {
        "title": f"Evidence of run {run.id}",
        "made_by": f"Fullpose {VERSION}",
        "run": run.id,
        "sentence": outcome.sentence,
        "tone": tone,
        "facts": _told(found),
        "peaks_head": list(_PEAKS),
        "peaks": [[name, *_peak(peaks, _limits(found, name))] for name, peaks in outcome.peaks.items()],
        "plots": "Angles, rates, accelerations and errors over the record's time",
        "alarms_head": _alarms_head(found),
        "alarms": [_alarm(mark, alarm) for mark, alarm in zip(alarm_times, found.alarms[:MOST_ALARMS], strict=True)],
        "hashes": _hashes(found, hashes),
        "foot": _FOOT,
    }


def _told(found: Sources) -> list[list[str]]:
    run, plan = found.run, found.plan
    flight = found.flight or {}
    rig = f"{run.rig}, {found.rig.geometry}" if found.rig is not None else run.rig
    duration = "not known" if run.started is None or run.ended is None else f"{run.ended - run.started:.3f} s"
    samples = "none" if run.samples is None else f"{run.samples}, {run.lost_samples or 0} missing"
    cut = "" if run.complete else "; the record was cut off or is damaged"
    return [
        ["rig", _clip(rig)],
        ["begun by", _clip(run.who or "not known")],
        ["from", _time(run.started)],
        ["until", _time(run.ended)],
        ["recorded", duration],
        ["samples", samples + cut],
        ["flight", _clip(str(flight.get("name") or found.missing.get("flight", "not known")))],
        ["plan", _clip(plan.plan_id if plan is not None else found.missing.get("plan", "not known"))],
        ["method", _clip(plan.method if plan is not None else "not known")],
        ["flight's length", f"{plan.duration_s:.3f} s at {plan.rate_hz:g} Hz" if plan is not None else "not known"],
        ["lateness of a tick", "not known" if run.max_lateness_us is None else f"at most {run.max_lateness_us:.0f} us"],
        ["audit", f"{len(found.audit)} lines of this run"],
    ]


def _hashes(found: Sources, hashes: Hashes) -> list[list[str]]:
    plan = found.plan
    return [
        ["record, sha-256", hashes.record],
        ["plan", found.run.plan_hash or "none"],
        ["flight, sha-256", plan.trajectory_sha256 if plan is not None else "not known"],
        ["rig", str(found.bound.get("rig_hash") or "not known")],
        ["newest line of the audit", found.newest_hash],
        ["signed with the key", hashes.signer],
    ]


def _alarm_times(found: Sources) -> list[Mark]:
    started = found.run.started or 0.0
    return [
        Mark(float(alarm["time_s"]) - started, letter)
        for alarm, letter in zip(found.alarms[:MOST_ALARMS], _LETTERS, strict=False)
    ]


def _alarms_head(found: Sources) -> str:
    if "alarms" in found.missing:
        return f"Alarms: {found.missing['alarms']}."
    count = len(found.alarms)
    if not count:
        return "No alarm."
    more = f", the first {MOST_ALARMS} here" if count > MOST_ALARMS else ""
    return f"{count} alarm{'' if count == 1 else 's'}{more}; times from the record's beginning:"


def _alarm(mark: Mark, alarm: Mapping[str, Any]) -> list[str]:
    many = "" if alarm["count"] == 1 else f" ({alarm['count']} times)"
    return [
        mark.letter,
        f"{mark.time_s:.3f} s",
        f"{alarm['severity']} {alarm['code']}{many}",
        _clip(alarm["message"], 110),
    ]


def _peak(peaks: FramePeaks, limits: FrameLimits | None) -> list[str]:
    values = (
        (peaks.min_deg, None if limits is None else limits.min),
        (peaks.max_deg, None if limits is None else limits.max),
        (peaks.rate_deg_s, None if limits is None else limits.max_rate),
        (peaks.acceleration_deg_s2, None if limits is None else limits.max_acceleration),
        (peaks.measured_min_deg, None),
        (peaks.measured_max_deg, None),
    )
    return [_beside(value, limit) for value, limit in values]


def _beside(value: float | None, limit: float | None) -> str:
    """A value, and its limit [rad] where there is one."""
    told = "" if value is None else f"{value:.3f}"
    return told if limit is None or not math.isfinite(limit) else f"{told} ({math.degrees(limit):g})"


def _limits(found: Sources, frame: str) -> FrameLimits | None:
    return None if found.rig is None else found.rig.frames[FRAMES.index(Frame(frame))]


def _clip(text: str, most: int = _LONGEST) -> str:
    """On one page there is so much room."""
    plain = " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())
    return plain if len(plain) <= most else plain[: most - 1] + "…"


def _time(seconds: float | None) -> str:
    if seconds is None:
        return "not known"
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M:%S.%f")[:-3] + " UTC"
