"""How a process ended, in words."""

import contextlib
import subprocess
import sys
from pathlib import Path

import pytest

from fullpose_server.processes import how_it_ended, memory_kills


def test_an_end_for_lack_of_memory_is_named_as_what_it_may_be() -> None:
    assert how_it_ended(3, 0, 1) == "exit status 3"
    assert how_it_ended(-9, 4, 4) == "signal 9"
    assert how_it_ended(-9, 4, 5) == "signal 9, and the system has killed for lack of memory meanwhile"
    assert how_it_ended(-11, 4, 5) == "signal 11"


def test_the_system_counts_what_it_has_killed(tmp_path: Path) -> None:
    counters = tmp_path / "vmstat"
    counters.write_text("pgfault 12\noom_kill 7\noom_kill_extra 9\n")
    assert memory_kills(counters) == 7
    counters.write_text("pgfault 12\n")
    assert memory_kills(counters) == 0
    assert memory_kills(tmp_path / "none") == 0
    assert memory_kills() >= 0


@pytest.mark.parametrize("title", ["rig one", "rig " + "x" * 4000])
def test_a_process_says_what_it_is(title: str) -> None:
    told = "import os, sys; from fullpose_server.processes import call_itself; call_itself(sys.argv[1] or sys.argv[2]);"
    told += "print(open('/proc/self/cmdline').read(), os.environ['PATH'], sep='|')"
    ran = subprocess.run([sys.executable, "-c", told, "", title], capture_output=True, text=True, check=True)
    shown, _, path = ran.stdout.rstrip("\n").partition("|")
    assert shown.rstrip("\0") == title
    assert path  # nothing else was written over


AFTER_OTHERS = """
import os
from pathlib import Path
from fullpose_server.processes import after_others
before = Path("/proc/self/autogroup").read_text().split()
after_others(7)
print(os.nice(0), before[-1], Path("/proc/self/autogroup").read_text().split()[-1])
"""


def groups_sessions() -> bool:
    """Whether this kernel does: its file is missing where it was built without, and empty where a container groups."""
    with contextlib.suppress(OSError):
        return bool(Path("/proc/self/autogroup").read_text("ascii"))
    return False


@pytest.mark.skipif(not groups_sessions(), reason="processes are not grouped by session here")
@pytest.mark.parametrize("alone", [True, False])
def test_a_process_with_a_session_of_its_own_makes_that_nice_as_well(*, alone: bool) -> None:
    """A session that it shares is not its own to change: the server's would wait too."""
    done = subprocess.run(
        [sys.executable, "-c", AFTER_OTHERS], capture_output=True, text=True, check=True, start_new_session=alone
    )
    nice, before, after = done.stdout.split()
    assert int(nice) >= 7
    assert after == ("7" if alone else before)
