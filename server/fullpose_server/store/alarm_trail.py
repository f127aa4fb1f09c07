"""The alarm history follows the rigs: no alarm waits for its row."""

from collections.abc import Iterable, Sequence

from fullpose_server.session.alarms import Alarm, Shelf
from fullpose_server.store.alarms import AlarmHistory, RaisedAlarm, RigShelves
from fullpose_server.store.write_behind import WriteBehind


class AlarmTrail(WriteBehind[RaisedAlarm | RigShelves]):
    """An alarm that changes before it is written is written as it is last; so are the shelves of a rig."""

    def __init__(self, history: AlarmHistory) -> None:
        super().__init__("alarm history", history.write)

    def raised(self, rig: str, life: str, alarms: Iterable[Alarm]) -> None:
        """Alarms of a rig are new or have changed; `life` is of the process that raised them."""
        for alarm in alarms:
            entry = RaisedAlarm(rig, life, alarm)
            self.put(entry.id, entry)

    def shelved(self, rig: str, shelves: Sequence[Shelf]) -> None:
        """The shelves of a rig, all of them, have changed."""
        self.put((rig, "shelves"), RigShelves(rig, tuple(shelves)))
