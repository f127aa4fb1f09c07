"""Watches the alarms of every rig, over restarts of their processes, and tells what is new or has changed."""

import asyncio
import logging
from collections.abc import Iterable, Sequence
from typing import Protocol

from fullpose_server.runtime.supervisor.registry import RigHosts
from fullpose_server.runtime.supervisor.rig_client import RigHost
from fullpose_server.runtime.supervisor.running import RunningProcess
from fullpose_server.session.alarms import Alarm, Shelf

log = logging.getLogger(__name__)


class AlarmSink(Protocol):
    """Where alarms are written down; it waits for nothing."""

    def raised(self, rig: str, life: str, alarms: Iterable[Alarm]) -> None:
        """Alarms of a rig are new or have changed; `life` is of the process that raised them."""

    def shelved(self, rig: str, shelves: Sequence[Shelf]) -> None:
        """The shelves of a rig, all of them, have changed."""


class _Told:
    """What was told of one rig."""

    def __init__(self) -> None:
        self.life = ""
        self.alarms: dict[int, Alarm] = {}
        self.shelves: list[Shelf] | None = None


class AlarmWatch:
    """Of all the rigs of one server. It belongs to the event loop's thread."""

    def __init__(self, hosts: RigHosts, sink: AlarmSink) -> None:
        self._hosts = hosts
        self._sink = sink
        self._told: dict[str, _Told] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}
        hosts.running.watch(self._changed)

    async def close(self) -> None:
        """Watch no more."""
        for task in self._tasks.values():
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    def look(self) -> None:
        """Tell what is new, now."""
        for host in self._hosts.all():
            self._look(host)

    def faults(self) -> list[str]:
        """What of the watch itself has failed."""
        ended = [rig for rig, task in self._tasks.items() if task.done()]
        return [f"rig {rig}: its alarms are not written to the history any more" for rig in ended]

    def _changed(self, rig: str, process: RunningProcess | None) -> None:
        if process is None:  # its last words
            host = self._hosts.get(rig)
            if host is not None:
                self._look(host)
        elif rig not in self._tasks:
            task = self._tasks[rig] = asyncio.create_task(self._follow(rig), name=f"alarms of {rig}")
            task.add_done_callback(_ended)

    async def _follow(self, rig: str) -> None:
        host = await self._hosts.wait(rig)
        while True:
            revision = host.revision
            self._look(host)
            await host.wait_change(revision)

    def _look(self, host: RigHost) -> None:
        now = host.snapshot()
        told = self._told.setdefault(host.name, _Told())
        if now.life != told.life:
            told.life, told.alarms = now.life, {}
        # What stands may be too old for the part of the history that is published.
        alarms = {alarm.number: alarm for alarm in (*now.history, *now.alarms)}
        changed = [alarm for number, alarm in alarms.items() if told.alarms.get(number) != alarm]
        if changed:
            self._sink.raised(host.name, now.life, changed)
            told.alarms = alarms
        if now.shelves != told.shelves:
            self._sink.shelved(host.name, now.shelves)
            told.shelves = now.shelves


def _ended(task: asyncio.Task[None]) -> None:
    if not task.cancelled():
        log.error("%s are not watched any more", task.get_name(), exc_info=task.exception())
