"""`import fullpose`: what a researcher needs, typed, and nothing loaded before it is used."""

import ast
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import pytest

import fullpose


def test_every_name_is_there_and_is_no_module() -> None:
    assert 20 <= len(fullpose.__all__) <= 32
    for name in fullpose.__all__:
        assert not isinstance(getattr(fullpose, name), ModuleType), name
        assert name in dir(fullpose)
    assert fullpose.__version__ == version("fullpose")


def test_what_is_typed_is_what_is_loaded() -> None:
    tree = ast.parse(Path(str(fullpose.__file__)).read_text(encoding="utf-8"))
    typed = {
        alias.name
        for node in tree.body
        if isinstance(node, ast.If)
        for each in node.body
        if isinstance(each, ast.ImportFrom)
        for alias in each.names
    }
    assert typed == set(fullpose.__all__)
    assert (Path(str(fullpose.__file__)).parent / "py.typed").is_file()


@pytest.mark.parametrize("first", ["", "from fullpose.solve import BLOCK; from fullpose.plan.plan import plan; "])
def test_a_name_is_the_function_whatever_was_loaded_before(first: str) -> None:
    code = f"{first}import fullpose; print(fullpose.solve.__name__, fullpose.plan.__name__, fullpose.compare.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["solve", "plan", "compare"]


def test_it_is_light_until_it_is_used() -> None:
    code = "import sys, fullpose; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert {"numpy", "numba", "scipy"}.isdisjoint(done.stdout.split())


def test_a_name_that_is_not_there() -> None:
    with pytest.raises(AttributeError, match="no attribute 'sovle'"):
        _ = fullpose.sovle  # type: ignore[attr-defined]
