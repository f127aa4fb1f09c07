"""Runs that are searched for, whose plans somebody else finds."""

import json
from collections.abc import Collection
from dataclasses import asdict
from pathlib import Path

import pytest

from fullpose_server.formats.labels import Labels
from fullpose_server.runtime.recording.record_names import RECORD
from fullpose_server.runtime.recording.run_labels import RunLabels
from fullpose_server.runtime.recording.run_search import FIRST, RunSearch
from fullpose_server.runtime.recording.run_summary import RunSummary

RUNS = FIRST + 40
BYTES = b"12345678"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Summaries of many runs, of which every third was of a plan of its own."""
    made = tmp_path_factory.mktemp("runs")
    for number in range(RUNS):
        fields = dict.fromkeys(RunSummary.__dataclass_fields__)
        known = {"id": f"r{number:04}", "rig": "bench", "who": "ann", "complete": True, "bytes": len(BYTES)}
        plan = f"p{number}" if number % 3 == 0 else None
        summary = RunSummary(**{**fields, **known, "plan_id": plan})  # type: ignore[arg-type]
        record = made / f"{summary.id}{RECORD}"
        record.write_bytes(BYTES)
        record.with_suffix(".json").write_text(json.dumps(asdict(summary)), encoding="utf-8")
    return made


class Plans:
    """Those that have a part, and what was asked of them."""

    def __init__(self, *having: str) -> None:
        self.having = frozenset(having)
        self.asked: list[int | None] = []

    def __call__(self, among: Collection[str] | None) -> frozenset[str]:
        self.asked.append(None if among is None else len(among))
        return self.having if among is None else self.having & set(among)


def names(numbers: range | list[int]) -> list[str]:
    return [f"r{number:04}" for number in numbers]


def test_every_run_is_found_by_its_plan_wherever_it_stands(folder: Path) -> None:
    search, wanted = RunSearch(folder, RunLabels(folder)), [0, 3, FIRST - FIRST % 3, RUNS - 1 - (RUNS - 1) % 3]
    plans = Plans(*(f"p{number}" for number in wanted))
    found = list(search.among(names(range(RUNS)), (("loop", plans),)))
    assert found == names(wanted)
    assert plans.asked == [len(range(0, FIRST, 3)), None]


def test_a_page_out_of_the_first_asks_for_no_other_plans(folder: Path) -> None:
    plans = Plans(*(f"p{number}" for number in range(RUNS)))
    found = RunSearch(folder, RunLabels(folder)).among(names(range(RUNS)), (("loop", plans),))
    assert [next(found) for _ in range(100)] == names(range(0, 300, 3))
    assert len(plans.asked) == 1


def test_words_and_labels_find_runs_without_their_plans(folder: Path) -> None:
    labels = RunLabels(folder)
    labels.put("r0001", Labels(("north",), ""))
    search = RunSearch(folder, labels)
    assert list(search.among(names(range(9)), (("north", Plans()),))) == ["r0001"]
    assert list(search.among(names(range(9)), (("ann", Plans()), ("r000", Plans("p3"))))) == names(range(9))
    assert list(search.among([], (("ann", Plans()),))) == []
