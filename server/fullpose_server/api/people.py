"""Who is let in, kept as the rows are: looked up for every request, and looked for anew when somebody changed them."""

import asyncio
import logging
import time
from collections.abc import Awaitable, Callable

from sqlalchemy.exc import SQLAlchemyError

from fullpose_server.errors import ServerError
from fullpose_server.people.admitted import Admitted
from fullpose_server.people.roles import Role
from fullpose_server.store.people import PeopleStore

LOOK_S = 1.0  # a change on the command line, in another process, is in force as soon as that
LOST = (
    "the database that has the users was damaged: nobody is let in, and whoever asks may stop a rig, until a backup is"
    " in its place or `fullpose user add NAME --role admin` makes somebody for this data folder"
)
log = logging.getLogger(__name__)


class People:
    """Of one server, from `start` until `close`. Everything but `store` belongs to the event loop's thread."""

    def __init__(self, store: PeopleStore, *, asked: bool = False, lost: bool = False) -> None:
        """`asked`: one must sign in though there is nobody yet, for people come from a provider.

        `lost`: who they were is not known any more: until there is somebody, nobody is let in.
        """
        self.store = store
        self._asked = asked
        self._lost = lost
        self.admitted = self._seen(store.admitted(asked=asked))
        self._revision = store.revision()
        self._watching: list[Callable[[Admitted], None]] = []
        self._after: list[Callable[[Admitted], Awaitable[None]]] = []
        self._open: dict[asyncio.Event, tuple[str, Role]] = {}  # of a WebSocket each: credential, what it needs
        self._reading = asyncio.Lock()  # or what was read first could be taken in last
        self._task: asyncio.Task[None] | None = None
        self._error = ""

    @property
    def may_stop(self) -> Admitted:
        """Who may stop a rig: whoever asks, where it is not known who people are."""
        return Admitted(False) if self._lost else self.admitted

    def start(self) -> None:
        """Look for changes from here on."""
        self._task = asyncio.create_task(self._look_on(), name="look who is let in")

    async def close(self) -> None:
        """Look no more."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    def watch(self, tell: Callable[[Admitted], None]) -> None:
        """Call `tell` at every change."""
        self._watching.append(tell)

    def after(self, act: Callable[[Admitted], Awaitable[None]]) -> None:
        """Wait for `act` after every change: once it was taken in, and before who made it is answered."""
        self._after.append(act)

    async def refresh(self) -> None:
        """Take in what was changed. Raises `StorageError`."""
        async with self._reading:
            self._revision, admitted = await asyncio.to_thread(self._read)
            self.admitted = self._seen(admitted)
            for tell in self._watching:
                tell(self.may_stop)
            self._end_those_without()
            admitted = self.admitted
        for act in self._after:
            await act(admitted)

    def ends_with(self, credential: str, role: Role) -> asyncio.Event:
        """Set when this credential holds no longer, or is less than `role`; to be given back by `forget`."""
        gone = asyncio.Event()
        self._open[gone] = (credential, role)
        return gone

    def forget(self, gone: asyncio.Event) -> None:
        """Nobody waits for it any more."""
        self._open.pop(gone, None)

    def faults(self) -> list[str]:
        """What is wrong with it; nothing while all is well."""
        found = [LOST] if self._lost else []
        return [*found, f"changes to people are not seen: {self._error}"] if self._error else found

    def _read(self) -> tuple[int, Admitted]:
        revision = self.store.revision()  # before the rows: what changes between is read again
        return revision, self.store.admitted(asked=self._asked)

    def _seen(self, found: Admitted) -> Admitted:
        self._lost = self._lost and not found.people
        return Admitted(True) if self._lost else found

    async def _look_on(self) -> None:
        while True:
            await asyncio.sleep(LOOK_S)
            try:
                if await asyncio.to_thread(self.store.revision) != self._revision:
                    await self.refresh()
                self._error = ""
            except Exception as cause:  # whatever it is: who was let in stays so, and it is looked again
                if not isinstance(cause, (ServerError, SQLAlchemyError)):
                    log.exception("looking who is let in")
                self._error = f"{type(cause).__name__}: {cause}".splitlines()[0]
            self._end_those_without()

    def _end_those_without(self) -> None:
        now = time.time()
        for gone, (credential, role) in self._open.items():
            if not self.admitted.still(credential, role, now):
                gone.set()
