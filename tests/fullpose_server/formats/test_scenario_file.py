"""Scenario files and the ones in examples/."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from fullpose.scenarios import SCENARIOS
from fullpose_server.errors import FileError
from fullpose_server.formats.scenario_file import parse_scenario, read_scenario, write_scenario
from tests.support import repository


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_example_files_are_the_suite(name: str) -> None:
    file = repository.SCENARIOS / f"{name}.toml"
    assert read_scenario(file) == SCENARIOS[name]
    assert file.read_text(encoding="utf-8") == write_scenario(SCENARIOS[name]), "run examples/scenarios/write.py"


def test_no_example_file_is_left_over() -> None:
    assert {file.stem for file in repository.SCENARIOS.glob("*.toml")} == set(SCENARIOS)


def table(**changes: Any) -> dict[str, Any]:
    return {
        "name": "a",
        "about": "b",
        "yaw": {"terms": [{"kind": "sine", "amplitude_deg": 1, "period_s": 2}]},
        **changes,
    }


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"name": 3}, "name"),
        ({"speed": 1}, "speed"),
        ({"rate_hz": 0}, "rate_hz"),
        ({"duration_s": -1}, "duration_s"),
        ({"duration_s": float("nan")}, "duration_s"),
        ({"jitter": 0.5}, "jitter"),
        ({"start_deg": [0, 0, 0]}, "start_deg"),
        ({"start_deg": [0, 0, 0, "x"]}, "start_deg"),
        ({"duration_s": 1e9, "rate_hz": 1e6}, "duration_s"),
        ({"duration_s": 10**400}, "duration_s"),
        ({"rig": 7}, "rig"),
        ({"rig": "nosuch"}, "rig"),
        ({"rig": ["vertical-4"]}, "rig"),
        ({"yaw": {"terms": [3]}}, "yaw.terms[0]"),
        ({"yaw": {"terms": 5}}, "yaw.terms"),
        ({"yaw": {"terms": [{"kind": ["sine"]}]}}, "yaw.terms[0].kind"),
        ({"pitch": 3}, "pitch"),
        ({"pitch": {"constant_deg": True}}, "pitch.constant_deg"),
        ({"roll": {"terms": [{"kind": "cosine"}]}}, "roll.terms[0].kind"),
        ({"roll": {"terms": [{"kind": "sine", "amplitude_deg": 1}]}}, "roll.terms[0].period_s"),
        ({"roll": {"terms": [{"kind": "sine", "amplitude_deg": 1, "period_s": 0}]}}, "roll.terms[0].period_s"),
        ({"roll": {"terms": [{"kind": "ramp", "change_deg": 1, "begin_s": 1, "end_s": 1}]}}, "roll.terms[0].end_s"),
        ({"roll": {"terms": [{"kind": "ramp", "amplitude_deg": 1}]}}, "roll.terms[0].amplitude_deg"),
    ],
)
def test_a_mistake_is_named(changes: dict[str, Any], key: str) -> None:
    parse_scenario(table(), "file.toml")
    with pytest.raises(FileError) as caught:
        parse_scenario(table(**changes), "file.toml")
    assert caught.value.column == key
    assert "file.toml" in str(caught.value)


def test_a_file_that_is_not_toml(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_bytes(b"\xff\xfe= 1")
    with pytest.raises(FileError, match="TOML"):
        read_scenario(file)
    file.write_text("name = ", encoding="utf-8")
    with pytest.raises(FileError, match="TOML"):
        read_scenario(file)


def test_written_files_are_toml() -> None:
    assert tomllib.loads(write_scenario(SCENARIOS["double_loop"]))["roll"]["terms"][2]["change_deg"] == 180
