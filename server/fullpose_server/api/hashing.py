"""Room for passwords that are being hashed: 64 MiB and a core each."""

import asyncio
from types import TracebackType

from fullpose_server.api.problems import ApiError

AT_ONCE = 2
WAITING = 16  # half a second's worth: whoever signs in beside a flood tries again, and waits for no thousand others


class Hashing:
    """An async context: entered, a hash may be made. Raises `ApiError` (429) where too many wait for that."""

    def __init__(self) -> None:
        self._room = asyncio.Semaphore(AT_ONCE)
        self._waiting = 0

    async def __aenter__(self) -> None:
        if self._waiting >= WAITING:
            told = "too many sign in at once: try again in 2 s"
            raise ApiError(429, "attempts", told, headers={"Retry-After": "2"})
        self._waiting += 1
        try:
            await self._room.acquire()
        finally:
            self._waiting -= 1

    async def __aexit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _where: TracebackType | None
    ) -> None:
        self._room.release()
