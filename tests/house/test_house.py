"""The house: how long, how wide, how often (`tools/house.py` measures), and who may import whom among the tests."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.repository import ROOT
from tools.house import shapes

TESTS = sorted((ROOT / "tests").rglob("*.py"))
BENCHES = sorted((ROOT / "bench").rglob("*.py"))


def short(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def imported(path: Path) -> Iterator[str]:
    """The modules that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{short(path)}: a relative import"
            yield node.module or ""


@pytest.mark.parametrize("path", BENCHES, ids=short)
def test_no_bench_imports_a_test(path: Path) -> None:
    assert [name for name in imported(path) if name.split(".")[0] in ("tests", "pytest")] == []


@pytest.mark.parametrize("path", [p for p in TESTS if short(p).startswith("tests/fullpose/")], ids=short)
def test_tests_of_the_library_import_neither_the_server_nor_a_bench(path: Path) -> None:
    assert [name for name in imported(path) if name.split(".")[0] in ("fullpose_server", "bench")] == []


def test_lines_that_differ_in_names_alone_are_alike() -> None:
    first, second = shapes('"""Doc."""\nimport a\nx = f(1, y)\n'), shapes("# c\n\nlonger = g(2.5, other)\n")
    assert [shape for _, shape in first] == [shape for _, shape in second]
