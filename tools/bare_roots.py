"""Bare roots by debootstrap: made, copied, given what this machine's registries need, and entered in namespaces."""

import os
import re
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
RELEASES = {
    "debian12": ("debian", "bookworm"),
    "debian13": ("debian", "trixie"),
    "jammy": ("ubuntu", "jammy"),
    "noble": ("ubuntu", "noble"),
}
COMPONENTS = {"debian": "main", "ubuntu": "main,universe"}
OLDEST = {"debian": "sid", "ubuntu": "gutsy"}  # whose script debootstrap has for every later release
BARE = "python3,make"
USER, FOLDER = "engineer", "full pose (1)"
# How this machine reaches its registries, so that a bare root does too.
VARIABLES = re.compile(r"^(PIP_|UV_|SSL_CERT|NODE_EXTRA|REQUESTS_CA|CURL_CA|NPM_CONFIG|https?_proxy|no_proxy)", re.I)
FILES = ("/etc/pip.conf", "~/.config/pip/pip.conf", "~/.npmrc", "/etc/npmrc", "/etc/ssl/certs/ca-certificates.crt")


class FreshError(Exception):
    """A root cannot be made."""


def mirror() -> str:
    """What apt takes the packages of this machine's own distribution from."""
    told = "$(ORIGIN) $(REPO_URI) $(COMPONENT)"
    command = ["apt-get", "indextargets", "--format", told, "Created-By: Packages"]
    for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        origin, uri, component = line.rsplit(" ", 2)
        if origin in ("Debian", "Ubuntu") and component == "main" and "security" not in uri:
            return uri.rstrip("/")
    raise FreshError("apt has no list of this machine's packages: apt-get update")


def source(family: str) -> str:
    """Where `family` is on that mirror. Raises `FreshError` where it is not."""
    return f"{mirror().rsplit('/', 1)[0]}/{family}"


def keyring(family: str, roots: Path) -> Path:
    """The keys of `family`: this machine's, or as Debian 13 has them. Raises `FreshError`."""
    name = f"{family}-archive-keyring"
    for place in (Path("/usr/share/keyrings"), roots):
        if (place / f"{name}.gpg").exists():
            return place / f"{name}.gpg"
    if not (roots / "debian13").exists():
        raise FreshError(f"/usr/share/keyrings/{name}.gpg is not here, nor a root of debian13 that could install it")
    with copy_of(roots / "debian13") as copy:
        apt = f"apt-get update -q && apt-get install -q -y --no-install-recommends {name}"
        done = subprocess.run(entered(copy, "root", "sh", "-c", apt), capture_output=True, text=True)
        if done.returncode != 0:
            raise FreshError(f"{name} cannot be installed in debian13: {done.stderr[-300:]}")
        shutil.copyfile(copy / f"usr/share/keyrings/{name}.gpg", roots / f"{name}.gpg")
    return roots / f"{name}.gpg"


def make_root(name: str, root: Path) -> None:
    """A root of that release with python3 and make, and where its packages are. Raises `FreshError`."""
    family, suite = RELEASES[name]
    uri = source(family)
    try:
        urllib.request.urlopen(f"{uri}/dists/{suite}/Release", timeout=60).close()
    except (urllib.error.URLError, TimeoutError) as cause:
        raise FreshError(f"the mirror has no {family} {suite}: {cause}") from cause
    options = ["--variant=minbase", f"--include={BARE}", f"--components={COMPONENTS[family]}"]
    options.append(f"--keyring={keyring(family, root.parent)}")
    made = root.with_suffix(".part")
    scripts = Path("/usr/share/debootstrap/scripts")
    script = [] if (scripts / suite).exists() else [str(scripts / OLDEST[family])]  # for one that is younger than it
    command = ["unshare", "--mount", "debootstrap", *options, suite, str(made), uri, *script]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise FreshError(f"debootstrap failed: {' | '.join(done.stdout.splitlines()[-3:])}")
    made.rename(root)


def dress(root: Path) -> Path:
    """What makes a copy of a root this machine's: registries, a user, this tree. Its folder as the user sees it."""
    (root / "usr/local/share/ca-certificates").mkdir(parents=True, exist_ok=True)
    subprocess.run(["chroot", root, "useradd", "--create-home", "--shell", "/bin/bash", USER], check=True)
    for name in FILES:
        held = Path(name).expanduser()
        if held.is_file():
            homes = ["/root", f"/home/{USER}"] if name.startswith("~") else [""]
            for home in homes:
                place = root / (home + name.removeprefix("~")).lstrip("/")
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(held, place)
    if Path(FILES[-1]).is_file():  # where the package ca-certificates, once installed, takes it from
        shutil.copyfile(FILES[-1], root / "usr/local/share/ca-certificates/machine.crt")
    apt = Path("/etc/apt/apt.conf.d")
    shutil.copytree(apt, root / "etc/apt/apt.conf.d", dirs_exist_ok=True, ignore=shutil.ignore_patterns("docker-*"))
    shutil.copyfile("/etc/resolv.conf", root / "etc/resolv.conf")
    shutil.copyfile("/etc/hosts", root / "etc/hosts")
    for home in ("root", f"home/{USER}"):
        folder = root / home / FOLDER
        clone = ["git", "clone", "--quiet", "--no-hardlinks", str(REPOSITORY), str(folder)]
        subprocess.run(clone, check=True)
    subprocess.run(["chroot", root, "chown", "-R", f"{USER}:{USER}", f"/home/{USER}"], check=True)
    return root


def entered(root: Path, who: str, *command: str) -> list[str]:
    """The command line that runs `command` in the root, in the tree, with mounts and processes of its own.

    Whoever is not root has no right to real time, as a user of a plain machine.
    """
    home = "/root" if who == "root" else f"/home/{who}"
    settings = {name: value for name, value in os.environ.items() if VARIABLES.match(name)}
    settings |= {"HOME": home, "USER": who, "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"}
    settings |= {"LANG": "C.UTF-8", "TERM": "dumb"}
    rights = [] if who == "root" else [f"--reuid={who}", f"--regid={who}", "--init-groups", "--bounding-set=-sys_nice"]
    # The first process of a namespace takes no signal that it does not wait for, and the others end with it.
    script = """
        mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount --rbind /sys "$0/sys" || exit 99
        root=$0; folder=$1; shift
        exec chroot "$root" bash -c 'trap : INT TERM; cd "$0" && "$@"; exit $?' "$folder" "$@"
    """
    inside = ["env", "-i", *(f"{name}={value}" for name, value in settings.items())]
    limits = ["prlimit", "--rtprio=0:0"] if who != "root" else []
    namespaces = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
    where = [str(root), f"{home}/{FOLDER}"]
    return [*namespaces, "bash", "-c", script, *where, *limits, "setpriv", *rights, *inside, *command]


@contextmanager
def copy_of(root: Path) -> Iterator[Path]:
    """A copy of the root, taken away afterwards; nothing is mounted in it outside of its commands' namespaces."""
    with tempfile.TemporaryDirectory(prefix="run-", dir=root.parent) as folder:
        copy = Path(folder) / root.name
        subprocess.run(["cp", "-a", "--reflink=auto", root, copy], check=True)
        yield dress(copy)
