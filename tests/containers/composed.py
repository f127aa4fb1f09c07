"""docker/compose.yaml as `podman run` takes it: what is tested is what is delivered.

Limits that this process has no right to raise (without CAP_SYS_RESOURCE) are as high as they may be here.
"""

import os
import re
import resource
from pathlib import Path
from typing import Any

import yaml

from tests.support.repository import ROOT

COMPOSE = ROOT / "docker" / "compose.yaml"
LIMITS = {
    "nofile": resource.RLIMIT_NOFILE,
    "nproc": resource.RLIMIT_NPROC,
    "rtprio": resource.RLIMIT_RTPRIO,
    "memlock": resource.RLIMIT_MEMLOCK,
}
# An engine asks for its own where none is given, and fails where it may not raise them.
EXPLICIT = {"nofile": 65536, "nproc": 8192}


def service(name: str) -> dict[str, Any]:
    """One service as it is written."""
    found: dict[str, Any] = yaml.safe_load(COMPOSE.read_text())["services"][name]
    return found


def value(text: str, given: dict[str, str]) -> str:
    """A compose value, its variables replaced by what is given or by their defaults."""
    return re.sub(r"\$\{(\w+):-(.*?)\}", lambda found: given.get(found[1], found[2]), text)


def arguments(
    name: str, volumes: dict[str, str], given: dict[str, str] | None = None, *, capabilities: bool = True
) -> list[str]:
    """Of `podman run` for the service: all but its image, network, ports and command.

    volumes: names of the file's volumes to names of this test's; given: compose's own variables; capabilities: whether
    it has those that the file adds.
    """
    said = service(name)
    if not capabilities:
        del said["cap_add"]
    found = ["--read-only"] if said.get("read_only") else []
    found += ["--read-only-tmpfs=false"]  # docker's read-only root has no /run and /tmp that can be written
    for option, key in (("--tmpfs", "tmpfs"), ("--cap-drop", "cap_drop"), ("--cap-add", "cap_add")):
        found += [word for item in said.get(key, ()) for word in (option, item)]
    found += [word for item in said.get("security_opt", ()) for word in ("--security-opt", item.removesuffix(":true"))]
    for variable, text in said.get("environment", {}).items():
        if text is None:  # as it is here
            found += ["--env", variable]
        else:
            found += ["--env", f"{variable}={value(text, given or {})}"]
    for mount in said.get("volumes", ()):
        source, rest = value(mount, given or {}).split(":", 1)
        found += ["--volume", f"{_source(source, volumes)}:{rest}"]
    if "shm_size" in said:
        found += ["--shm-size", said["shm_size"]]
    return found + _limits(said.get("ulimits", {}))


def _source(source: str, volumes: dict[str, str]) -> str:
    return str((COMPOSE.parent / source).resolve()) if source.startswith((".", "/")) else volumes[source]


def _limits(wanted: dict[str, int]) -> list[str]:
    found = []
    for name, number in (EXPLICIT | wanted).items():
        hard = resource.getrlimit(LIMITS[name])[1]
        if hard != resource.RLIM_INFINITY and not _may_raise() and (number < 0 or number > hard):
            number = hard
        found += ["--ulimit", f"{name}={number}:{number}"]
    return found


def _may_raise() -> bool:
    status = Path("/proc/self/status").read_text()
    effective = re.search(r"^CapEff:\s*(\w+)", status, re.MULTILINE)
    return os.geteuid() == 0 and effective is not None and bool(int(effective[1], 16) >> 24 & 1)
