"""Each way to be refused real time has a sentence and a cure of its own."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from fullpose_server.runtime.loop.scheduling_rights import (
    CAP_SYS_NICE,
    SchedulingRights,
    own_rights,
    why_refused,
)

NICE = 1 << CAP_SYS_NICE
NOTHING = SchedulingRights(effective=0, bounding=0, rtprio=0, share_us=None, filtered=False, root=False)
CONTAINER = "/libpod_parent/libpod-1"


@pytest.mark.parametrize(
    ("rights", "said", "unsaid"),
    [
        (NOTHING, "neither CAP_SYS_NICE nor RLIMIT_RTPRIO", "share"),
        (replace(NOTHING, root=True), "cap_add: [SYS_NICE]", "share"),
        (replace(NOTHING, bounding=NICE), "CAP_SYS_NICE is not in effect for who is not root", "share"),
        (replace(NOTHING, rtprio=40), "RLIMIT_RTPRIO is 40", "share"),
        (replace(NOTHING, rtprio=40), "realtime_priority", "share"),
        (replace(NOTHING, share_us=0), "neither CAP_SYS_NICE nor RLIMIT_RTPRIO", "seccomp"),
        (replace(NOTHING, share_us=0), "and its control group has no share", "seccomp"),
        (replace(NOTHING, effective=NICE, share_us=0), "CAP_SYS_NICE is there, but its control group", "ulimit"),
        (replace(NOTHING, rtprio=95, share_us=0), "RLIMIT_RTPRIO 95 allows it, but its control group", "ulimit"),
        (replace(NOTHING, effective=NICE, share_us=9, filtered=True), "a seccomp profile forbids", "rt_group_sched"),
        (replace(NOTHING, effective=NICE, filtered=True), "a seccomp profile forbids sched_setscheduler, or", "ulimit"),
        (replace(NOTHING, rtprio=60), "RLIMIT_RTPRIO 60 allows it: the kernel shares", "seccomp"),
    ],
)
def test_each_refusal_has_its_cure(rights: SchedulingRights, said: str, unsaid: str) -> None:
    why = why_refused(rights, 60)
    assert said in why
    assert unsaid not in why
    assert "\n" not in why


def process(folder: Path, group: str, mounted: str, share: str | None, point: Path) -> Path:
    """A folder like one in /proc, of a process in `group`, where `mounted` of the hierarchy is at `point`."""
    folder.mkdir()
    point.mkdir(parents=True, exist_ok=True)
    status = ("Name:\tx", "CapEff:\t0000000000800000", "CapBnd:\t0000000000800000", "Seccomp:\t2")
    (folder / "status").write_text("\n".join(status) + "\n")
    (folder / "cgroup").write_text(f"4:memory:/elsewhere\n1:cpu,cpuacct:{group}\n0::{group}\n")
    (folder / "mountinfo").write_text(
        f"91 78 0:51 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
        f"92 91 0:29 {mounted} {point} ro,nosuid - cgroup cgroup rw,cpu,cpuacct\n"
    )
    if share is not None:
        (point / "cpu.rt_runtime_us").write_text(share)
    return folder


def test_a_container_is_shown_its_own_group_as_the_root(tmp_path: Path) -> None:
    rights = own_rights(process(tmp_path / "self", CONTAINER, CONTAINER, "0\n", tmp_path / "cpu"))
    assert rights.share_us == 0
    assert rights.filtered
    assert rights.may(CAP_SYS_NICE)


def test_a_group_of_a_namespace_of_its_own(tmp_path: Path) -> None:
    """Its path is then told as / while the mount's root is told from outside."""
    assert own_rights(process(tmp_path / "self", "/", CONTAINER, "0\n", tmp_path / "cpu")).share_us == 0


def test_a_group_on_the_host_is_found_below_the_mount(tmp_path: Path) -> None:
    (tmp_path / "cpu" / "machine").mkdir(parents=True)
    (tmp_path / "cpu" / "machine" / "cpu.rt_runtime_us").write_text("5000\n")
    assert own_rights(process(tmp_path / "self", "/machine", "/", "950000\n", tmp_path / "cpu")).share_us == 5000


@pytest.mark.parametrize("share", [None, "", "max"])
def test_a_kernel_without_shares_tells_none(tmp_path: Path, share: str | None) -> None:
    assert own_rights(process(tmp_path / "self", "/", "/", share, tmp_path / "cpu")).share_us is None


def test_without_the_first_version_s_controller_there_is_none(tmp_path: Path) -> None:
    folder = process(tmp_path / "self", "/", "/", "0", tmp_path / "cpu")
    (folder / "cgroup").write_text("0::/user.slice\n")
    assert own_rights(folder).share_us is None


def test_this_process_is_read() -> None:
    rights = own_rights()
    assert 0 <= rights.rtprio <= 99
    assert rights.root == (os.geteuid() == 0)
