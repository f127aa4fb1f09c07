"""How kernels are compiled, and that the inner ones are what their compilation takes them for."""

import ast
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
