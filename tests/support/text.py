"""The repository's own text, for tests of what is written in it."""

import re
from collections.abc import Iterator
from pathlib import Path

from tests.support.repository import ROOT

FOLDERS = ("solver", "server", "tests", "bench", "docs", "web/src", "web/tools", "examples", "tools", "docker")
SUFFIXES = {".py", ".md", ".ts", ".svelte", ".css", ".toml", ".yaml", ".mjs", ".html", ""}
BUILT = {"node_modules", "__pycache__", "console", "generated"}


def written() -> Iterator[tuple[Path, str]]:
    """(path in the repository, text) of every file that a person wrote."""
    files = [path for path in ROOT.iterdir() if path.is_file()]
    files += [path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file()]
    for path in sorted(files):
        short = path.relative_to(ROOT)
        if (
            path.suffix in SUFFIXES
            and not BUILT.intersection(short.parts)
            and not path.name.startswith((".", "LICENSE"))
        ):
            yield short, path.read_text(encoding="utf-8")


def joined(text: str) -> str:
    """`text` with the ends of its lines, and the comment signs after them, made single spaces: sentences are whole."""
    return re.sub(r"\s*\n[ \t]*(?:#|//|\*|>)?[ \t]*", " ", text)
