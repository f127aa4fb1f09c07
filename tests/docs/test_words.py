"""docs/words.md against the code: its terms live where it says, and the words they replaced are no names any more."""

import ast
import functools
import importlib.util
import re
from collections import defaultdict
from collections.abc import Iterator

import pytest

from tests.support.repository import ROOT
from tools.house import packages, sources

PAGE = (ROOT / "docs" / "words.md").read_text()
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in PAGE.splitlines()
    if line.startswith("| ") and not line.startswith("| term |")
]
REPLACED = sorted({word.lower() for row in ROWS for word in row[3].split(", ") if word})
# Where the word is the field's own, with another meaning.
FIELD = {
    "horizon": "the prediction horizon of `preview`",
    "horizon_s": "the prediction horizon of `preview`",
    "way_age_ms": "of the surface, which keeps its names",
    "hash_chain": "rows that each have the hash of the one before",
    "excess_cost": "of the surface, which keeps its names",
    "turns": "how many full turns a frame has made",
    "_turns": "which frames turn without end",
    "turns_into_range": "how many full turns bring an angle into its range",
    "TURNS_APART": "poses that are full turns apart",
    "main_panel": "viser's name for its menu",
}


def names() -> Iterator[tuple[str, str]]:
    """(file, name) of everything that the packages name: functions, classes, parameters, variables, attributes."""
    for path, text in sources(packages(ROOT)):
        short = path.relative_to(ROOT).as_posix()
        yield short, path.stem
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                yield short, node.name
            elif isinstance(node, ast.arg):
                yield short, node.arg
            elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                yield short, node.id
            elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
                yield short, node.attr


def parts(name: str) -> list[str]:
    """The words of a name: way_age_s, smoothWay, WAY_LATE_S."""
    return [part.lower() for part in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]


@functools.cache
def uses() -> dict[str, set[str]]:
    """Names in which a replaced word stands, by the word."""
    found: dict[str, set[str]] = defaultdict(set)
    for file, name in names():
        if name in FIELD:
            continue
        for word in set(parts(name)) & set(REPLACED):
            found[word].add(f"{file}: {name}")
    return found


def test_every_word_has_its_term() -> None:
    told = {word: row[0] for row in ROWS for word in row[3].lower().split(", ") if word}
    assert told == {
        "volume": "manipulability",
        "wish": "null-space increment",
        "way": "reference trajectory",
        "chain": "node path",
        "horizon": "beam search",
        "inertial": "beam search",
        "marks": "active limits",
        "over": "violation",
        "excess": "violation",
        "worst": "violation",
        "short": "violation",
        "stepped": "fallback",
        "whole": "plan",
        "desk": "command handler",
        "judge": "monitors",
        "panel": "publisher",
        "place": "rig paths",
        "lane": "priority channel",
        "stand": "hold position",
        "note": "log event",
        "obedience": "drive-response monitor",
        "turns": "round robin",
        "warm": "prewarm",
    }


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_terms_live_where_the_page_says(row: list[str]) -> None:
    assert len(row) == 4
    modules = re.findall(r"`(fullpose[\w.]*)`", row[2])
    assert modules
    for module in modules:
        assert importlib.util.find_spec(module) is not None, module


@pytest.mark.parametrize("word", REPLACED)
def test_a_word_that_was_replaced_is_no_name(word: str) -> None:
    assert sorted(uses()[word]) == []
