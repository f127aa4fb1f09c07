"""How much room the data folder's disk has: said before it is full, and kept for the records of what is flown."""

import shutil
from pathlib import Path

from fullpose_server.errors import StorageFullError


class Disk:
    """Of one folder. `alarm`: health says so below it; `reserve`: below it nothing is taken in [bytes]."""

    def __init__(self, folder: Path, alarm: int, reserve: int) -> None:
        self._folder = folder
        self._reserve = reserve
        self.alarm_bytes = alarm

    def free_bytes(self) -> int:
        """What is free to us."""
        return shutil.disk_usage(self._folder).free

    def check(self, wanted: int = 0) -> None:
        """Raise `StorageFullError` where `wanted` bytes would leave less than the reserve."""
        free = self.free_bytes()
        if free - wanted < self._reserve:
            kept = f"{self._reserve / 1e6:.0f} MB are kept for the records"
            raise StorageFullError(f"the disk has {free / 1e6:.0f} MB left, of which {kept}: make room")

    def findings(self) -> list[str]:
        """What is wrong, in words."""
        free = self.free_bytes()
        if free >= self.alarm_bytes:
            return []
        full = "" if free >= self._reserve else "; uploads, plans and exports are refused"
        return [f"the disk is nearly full: {free / 1e6:.0f} MB left{full}"]
