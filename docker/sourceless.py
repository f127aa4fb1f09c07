"""Of other packages' modules keeps the byte code alone, where there is some: Python imports it as it does the source.

Usage: sourceless.py, by the Python whose packages they are, once all has been imported that is to be. Ours keep their
sources, which Numba asks for to know its kernels again; what was never imported keeps its source too.
"""

import sysconfig
from pathlib import Path

OURS = ("fullpose", "fullpose_server")


def main() -> None:
    """One line says how much went."""
    packages = Path(sysconfig.get_path("purelib"))
    saved = 0
    for code in packages.glob("**/__pycache__/*.pyc"):
        folder = code.parent.parent
        source = folder / f"{code.name.partition('.')[0]}.py"
        if folder.relative_to(packages).parts[:1] in {(name,) for name in OURS} or not source.is_file():
            continue
        saved += source.stat().st_size
        code.replace(source.with_suffix(".pyc"))
        source.unlink()
        if not any(code.parent.iterdir()):
            code.parent.rmdir()
    print(f"sources of {saved / 1e6:.0f} MB are gone, their byte code stays: {packages}")  # noqa: T201


if __name__ == "__main__":
    main()
