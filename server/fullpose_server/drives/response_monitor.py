"""Whether a drive does what it was asked: to follow commands, or not to."""

from fullpose_server.drives.base import Status

_UNCONFIRMED, _ENABLED = int(Status.UNCONFIRMED), int(Status.ENABLED)  # plain numbers: asked every tick


class DriveResponseMonitor:
    """Compares, once a tick, what is asked of a drive with what it shows; counts ticks, not time.

    A process that was stopped itself has not given the drive its time, so the clock would be no witness.
    """

    def __init__(self, patience: int) -> None:
        self._patience = patience
        self._asked = self._obeyed = False
        self._ticks = 0

    def forget(self) -> None:
        """Begin anew, as if asked just now."""
        self._obeyed = False
        self._ticks = 0

    def ends(self, asked: bool, moving: bool, status: int) -> bool:
        """Whether patience ends in this tick; said once for one and the same disobedience.

        `asked` is whether the drive should follow, `status` what it shows. Orders take their time to arrive; but a
        drive that followed and lets go in motion has none.
        """
        if asked is not self._asked:
            self._asked = asked
            self.forget()
        if not status & _UNCONFIRMED and bool(status & _ENABLED) is asked:
            self._obeyed = True
            self._ticks = 0
            return False
        self._ticks += 1
        return self._ticks == (1 if asked and moving and self._obeyed else self._patience)
