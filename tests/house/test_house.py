"""The house: how long, how wide, how often (`tools/house.py` measures), and who may import whom among the tests."""

import ast
from collections.abc import Iterator
from pathlib import Path

import grimp
import pytest

from tests.support.repository import ROOT
from tools.house import FILE, LINES, PARAMETERS, array_definitions, functions, long_files, packages, shapes

TESTS = sorted((ROOT / "tests").rglob("*.py"))
BENCHES = sorted((ROOT / "bench").rglob("*.py"))
WAITING_ALLOWED = ("tests/faults/", "tests/e2e/", "tests/support/waiting.py")
# What is still beyond the house's bounds (none, 3 kernels, 5, 5; no circle; no sleep). These only ever become smaller.
LONG: set[str] = set()
LONG_KERNELS: set[str] = set()
WIDE = 5
LONG_FILES = 5


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


def sleeps(path: Path) -> Iterator[int]:
    """Lines that wait for time to pass. A sleep of nothing only lets the others run."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Call) or ast.unparse(node.func) not in ("time.sleep", "asyncio.sleep", "sleep"):
            continue
        if ast.unparse(node.args[0]) not in ("0", "0.0"):
            yield node.lineno


def test_functions_are_short() -> None:
    long = [f for f in functions(ROOT, packages(ROOT)) if f.lines > LINES]
    assert {f.name for f in long if not f.kernel} <= LONG
    assert {f.name for f in long if f.kernel} <= LONG_KERNELS


def test_functions_have_few_parameters() -> None:
    wide = {f"{f.file.split('/')[-1]}: {f.name}" for f in functions(ROOT, packages(ROOT)) if f.parameters > PARAMETERS}
    assert len(wide) <= WIDE, sorted(wide)


def test_files_are_short() -> None:
    found = long_files(ROOT)
    assert len(found) <= LONG_FILES, f"over {FILE} lines: {found}"


def test_array_has_one_home() -> None:
    assert [short(Path(path)) for path in array_definitions(packages(ROOT))] == ["solver/fullpose/_typing.py"]


def test_no_circle_of_imports() -> None:
    """Between modules, imports inside functions counted."""
    graph = grimp.build_graph("fullpose", "fullpose_server", cache_dir=None)
    left = {module: set(graph.find_modules_directly_imported_by(module)) for module in graph.modules}
    while True:  # those that need nothing of the rest, or that nothing of the rest needs, are in no circle
        needed = set().union(*left.values())
        kept = {
            module: needs & left.keys() for module, needs in left.items() if needs & left.keys() and module in needed
        }
        if kept.keys() == left.keys():
            break
        left = kept
    assert sorted(left) == []


@pytest.mark.parametrize("path", TESTS, ids=short)
def test_no_test_sleeps(path: Path) -> None:
    """But for the fault and the browser tests, which run real processes; the others wait for what they wait for."""
    if not short(path).startswith(WAITING_ALLOWED):
        assert list(sleeps(path)) == []


@pytest.mark.parametrize("path", BENCHES, ids=short)
def test_no_bench_imports_a_test(path: Path) -> None:
    assert [name for name in imported(path) if name.split(".")[0] in ("tests", "pytest")] == []


@pytest.mark.parametrize("path", [p for p in TESTS if short(p).startswith("tests/fullpose/")], ids=short)
def test_tests_of_the_library_import_neither_the_server_nor_a_bench(path: Path) -> None:
    assert [name for name in imported(path) if name.split(".")[0] in ("fullpose_server", "bench")] == []


def test_lines_that_differ_in_names_alone_are_alike() -> None:
    first, second = shapes('"""Doc."""\nimport a\nx = f(1, y)\n'), shapes("# c\n\nlonger = g(2.5, other)\n")
    assert [shape for _, shape in first] == [shape for _, shape in second]
