"""Whether a process hangs for good: by its marks, and by looks, not by time."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fullpose_server.runtime.contract.drive_call import DriveCall, hanging, pending
from fullpose_server.runtime.contract.hung import SILENT_NS, Hung, recorder_lost, suspended
from fullpose_server.runtime.contract.shared_memory import Shared
from fullpose_server.session.states import State
from tests.support.waiting import until

SILENT = 1_000 * SILENT_NS


@pytest.fixture
def shared(tmp_path: Path) -> Shared:
    made = Shared(tmp_path / "memory", create=True)
    made.header["rig_beat_ns"] = 1
    return made


def looks(shared: Shared, times: int, state: State = State.ARMED, now_ns: int = SILENT) -> list[bool]:
    hung = Hung(3, 6)
    return [hung.look(shared.header, os.getpid(), state.code, now_ns) for _ in range(times)]


def test_a_call_that_stays_is_one_and_silence_alone_at_rest_is_none(shared: Shared) -> None:
    assert not any(looks(shared, 20))  # it may be loading
    shared.header["drive_call"] = DriveCall.READ
    assert looks(shared, 4) == [False, False, True, True]
    shared.header["drive_call"] = DriveCall.CONNECT
    assert looks(shared, 6) == [False] * 5 + [True]


def test_in_motion_nothing_may_take_long(shared: Shared) -> None:
    assert looks(shared, 6, State.RUNNING) == [False] * 5 + [True]


def test_a_sign_of_life_begins_the_count_anew(shared: Shared) -> None:
    shared.header["drive_call"] = DriveCall.READ
    hung = Hung(2, 2)
    seen = [hung.look(shared.header, os.getpid(), None, now) for now in (SILENT, 1, SILENT, SILENT)]
    assert seen == [False, False, False, True]


def test_one_that_was_suspended_does_not_hang(shared: Shared) -> None:
    shared.header["drive_call"] = DriveCall.READ
    other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    try:
        os.kill(other.pid, signal.SIGSTOP)
        until(lambda: suspended(other.pid))
        hung = Hung(1, 1)
        assert not hung.look(shared.header, other.pid, State.RUNNING.code, SILENT)
        os.kill(other.pid, signal.SIGCONT)
        until(lambda: not suspended(other.pid))
        assert hung.look(shared.header, other.pid, State.RUNNING.code, SILENT)
    finally:
        other.kill()
        other.wait()
    assert not suspended(other.pid)


def test_what_is_said_names_drive_call_and_since_when(shared: Shared) -> None:
    assert pending(shared.header) is None
    shared.header["drive_call"], shared.header["drive_call_ns"] = DriveCall.WRITE, 2_000_000_000
    call = pending(shared.header)
    assert call is not None
    said = hanging("acme", call, 2_120_000_000, 1_700_000_000_120_000_000)
    assert said == "drive acme: write has not returned for 120 ms, since 22:13:20.000000 UTC"


def test_a_recorder_that_is_late_is_not_lost_and_one_that_has_ended_or_is_held_is(shared: Shared) -> None:
    second = 1_000_000_000
    shared.header["recorder_pid"] = os.getpid()
    assert [recorder_lost(shared.header, at * second) for at in (0, 2, 7, 9)] == [False, False, False, True]
    child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    shared.header["recorder_pid"] = child.pid
    child.send_signal(signal.SIGSTOP)
    assert until(lambda: recorder_lost(shared.header, 2 * second))
    child.send_signal(signal.SIGCONT)
    assert until(lambda: not recorder_lost(shared.header, 2 * second))
    child.communicate(b"\n")
    assert recorder_lost(shared.header, 2 * second)
    assert not recorder_lost(shared.header, second // 2)
