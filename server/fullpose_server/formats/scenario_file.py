"""Scenario files: a flight as sines and ramps of its Euler angles, in TOML; degrees, where `solver` has radians."""

import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fullpose.rig import builtin_rigs
from fullpose.scenarios import Angle, Ramp, Scenario, Sine, Term
from fullpose_server.errors import FileError
from fullpose_server.formats.degrees import written_degrees
from fullpose_server.formats.rig_keys import is_number

MOST_SAMPLES = 4_000_000  # more than an hour at 1 kHz
ANGLES = ("yaw", "pitch", "roll")
_TOP = {"name", "about", "rig", "duration_s", "rate_hz", "jitter", "start_deg", "tilt_deg", *ANGLES}
_TERMS: dict[str, tuple[str, ...]] = {
    "sine": ("amplitude_deg", "period_s", "phase_deg"),
    "ramp": ("change_deg", "begin_s", "end_s"),
}


def read_scenario(path: Path) -> Scenario:
    """The scenario in a TOML file. Raises `FileError` naming key, value and what was expected."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(str(path), f"TOML text in UTF-8 ({error})") from None
    return parse_scenario(table, str(path))


def parse_scenario(table: dict[str, Any], file: str) -> Scenario:
    """The scenario of a parsed file; `file` is for messages."""

    def bad(key: str, value: object, expected: str) -> FileError:
        return FileError(file, expected, column=key, value=repr(value), column_word="key")

    def number(values: dict[str, Any], key: str, where: str, default: float | None) -> float:
        value = values.get(key, default)
        if not is_number(value):
            raise bad(where + key, value, "a finite number")
        return float(value)  # type: ignore[arg-type]

    _only(table, _TOP, "", bad)
    for key in ("name", "about"):
        if not isinstance(table.get(key), str):
            raise bad(key, table.get(key), "a text")
    rig = table.get("rig", "vertical-4")
    if not isinstance(rig, str) or rig not in builtin_rigs():
        raise bad("rig", rig, f"one of {', '.join(builtin_rigs())}")
    start = table.get("start_deg")
    if start is not None and not (isinstance(start, list) and len(start) == 4):
        raise bad("start_deg", start, "four angles, base first")
    positive = {"rate_hz": 1000.0, "duration_s": 10.0}
    for key, default in positive.items():
        value = number(table, key, "", default)
        if value < 0.0 or (key == "rate_hz" and value == 0.0):
            raise bad(key, value, "a number above zero")
    duration, rate = number(table, "duration_s", "", 10.0), number(table, "rate_hz", "", 1000.0)
    if duration * rate >= MOST_SAMPLES:
        most = f"at most {MOST_SAMPLES / rate:.6g} s at {rate:.6g} Hz, that is {MOST_SAMPLES} samples"
        raise bad("duration_s", duration, most)
    jitter = number(table, "jitter", "", 0.0)
    if not 0.0 <= jitter < 0.5:
        raise bad("jitter", jitter, "a number from 0 to below 0.5")
    return Scenario(
        name=table["name"],
        about=table["about"],
        **{name: _angle(table.get(name, {}), name, number, bad) for name in ANGLES},
        rig=rig,
        duration=duration,
        rate=rate,
        jitter=jitter,
        start=None if start is None else _start(start, number),
        tilt=math.radians(number(table, "tilt_deg", "", 0.0)),
    )


def write_scenario(scenario: Scenario) -> str:
    """The file of a scenario; `parse_scenario` gives it back to the last digit that matters (1e-12 deg)."""
    lines = [f'name = "{scenario.name}"', f'about = "{scenario.about}"', f'rig = "{scenario.rig}"']
    lines += [f"duration_s = {scenario.duration:g}", f"rate_hz = {scenario.rate:g}"]
    if scenario.jitter:
        lines.append(f"jitter = {scenario.jitter:g}")
    if scenario.start is not None:
        lines.append(f"start_deg = [{', '.join(_degrees(v) for v in scenario.start)}]")
    if scenario.tilt:
        lines.append(f"tilt_deg = {_degrees(scenario.tilt)}")
    for name in ANGLES:
        angle: Angle = getattr(scenario, name)
        if angle == Angle():
            continue
        lines += ["", f"[{name}]"]
        if angle.constant:
            lines.append(f"constant_deg = {_degrees(angle.constant)}")
        for term in angle.terms:
            lines += [f"[[{name}.terms]]", *_term_lines(term)]
    return "\n".join(lines) + "\n"


def _term_lines(term: Term) -> list[str]:
    if isinstance(term, Ramp):
        change = _degrees(term.change)
        return ['kind = "ramp"', f"change_deg = {change}", f"begin_s = {term.begin:g}", f"end_s = {term.end:g}"]
    lines = ['kind = "sine"', f"amplitude_deg = {_degrees(term.amplitude)}", f"period_s = {term.period:g}"]
    return [*lines, f"phase_deg = {_degrees(term.phase)}"] if term.phase else lines


def _degrees(radians: float) -> str:
    return f"{written_degrees(radians):g}"


def _start(start: list[Any], number: Callable[..., float]) -> tuple[float, float, float, float]:
    a, b, c, d = (math.radians(number({"start_deg": value}, "start_deg", "", None)) for value in start)
    return a, b, c, d


def _angle(table: Any, name: str, number: Callable[..., float], bad: Callable[..., FileError]) -> Angle:
    if not isinstance(table, dict):
        raise bad(name, table, "a table")
    _only(table, {"constant_deg", "terms"}, f"{name}.", bad)
    given = table.get("terms", [])
    if not isinstance(given, list):
        raise bad(f"{name}.terms", given, f"a list of tables, each [[{name}.terms]]")
    terms: list[Term] = []
    for k, term in enumerate(given):
        where = f"{name}.terms[{k}]."
        if not isinstance(term, dict):
            raise bad(where.rstrip("."), term, "a table with kind sine or ramp")
        kind = term.get("kind")
        if not isinstance(kind, str) or kind not in _TERMS:
            raise bad(f"{where}kind", kind, "sine or ramp")
        _only(term, {"kind", *_TERMS[kind]}, where, bad)
        if kind == "sine":
            period = number(term, "period_s", where, None)
            if period <= 0.0:
                raise bad(f"{where}period_s", period, "a number above zero")
            amplitude, phase = number(term, "amplitude_deg", where, None), number(term, "phase_deg", where, 0.0)
            terms.append(Sine(math.radians(amplitude), period, math.radians(phase)))
        else:
            begin, end = number(term, "begin_s", where, None), number(term, "end_s", where, None)
            if not begin < end:
                raise bad(f"{where}end_s", end, f"a time after begin_s, {begin:g}")
            terms.append(Ramp(math.radians(number(term, "change_deg", where, None)), begin, end))
    return Angle(math.radians(number(table, "constant_deg", f"{name}.", 0.0)), tuple(terms))


def _only(table: dict[str, Any], known: set[str], where: str, bad: Callable[..., FileError]) -> None:
    for key in table:
        if key not in known:
            raise bad(where + key, table[key], "one of " + ", ".join(sorted(known)))
