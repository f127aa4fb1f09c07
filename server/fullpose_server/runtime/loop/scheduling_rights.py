"""Why real-time scheduling is refused, and what would grant it.

The kernel answers EPERM in each of these cases (sched(7), cgroups(7)), which are told apart by what the process has:
- neither CAP_SYS_NICE in effect nor RLIMIT_RTPRIO: a container that was given the capability does not pass it on to a
  user who is not root, unless its engine makes it ambient;
- RLIMIT_RTPRIO, but below the priority that is asked for;
- leave by one of the two, and a control group without a share of real time: cgroup v1 on a kernel that shares real time
  out by groups gives a new group none (`cpu.rt_runtime_us` is 0);
- leave, and a share or none that can be read: a seccomp profile, a security module, or the kernel's groups under
  cgroup v2.
"""

import os
import resource
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

CAP_IPC_LOCK, CAP_SYS_NICE = 14, 23  # capabilities(7): bits of a set
SHARE_US = 950_000  # of each second, what the kernel itself leaves to real time by default


@dataclass(frozen=True)
class SchedulingRights:
    """What a process may, as the kernel tells it."""

    effective: int  # capabilities in effect, a bit each
    bounding: int  # those that it, or what it starts, could be given
    rtprio: int  # RLIMIT_RTPRIO; 99 where it is unlimited
    share_us: int | None  # of real time in a period, of its control group; None: the kernel tells none
    filtered: bool  # whether a seccomp profile looks at its system calls
    root: bool

    def may(self, capability: int) -> bool:
        """Whether the capability is in effect."""
        return bool(self.effective >> capability & 1)


def own_rights(proc: Path = Path("/proc/self")) -> SchedulingRights:
    """Those of this process; `proc` is its folder in /proc."""
    status = dict(line.split(":", 1) for line in (proc / "status").read_text().splitlines() if ":" in line)
    rtprio = resource.getrlimit(resource.RLIMIT_RTPRIO)[0]
    return SchedulingRights(
        effective=int(status["CapEff"], 16),
        bounding=int(status["CapBnd"], 16),
        rtprio=99 if rtprio == resource.RLIM_INFINITY else rtprio,
        share_us=_share_us(proc),
        filtered=int(status.get("Seccomp", "0")) == 2,
        root=os.geteuid() == 0,
    )


def why_refused(rights: SchedulingRights, priority: int) -> str:
    """Why SCHED_FIFO at `priority` was refused to who has these rights, and what to do: one line."""
    shareless = rights.share_us == 0
    share = (
        "its control group has no share of real time (cgroup v1, cpu.rt_runtime_us is 0): give it one and its parents "
        f"before it (--cpu-rt-runtime={SHARE_US} of docker run and podman run)"
    )
    if not rights.may(CAP_SYS_NICE) and rights.rtprio < priority:
        return _leave(rights, priority) + (f"; and {share}" if shareless else "")
    held = "CAP_SYS_NICE is there" if rights.may(CAP_SYS_NICE) else f"RLIMIT_RTPRIO {rights.rtprio} allows it"
    if shareless:
        return f"{held}, but {share}"
    if rights.share_us is not None:
        who = "a seccomp profile" if rights.filtered else "a security module"
        return f"{held}, and a share of real time: {who} forbids sched_setscheduler, allow it there"
    seccomp = "a seccomp profile forbids sched_setscheduler, or " if rights.filtered else ""
    return (
        f"{held}: {seccomp}the kernel shares real time out by control groups (CONFIG_RT_GROUP_SCHED), which under "
        "cgroup v2 leaves none to any but the root group: start it with rt_group_sched=0"
    )


def _leave(rights: SchedulingRights, priority: int) -> str:
    """What is missing where neither capability nor limit allows it."""
    limit = f"a limit: ulimit -r {priority} (compose: ulimits, rtprio)"
    if rights.rtprio:
        return (
            f"RLIMIT_RTPRIO is {rights.rtprio}, and there is no CAP_SYS_NICE: give {limit}, or ask for less with "
            "realtime_priority in the rig file's [process]"
        )
    if rights.root:
        return f"there is no CAP_SYS_NICE: give it (compose: cap_add: [SYS_NICE]), or {limit}"
    if rights.bounding >> CAP_SYS_NICE & 1:
        return f"there is no RLIMIT_RTPRIO, and CAP_SYS_NICE is not in effect for who is not root: give {limit}"
    return f"there is neither CAP_SYS_NICE nor RLIMIT_RTPRIO: give {limit}"


def _share_us(proc: Path) -> int | None:
    """`cpu.rt_runtime_us` of the process's group; None without cgroup v1's cpu controller, or without shares [us]."""
    try:
        group = _group((proc / "cgroup").read_text())
        folder = None if group is None else _folder((proc / "mountinfo").read_text(), group)
        return None if folder is None else int((folder / "cpu.rt_runtime_us").read_text())
    except (OSError, ValueError):
        return None


def _group(cgroup: str) -> PurePosixPath | None:
    """The path of the group in cgroup v1's cpu hierarchy."""
    for line in cgroup.splitlines():
        _, controllers, path = line.split(":", 2)
        if "cpu" in controllers.split(","):
            return PurePosixPath(path)
    return None


def _folder(mountinfo: str, group: PurePosixPath) -> Path | None:
    """Where that hierarchy is mounted (proc(5), mountinfo), and the group's folder there."""
    for line in mountinfo.splitlines():
        mount, _, source = line.partition(" - ")
        kind, _, options = source.split(" ", 2)
        if kind != "cgroup" or "cpu" not in options.split(","):
            continue
        root, point = (PurePosixPath(field) for field in mount.split(" ")[3:5])
        # A container is shown its own group as the root of what is mounted.
        return Path(point) / (group.relative_to(root) if group.is_relative_to(root) else "")
    return None
