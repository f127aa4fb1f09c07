"""docs/mathematics.md is the living copy: what comments, docstrings and pages call 'section n' is a section of it."""

import re
from collections.abc import Iterator

import pytest

from tests.support.repository import ROOT
from tests.support.text import joined, written

PAGE = ROOT / "docs" / "mathematics.md"
SECTIONS = {int(number): title for number, title in re.findall(r"^## (\d+)\. (.+)$", PAGE.read_text(), re.MULTILINE)}
LIST = r"\d+(?:(?:, | and |, and | to )\d+)*(?!\.\d)\b"
REFERENCE = re.compile(rf"(?P<before>.{{0,16}})\bsections? (?P<numbers>{LIST})(?:, steps? (?P<steps>{LIST}))?", re.I)
PAPER = re.compile(r"\(?\d{4}[a-z]?\)?, $")  # Iserles et al. 2000, section 5.2


def body(number: int) -> str:
    """The text of one section."""
    return PAGE.read_text().split(f"\n## {number}. ", 1)[1].split("\n## ", 1)[0]


def numbers(text: str) -> list[int]:
    """[3, 4, 5] of "3 to 5", [3, 8] of "3 and 8"."""
    found = [int(number) for number in re.findall(r"\d+", text)]
    return list(range(found[0], found[-1] + 1)) if " to " in text else found


def references() -> Iterator[tuple[str, re.Match[str]]]:
    """(file, match) of everything that is called a section, but for those of papers and the page's own headings."""
    for path, text in written():
        for match in REFERENCE.finditer(joined(text)):
            if not PAPER.search(match["before"]):
                yield str(path), match


def test_sections_are_numbered_in_order() -> None:
    assert list(SECTIONS) == list(range(1, len(SECTIONS) + 1))
    assert len(SECTIONS) >= 14


def test_the_page_says_that_it_is_the_living_copy() -> None:
    assert "living copy" in PAGE.read_text().split("\n## ", 1)[0]


def test_every_section_named_is_there() -> None:
    found = list(references())
    assert len({file for file, _ in found}) > 25, "the pattern finds the references"
    wrong = [
        f"{file}: {match[0].strip()!r}"
        for file, match in found
        if not set(numbers(match["numbers"])) <= SECTIONS.keys()
    ]
    assert wrong == []


def test_every_step_named_is_there() -> None:
    found = [(file, match) for file, match in references() if match["steps"]]
    assert found, "the pattern finds the references"
    for file, match in found:
        text = body(numbers(match["numbers"])[-1])
        for step in numbers(match["steps"]):
            assert re.search(rf"^{step}\. ", text, re.MULTILINE), f"{file}: {match[0]!r}"


def test_sections_are_said_to_be_of_the_mathematics() -> None:
    wrong = [
        f"{file}: {match[0].strip()!r}"
        for file, match in references()
        if file != "docs/mathematics.md" and not re.search(r"mathematics(?:\.md)?[,)`]* $", match["before"], re.I)
    ]
    assert wrong == []


def test_nothing_points_at_the_file_that_it_came_from() -> None:
    old = "METHODS" + ".md"
    pattern = re.compile(rf"{re.escape(old)}|METHODS(?:['’]|,? sections?| \d|, \d)")
    assert [str(path) for path, text in written() if pattern.search(text)] == []


@pytest.mark.parametrize(
    ("text", "expected"), [("3", [3]), ("3 and 8", [3, 8]), ("3, 4 and 8", [3, 4, 8]), ("3 to 5", [3, 4, 5])]
)
def test_lists_of_numbers_are_read(text: str, expected: list[int]) -> None:
    match = REFERENCE.search(f"mathematics, sections {text}.")
    assert match is not None
    assert numbers(match["numbers"]) == expected


def test_a_reference_over_two_lines_is_found() -> None:
    match = REFERENCE.search(joined("    # as in mathematics, section\n    # 99 says"))
    assert match is not None
    assert numbers(match["numbers"]) == [99]
