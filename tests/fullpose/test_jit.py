"""How kernels are compiled, and that the inner ones are what their compilation takes them for."""

import ast
import importlib
import resource
import sys
from pathlib import Path

import numpy as np
import pytest

import fullpose.kinematics
from fullpose._jit import kernel

SOLVER = Path(fullpose.kinematics.__file__).parent
NODES = [
    (path, node)
    for path in sorted(SOLVER.rglob("*.py"))
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
]
RECORDS = ("NamedTuple", "Protocol", "Options", "GradientProjectionOptions")
# What records hold is their holder's: an array of theirs is a view that nobody need count.
FIELDS = {
    field.target.id
    for _, node in NODES
    if isinstance(node, ast.ClassDef) and any(isinstance(base, ast.Name) and base.id in RECORDS for base in node.bases)
    for field in node.body
    if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
}
INNER = [
    pytest.param(node, id=f"{path.stem}.{node.name}")
    for path, node in NODES
    if isinstance(node, ast.FunctionDef)
    and any(isinstance(mark, ast.Name) and mark.id in ("inner", "inlined") for mark in node.decorator_list)
]


def test_division_by_zero_is_numpys() -> None:
    @kernel
    def ratio(a: float, b: float) -> float:
        return a / b

    assert ratio(1.0, 0.0) == np.inf
    assert np.isnan(ratio(0.0, 0.0))


RENAMED = """
from typing import NamedTuple

from fullpose._jit import kernel


class {name}(NamedTuple):
    a: float


@kernel
def doubled(record):
    return 2.0 * record.a


ANSWER = doubled({name}(3.0))
HITS = sum(doubled.stats.cache_hits.values())
"""


@pytest.mark.parametrize("spoil", [None, b"", b"not an index"])
def test_a_cache_that_cannot_be_read_is_made_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, spoil: bytes | None
) -> None:
    """A record that was renamed, as an upgrade does, or an index that a full disk cut short."""
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def hits(name: str) -> int:
        """Of a process that begins: how often it found its kernel on disk."""
        file, source = tmp_path / "renamed.py", RENAMED.format(name=name)
        if not file.exists() or file.read_text(encoding="utf-8") != source:
            file.write_text(source, encoding="utf-8")
        sys.modules.pop("renamed", None)
        importlib.invalidate_caches()
        module = importlib.import_module("renamed")
        assert module.ANSWER == 6.0
        return int(module.HITS)

    try:
        assert hits("Before") == 0
        for index in (tmp_path / "cache").rglob("*.nbi") if spoil is not None else ():
            index.write_bytes(spoil)
        assert hits("Later") == 0
        assert hits("Later") == 1
    finally:
        sys.modules.pop("renamed", None)


def test_a_kernel_that_there_is_no_room_for_compiles_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path))
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)

    @kernel
    def tripled(a: float) -> float:
        return 3.0 * a

    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    try:
        assert tripled(2.0) == 6.0
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert not [file for file in tmp_path.rglob("*.nbi") if file.stat().st_size]


def test_where_nothing_can_be_cached_that_is_said_and_kernels_compile(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("numba.core.caching.CompileResultCacheImpl._locator_classes", [])
    with pytest.warns(RuntimeWarning, match="set NUMBA_CACHE_DIR"):

        @kernel
        def doubled(a: float) -> float:
            return 2.0 * a

    assert doubled(3.0) == 6.0


@pytest.mark.parametrize("function", INNER)
def test_an_inner_kernel_makes_no_array_and_returns_none(function: ast.FunctionDef) -> None:
    """Nobody would count its owners: it would leak, or be freed under its reader."""
    for node in (inside for statement in function.body for inside in ast.walk(statement)):
        assert not isinstance(node, ast.List | ast.ListComp | ast.Set | ast.Dict)
        if isinstance(node, ast.Attribute):
            assert isinstance(node.value, ast.Name | ast.Attribute)  # a record's, or that of a record in a record
            math = isinstance(node.value, ast.Name) and node.value.id == "math"
            assert math or node.attr in ("inf", "rint", "shape") or node.attr in FIELDS
    assert function.returns is not None
    returned = ast.unparse(function.returns)
    for word in ("float", "int", "bool", "None", "tuple"):
        returned = returned.replace(word, "")
    assert not returned.strip("[]., ")
