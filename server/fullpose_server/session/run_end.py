"""How a run ended: one word for the list of runs, and the code of the alarm that ended it where one did."""

from dataclasses import dataclass
from enum import StrEnum


class RunEnd(StrEnum):
    """The words."""

    COMPLETED = "completed"  # the path was flown to its end
    STOPPED = "stopped"  # by command
    SOURCE_LOST = "source_lost"
    OWNER_SILENT = "owner_silent"  # who held the lease
    SERVER_SILENT = "server_silent"
    ESTOP = "estop"
    FAULT = "fault"
    LINK_LOST = "link_lost"
    PROCESS_LOST = "process_lost"  # the rig process ended in the middle of it


_ORDERLY = frozenset({RunEnd.COMPLETED, RunEnd.STOPPED, RunEnd.SOURCE_LOST, RunEnd.OWNER_SILENT, RunEnd.SERVER_SILENT})


@dataclass(frozen=True)
class Ending:
    """Why a run ends; `code` is its alarm's, where it has one."""

    how: RunEnd
    code: str | None = None

    def after(self, earlier: "Ending | None") -> "Ending":
        """What counts where an `earlier` reason was given: the first, but for a fault on an orderly way to rest."""
        if earlier is None or (earlier.how in _ORDERLY and self.how not in _ORDERLY):
            return self
        return earlier
