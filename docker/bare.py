"""Takes out of a Debian-like root what a server never runs: package managers, Perl, character sets, their libraries.

Usage: bare.py, as root, by the system's own Python, in the stage that the image's root is copied from: from a layer
below nothing can be taken. Afterwards every program and library that is left must find what it links to: what is
missing ends the build. The list of what is installed stays, for who looks for known faults in it.
"""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

PACKAGES = (
    "apt",
    "libapt-pkg*",
    "debconf",
    "dpkg",
    "e2fsprogs",
    "gpgv",
    "libext2fs2*",
    "libgnutls30*",
    "libp11-kit0",
    "logsave",
    "mount",
    "perl-base",
    "tzdata",
)
FOLDERS = (
    "usr/lib/*/gconv",
    "usr/lib/*/perl-base",
    "usr/share/doc",
    "usr/share/info",
    "usr/share/locale",
    "usr/share/man",
    "usr/share/perl5",
    "usr/share/zoneinfo",
    "var/cache/apt",
    "var/cache/debconf",
    "var/lib/apt",
    "var/lib/dpkg/info",
    "var/log",
)
# The system's, and Python's own from which the server runs; what links to a library that went, and is not listed here.
LINKED = ("usr/bin/*", "usr/sbin/*", "usr/lib/*/*.so*", "usr/lib/python3*/lib-dynload/*.so")
LINKED_TOO = ("usr/local/bin/*", "usr/local/lib/*.so*", "usr/local/lib/python3*/lib-dynload/*.so")
ROOT = Path("/")


def main() -> None:
    """Remove, then look."""
    for path in list(files()):
        if not path.is_dir():  # as /bin is, a link to the folder of the same name
            path.unlink(missing_ok=True)
    for pattern in FOLDERS:
        for folder in ROOT.glob(pattern):
            subprocess.run(["rm", "-rf", "--", folder], check=True)
    broken = list(unlinked())
    if broken:
        sys.exit("\n".join(broken))


def files() -> Iterator[Path]:
    """Of the packages that are installed."""
    listed = ROOT / "var/lib/dpkg/info"
    for name in PACKAGES:
        for found in (*listed.glob(f"{name}.list"), *listed.glob(f"{name}:*.list")):
            yield from map(Path, found.read_text("utf-8").split("\n"))


def unlinked() -> Iterator[str]:
    """Programs and libraries that no longer find what they link to."""
    for pattern in (*LINKED, *LINKED_TOO):
        for path in ROOT.glob(pattern):
            with path.open("rb") as file:
                elf = file.read(4) == b"\x7fELF"
            if elf and "not found" in (
                said := subprocess.run(["ldd", path], check=False, capture_output=True, text=True).stdout
            ):
                yield f"{path}: {said}"


if __name__ == "__main__":
    main()
