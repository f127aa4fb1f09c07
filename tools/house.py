"""The figures of the house: how long, how wide, how often. Prints those of a tree.

    python tools/house.py [ROOT] [--json]

The packages are looked for by the names they have had. `tests/house` holds this tree to its bounds.
"""

import argparse
import ast
import io
import json
import keyword
import tokenize
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

PACKAGES = ("solver/fullpose", "server/fullpose_server")
BEFORE = ("solver", "server")  # of trees before the packages had our names
HAND_WRITTEN = (*PACKAGES, "web/src", "tests", "bench", "tools", "docker")
GENERATED = {"schema.d.ts", "stream_schema.d.ts", "node_modules", "console", "generated"}
KERNELS = ("kernel", "inner", "inlined", "njit", "forceinline")
LINES, PARAMETERS, FILE = 60, 8, 300
REPEAT = 6  # lines that count as repeated code


@dataclass(frozen=True)
class Function:
    """One function: where it is, its lines, its parameters without `self`, whether Numba compiles it."""

    file: str
    name: str
    lines: int
    parameters: int
    kernel: bool


def packages(root: Path) -> tuple[Path, ...]:
    """The folders of the two packages in `root`."""
    ours = PACKAGES if (root / PACKAGES[0]).is_dir() else BEFORE
    return tuple(root / name for name in ours)


def sources(folders: Iterable[Path]) -> Iterator[tuple[Path, str]]:
    """(path, text) of the Python files in `folders`."""
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            yield path, path.read_text(encoding="utf-8")


def functions(root: Path, folders: Iterable[Path]) -> list[Function]:
    """Every function in `folders`, methods and inner ones too."""
    found = []
    for path, text in sources(folders):
        tree = ast.parse(text)
        methods = {
            id(item)
            for node in ast.walk(tree)
            if isinstance(node, ast.ClassDef)
            for item in node.body
            if isinstance(item, ast.FunctionDef | ast.AsyncFunctionDef)
            and not any(ast.unparse(mark) == "staticmethod" for mark in item.decorator_list)
        }
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            a = node.args
            count = (
                len(a.posonlyargs) + len(a.args) + len(a.kwonlyargs) + (a.vararg is not None) + (a.kwarg is not None)
            )
            marks = {ast.unparse(mark).split("(")[0].split(".")[-1] for mark in node.decorator_list}
            lines = (node.end_lineno or node.lineno) - node.lineno + 1
            place = path.relative_to(root).as_posix()
            found.append(Function(place, node.name, lines, count - (id(node) in methods), bool(marks & set(KERNELS))))
    return found


def long_files(root: Path) -> list[tuple[int, str]]:
    """(lines, path) of hand-written files longer than `FILE`."""
    folders = [root / name for name in HAND_WRITTEN if (root / name).is_dir()]
    folders += [folder for folder in packages(root) if folder not in folders]
    found = []
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            written = path.suffix in {".py", ".ts", ".svelte", ".css", ".mjs"}
            if written and not GENERATED.intersection(path.relative_to(root).parts):
                lines = path.read_text(encoding="utf-8").count("\n")
                if lines > FILE:
                    found.append((lines, path.relative_to(root).as_posix()))
    return sorted(found, reverse=True)


def shapes(text: str) -> list[tuple[int, str]]:
    """(line, its tokens with names and literals replaced) of every line with code, but for imports and docstrings."""
    lines: dict[int, list[str]] = defaultdict(list)
    previous = tokenize.NEWLINE
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in (tokenize.COMMENT, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER):
            continue
        if token.type == tokenize.STRING and previous == tokenize.NEWLINE:  # a docstring
            continue
        previous = token.type
        if token.type == tokenize.NEWLINE:
            continue
        word = token.string
        if token.type == tokenize.NAME and not keyword.iskeyword(word):
            word = "N"
        elif token.type in (tokenize.NUMBER, tokenize.STRING):
            word = "L"
        lines[token.start[0]].append(word)
    found = [(number, " ".join(words)) for number, words in sorted(lines.items())]
    return [(number, shape) for number, shape in found if not shape.startswith(("from ", "import ")) and len(shape) > 3]


def repeated_lines(folders: Iterable[Path]) -> int:
    """Lines of code that stand in a run of `REPEAT` or more lines which is elsewhere too, names and literals aside."""
    places: dict[tuple[str, ...], list[tuple[str, list[int]]]] = defaultdict(list)
    for path, text in sources(folders):
        lines = shapes(text)
        for k in range(len(lines) - REPEAT + 1):
            window = lines[k : k + REPEAT]
            places[tuple(shape for _, shape in window)].append((str(path), [number for number, _ in window]))
    counted: set[tuple[str, int]] = set()
    for window, found in places.items():
        if len(found) > 1 and sum(len(shape.split()) for shape in window) >= 40:  # short lines are alike by chance
            counted |= {(path, number) for path, numbers in found for number in numbers}
    return len(counted)


def array_definitions(folders: Iterable[Path]) -> list[str]:
    """Files that say `Array = ...`."""
    return [
        str(path)
        for path, text in sources(folders)
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == "Array" for t in node.targets)
    ]


def figures(root: Path) -> dict[str, int]:
    """The figures of a tree."""
    folders = packages(root)
    every = functions(root, folders)
    return {
        f"functions over {LINES} lines, kernels": sum(f.lines > LINES and f.kernel for f in every),
        f"functions over {LINES} lines, others": sum(f.lines > LINES and not f.kernel for f in every),
        f"functions with more than {PARAMETERS} parameters": sum(f.parameters > PARAMETERS for f in every),
        f"hand-written files over {FILE} lines": len(long_files(root)),
        f"repeated lines of code ({REPEAT} lines and more, names aside)": repeated_lines(folders),
        "definitions of Array": len(array_definitions(folders)),
    }


def main() -> None:
    """Print them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).parents[1])
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    root = given.root.resolve()
    found = figures(root)
    if given.json:
        print(json.dumps(found, indent=2))
        return
    for name, value in found.items():
        print(f"{value:6d}  {name}")
    for f in sorted(functions(root, packages(root)), key=lambda f: (f.file, f.name)):
        if f.lines > LINES or f.parameters > PARAMETERS:
            kind = "kernel" if f.kernel else ""
            print(f"        {f.file}: {f.name}: {f.lines} lines, {f.parameters} parameters {kind}")
    for lines, path in long_files(root):
        print(f"        {path}: {lines} lines")


if __name__ == "__main__":
    main()
