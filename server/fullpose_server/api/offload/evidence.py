"""Evidence as the routes see it: made by a process of its own, one at a time, that is gone afterwards.

A record is read whole for it, which may take some hundred megabytes and seconds: neither is the server's.
"""

import asyncio
from pathlib import Path

from fullpose_server.api.offload.one_off import done_apart
from fullpose_server.api.problems import ApiError
from fullpose_server.location import Location, PostgresqlUrl

KIND = "evidence"
WAITING = 8  # beyond the one that is being made
_PROGRAM = "fullpose_server.api.offload.evidence_worker"


class EvidenceMaker:
    """Use it from one event loop. `folder` is the server's data folder, `database` has its rows."""

    def __init__(self, folder: Path, database: Location) -> None:
        self._folder = folder
        self._database = database
        self._turn = asyncio.Lock()
        self._asked = 0

    async def make(self, run: str, target: Path) -> None:
        """Write the bundle of a run. Raises `ApiError`; cancelled, it stops at once."""
        if self._asked > WAITING:
            raise ApiError(429, "busy", f"{self._asked} bundles are being made or asked for: try again")
        self._asked += 1
        try:
            async with self._turn:
                url = self._database.url if isinstance(self._database, PostgresqlUrl) else None
                asked = {"folder": str(self._folder), "run": run, "target": str(target), "database": url}
                await done_apart(_PROGRAM, KIND, asked)
        finally:
            self._asked -= 1
