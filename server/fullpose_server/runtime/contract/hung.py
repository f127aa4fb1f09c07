"""Whether a rig process hangs for good, as another process sees it: by its marks in the shared memory.

What is looked at: its sign of life is old, and it is in a call of its drive, or in motion, where nothing else may take
long. Looks are counted, not time: who was put aside itself has looked no oftener. A process that was suspended
(SIGSTOP, a debugger) does not hang: it comes back, and brakes then.
"""

from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fullpose_server.runtime.contract.drive_call import PATIENT, pending
from fullpose_server.session.states import IN_MOTION

_RECORDER_SILENT_NS, _RECORDER_LATE_NS = 1_000_000_000, 8_000_000_000
_ENDED = frozenset({"", "Z", "X", "T", "t"})  # proc(5): none, a zombie, dead, suspended, traced
SILENT_NS = 150_000_000  # a sign of life older than this: the loop does not respond
_CODES = frozenset(state.code for state in IN_MOTION)


def is_silent(header: NDArray[Any], now_ns: int) -> bool:
    """Whether the loop has given no sign of life for a while."""
    return now_ns - int(header["rig_beat_ns"][0]) > SILENT_NS


def recorder_lost(header: NDArray[Any], now_ns: int) -> bool:
    """Whether the recorder records no more: silent for a second, and gone or held by the system; or silent for long.

    One that is alive is only late: the ring keeps sixteen seconds for it at 2 kHz.
    """
    silent_ns = now_ns - int(header["recorder_beat_ns"][0])
    if silent_ns < _RECORDER_SILENT_NS:
        return False
    return silent_ns > _RECORDER_LATE_NS or recorder_ended(header)


def recorder_ended(header: NDArray[Any]) -> bool:
    """Whether the recorder's process is gone or held by the system: known at once, where silence takes its time."""
    return _state_of(int(header["recorder_pid"][0])) in _ENDED


def suspended(pid: int) -> bool:
    """Whether the system holds the process."""
    return _state_of(pid) in ("T", "t")


def _state_of(pid: int) -> str:
    """One letter, as proc(5) has it; empty: there is no such process."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (OSError, IndexError):
        return ""


class Hung:
    """Looks at one process again and again; `looks` in a row decide, `patient` of them where a call may take long."""

    def __init__(self, looks: int, patient: int) -> None:
        self._looks = looks
        self._patient = patient
        self._count = 0

    def look(self, header: NDArray[Any], pid: int, state_code: int | None, now_ns: int) -> bool:
        """Whether it hangs for good; `state_code` of the session, of the newest sample, None: not known."""
        if not is_silent(header, now_ns):
            self._count = 0
            return False
        call = pending(header)
        if (call is None and state_code not in _CODES) or suspended(pid):
            self._count = 0
            return False
        self._count += 1
        return self._count >= (self._patient if call is None or call.call in PATIENT else self._looks)
