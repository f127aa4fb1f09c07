"""The wheel: what a `pip install` puts on a machine, and that it works from there."""

import importlib.util
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.support.repository import ROOT


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built from a copy of what the build reads; the console is the one that set-up built."""
    tree = tmp_path_factory.mktemp("tree")
    for name in ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, tree)
    for name in ("solver", "server", "web"):
        shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("node_modules", "__pycache__"))
    spec = importlib.util.spec_from_file_location("hatch_build_of_the_wheel", tree / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    hook = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = hook  # its dataclasses look their module up
    spec.loader.exec_module(hook)
    assert hook.Console(tree).fresh(), "the console is behind its sources: run tools/setup"
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel"], cwd=tree, check=True, capture_output=True
    )
    (built,) = (tree / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder as site-packages has it after the install."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def run(folder: Path, code: str) -> str:
    """What `code` prints, with the installed packages in front of everything and the repository out of the way."""
    before = f"import sys; sys.path.insert(0, {str(folder)!r})\n"
    command = [sys.executable, "-P", "-c", before + code]
    return subprocess.run(command, cwd=folder, env={}, check=True, capture_output=True, text=True).stdout


def test_it_installs_our_own_names_and_nothing_else(installed: Path) -> None:
    (info,) = installed.glob("*.dist-info")
    assert info.name.startswith("fullpose-")
    assert {path.name for path in installed.iterdir()} == {"fullpose", "fullpose_server", info.name}


def test_it_holds_the_console_and_neither_its_sources_nor_kernels(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert "fullpose_server/console/index.html" in names
    assert any(name.startswith("fullpose_server/console/assets/") and name.endswith(".js") for name in names)
    assert not any(name.startswith("web/") or name.endswith((".nbi", ".nbc")) for name in names)


def test_both_packages_say_that_they_are_typed(installed: Path) -> None:
    assert (installed / "fullpose" / "py.typed").is_file()
    assert (installed / "fullpose_server" / "py.typed").is_file()


def test_a_type_checker_reads_the_types_of_the_installed_library(installed: Path, tmp_path: Path) -> None:
    """As a package in site-packages, where mypy takes what has no `py.typed` for untyped."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True)
    (site,) = (tmp_path / "venv").glob("lib/python*/site-packages")
    shutil.copytree(installed / "fullpose", site / "fullpose")
    script = tmp_path / "script.py"
    script.write_text("from fullpose.rig import builtin_rigs\n\nreveal_type(builtin_rigs())\n")
    command = [sys.executable, "-m", "mypy", "--config-file=", "--ignore-missing-imports", "--follow-imports=silent"]
    command += ["--python-executable", str(tmp_path / "venv" / "bin" / "python"), str(script)]
    done = subprocess.run(command, cwd=tmp_path, env={}, capture_output=True, text=True)
    assert re.search(r"dict\[(builtins\.)?str, fullpose\.rig\.Rig\]", done.stdout), done.stdout


def test_both_packages_are_imported_from_where_they_are_installed(installed: Path) -> None:
    said = run(installed, "import fullpose, fullpose_server\nprint(fullpose.__file__, fullpose_server.__file__)")
    assert said.split() == [str(installed / name / "__init__.py") for name in ("fullpose", "fullpose_server")]


def test_the_installed_command_line_starts(installed: Path) -> None:
    said = run(installed, "sys.argv = ['fullpose', 'rigs']\nfrom fullpose_server.cli import main\nmain()")
    assert "vertical-4" in said


def test_the_names_of_the_rooms_are_not_importable(installed: Path) -> None:
    """`solver` and `server` were once installed at top level, over everybody's modules of these names."""
    code = "import importlib.util\nprint([n for n in ('solver', 'server') if importlib.util.find_spec(n)])"
    command = [sys.executable, "-I", "-S", "-c", f"import sys; sys.path.append({str(installed)!r})\n{code}"]
    assert subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip() == "[]"
