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

SILENT_NS = 150_000_000  # a sign of life older than this: the loop does not respond
_CODES = frozenset(state.code for state in IN_MOTION)


def is_silent(header: NDArray[Any], now_ns: int) -> bool:
    """Whether the loop has given no sign of life for a while."""
    return now_ns - int(header["rig_beat_ns"][0]) > SILENT_NS


def suspended(pid: int) -> bool:
    """Whether the system holds the process."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (OSError, IndexError):
        return False
    return state in ("T", "t")


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
