"""Takes out of an installed Fullpose what the server never loads, and compiles what it does: a third of the image.

Usage: trim.py, by the Python whose packages are to be trimmed; it needs `strip` (binutils) and `patchelf`. What goes:
other packages' own tests, files to compile against them, symbols for debuggers, the parts of Arrow that reach other
machines or run queries, what nothing of ours uses of SciPy, and second copies; the compiler of pages is packed.
Then every module of ours is imported, with what it imports: what is missing ends the build, unless it is an extra that
was not installed, and what is there has its byte code.
"""

import hashlib
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sysconfig
from collections.abc import Iterable, Iterator
from importlib import metadata
from pathlib import Path

UNUSED = ("cluster", "datasets", "differentiate", "fftpack", "integrate", "misc", "odr", "signal", "stats")
# Linked by every part of Arrow and used by none that reads or writes files.
ARROW = ("acero", "dataset", "substrait")
PATTERNS = (
    "*/**/tests",  # their own: numpy, scipy, numba, pyarrow and others
    "numpy/_core/_simd*",
    "numba/cuda",  # not without a GPU
    "scipy/[!_]*/_test*.so",
    *(f"scipy/{name}" for name in UNUSED),
    "scipy/special/cython_special*",  # for who compiles against it
    "sqlalchemy/testing",
    "include",  # headers, and libraries to link: nothing is compiled against them
    "lib64",
    "*/include",
    "pyarrow/src",
    "pyarrow/libarrow*.so",  # links for a linker that have become copies in the wheel
    "pyarrow/libarrow*.so.*.*.*",
    "pyarrow/*flight*",  # Arrow over the network
    "pyarrow/*s3*",  # cloud storage
    "pygments/lexers/[a-oq-z]*",  # but for p, Python's: for tracebacks
    "pyarrow/*gcsfs*",
    "pyarrow/*azurefs*",
    *(f"pyarrow/*{part}*" for part in ARROW),
    "PIL/_avif*",
    "pillow.libs/libavif*",
    "viser/client/src",
    "zstandard/_cffi*",  # for other Pythons
    "**/*.pyx",
    "**/*.pxd",
    "**/*.pyi",
)
OURS = ("fullpose", "fullpose_server")
LATER = ("pyarrow.csv", "pyarrow.parquet", "viser", "trimesh", "scipy.spatial.transform", "uvloop", "mcap.writer")
ELSEWHERE = "fullpose_server.drives.testing"  # for the tests of drives


def main() -> None:
    """Remove, strip, import; one line says how much is left."""
    packages = Path(sysconfig.get_path("purelib"))
    for path in {path for pattern in PATTERNS for path in packages.glob(pattern)}:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)  # one may be inside of another
        else:
            path.unlink(missing_ok=True)
    found = (*packages.glob("**/*.so"), *packages.glob("**/*.so.*"))
    # Not in *.libs: their headers were moved when the wheels were made, and `strip` breaks them.
    libraries = [path for path in found if path.parent.suffix != ".libs"]
    if tool := shutil.which("strip"):
        subprocess.run([tool, "--strip-unneeded", *libraries], check=True)
    if tool := shutil.which("patchelf"):
        without_parts(tool, packages / "pyarrow")
    pack(packages / "typst")
    once(found)
    optional = extras()
    for name in (*OURS, *LATER, *modules()):
        try:
            importlib.import_module(name)
        except ModuleNotFoundError as missing:
            if (missing.name or "").partition(".")[0] not in optional:
                raise
    sizes = {(at := path.lstat()).st_ino: at.st_size for path in packages.rglob("*") if path.is_file()}
    left = sum(sizes.values())
    print(f"trimmed to {left / 1e6:.0f} MB: {packages}")  # noqa: T201


def without_parts(patchelf: str, arrow: Path) -> None:
    """Arrow's libraries link no more to those of its parts that are gone."""
    for path in (*arrow.glob("*.so"), *arrow.glob("*.so.*")):
        needed = subprocess.run([patchelf, "--print-needed", path], check=True, capture_output=True, text=True).stdout
        for name in needed.split():
            if name.startswith(tuple(f"libarrow_{part}." for part in ARROW)):
                subprocess.run([patchelf, "--remove-needed", name, path], check=True)


PACKED = """\
# Unpacked into memory by the process that makes a page, which is the only one to load it.
import importlib.machinery as _machinery
import importlib.util as _util
import os as _os
import sys as _sys
from pathlib import Path as _Path

import zstandard as _zstandard


def _load():
    descriptor = _os.memfd_create("typst")
    packed = _Path(__file__).with_name("{name}.zst")
    with _os.fdopen(descriptor, "wb", closefd=False) as file, packed.open("rb") as source:
        _zstandard.ZstdDecompressor().copy_stream(source, file)
    loader = _machinery.ExtensionFileLoader("typst._typst", f"/proc/self/fd/{{descriptor}}")
    module = _util.module_from_spec(_util.spec_from_loader("typst._typst", loader))
    _sys.modules["typst._typst"] = module
    loader.exec_module(module)
    _os.close(descriptor)
    return module


_typst = _load()
"""


def pack(package: Path) -> None:
    """Compress the compiler of pages, the largest library that is seldom loaded."""
    import zstandard

    (library,) = package.glob("_typst*.so")
    packed = zstandard.ZstdCompressor(level=19, threads=-1).compress(library.read_bytes())
    library.with_name(f"{library.name}.zst").write_bytes(packed)
    init = package / "__init__.py"
    init.write_text(PACKED.format(name=library.name) + init.read_text("utf-8"), "utf-8")
    library.unlink()


def once(libraries: Iterable[Path]) -> None:
    """Of libraries that two wheels brought, one file by both names."""
    kept: dict[str, Path] = {}
    for path in libraries:
        if path.is_file() and not path.is_symlink():
            first = kept.setdefault(hashlib.sha256(path.read_bytes()).hexdigest(), path)
            if first is not path:
                path.unlink()
                os.link(first, path)


def extras() -> set[str]:
    """What only extras of ours need, as it is imported."""
    needed = metadata.requires(OURS[0]) or []
    always = {name for name, marker in map(_named, needed) if "extra" not in marker}
    return {name for name, _ in map(_named, needed)} - always


def _named(requirement: str) -> tuple[str, str]:
    name, _, marker = requirement.partition(";")
    return re.split(r"[^A-Za-z0-9_.-]", name, maxsplit=1)[0].lower(), marker


def modules() -> Iterator[str]:
    """All of ours."""
    for package in OURS:
        for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
            if not module.name.startswith(ELSEWHERE) and not module.name.endswith("__main__"):
                yield module.name


if __name__ == "__main__":
    main()
