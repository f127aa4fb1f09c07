"""Takes out of an installed Fullpose what the server never loads, and compiles what it does: a third of the image.

Usage: trim.py, by the Python whose packages are to be trimmed; it needs `strip` (binutils). What goes: other packages'
own tests, files to compile against them, symbols for debuggers, the parts of Arrow that reach other machines, and the
parts of SciPy that nothing of ours uses. Then every module of ours is imported, with what it imports: what is missing
ends the build, and what is there has its byte code.
"""

import importlib
import pkgutil
import shutil
import subprocess
import sysconfig
from collections.abc import Iterator
from pathlib import Path

UNUSED = ("cluster", "datasets", "differentiate", "fftpack", "integrate", "io", "misc", "odr", "signal", "stats")
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
    strip = shutil.which("strip")
    if strip is not None:
        found = (*packages.glob("**/*.so"), *packages.glob("**/*.so.*"))
        # Not in *.libs: their headers were moved when the wheels were made, and `strip` breaks them.
        libraries = [path for path in found if path.parent.suffix != ".libs"]
        subprocess.run([strip, "--strip-unneeded", *libraries], check=True)
    for name in (*OURS, *LATER, *modules()):
        importlib.import_module(name)
    left = sum(path.lstat().st_size for path in packages.rglob("*") if path.is_file())
    print(f"trimmed to {left / 1e6:.0f} MB: {packages}")  # noqa: T201


def modules() -> Iterator[str]:
    """All of ours."""
    for package in OURS:
        for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
            if not module.name.startswith(ELSEWHERE) and not module.name.endswith("__main__"):
                yield module.name


if __name__ == "__main__":
    main()
